import assert from 'node:assert/strict';
import { readFileSync } from 'node:fs';
import { after, before, test } from 'node:test';

import { ARKIT } from '../../../../tools/host/character/shapes.js';
import { arkitCharacter, bonesCharacter, vrm0Character, vrm1Character } from '../made_character.mjs';
import { Browser } from './harness.mjs';

// Somebody's own character, dropped on the page.

const MOUTH = [0.3, 0.5, 0.7, 0.85], EYES = [0.2, 0.2, 0.8, 0.45], REGIONS = { MOUTH, EYES };
let browser, page;

before(async () => {
  browser = await Browser.start();
  page = await browser.open(undefined, { board: true });
  await page.page.evaluate((shapes) => board.setRig({
    name: 'stand_in',
    bones: [{ name: 'neck' }, { name: 'tail' }],
    channels: [
      ...shapes.map((name) => ({ name, kind: 'parameter', neutral: 0, min: 0, max: 1 })),
      { name: 'neck.yaw', kind: 'yaw', bone: 0, neutral: 0, min: -60, max: 60 },
      { name: 'tail.yaw', kind: 'yaw', bone: 1, neutral: 0, min: -60, max: 60 },
    ],
  }), ARKIT);
  await page.press('serial');
  await page.shows('state-text', /^tracking$/);
});
after(() => browser?.close());

const drop = (...files) => page.drop(...files);
async function face(name, values) {
  await page.page.evaluate((v) => board.set(v), values);
  await page.settled();
  return page.shot(name);
}
const items = (id) => page.page.locator(`#${id} li`).allTextContents();

test('Otto is there first, and has every shape', async () => {
  assert.deepEqual([await page.text('character-name'), await page.text('character-shapes')], ['Otto', '52 of 52']);
  assert.deepEqual(await items('gap-values'), ['tail.yaw']);
});

test('a character that is dropped moves in his place', async () => {
  await drop(['puppet.glb', arkitCharacter([...ARKIT, 'halo']).glb()]);
  await page.shows('character-name', /^puppet\.glb$/);
  assert.equal(await page.text('character-shapes'), '52 of 52');
  assert.deepEqual(await items('gap-shapes'), ['halo']);
  assert.deepEqual(await items('gap-arkit'), []);
  assert.deepEqual(await items('gap-values'), ['tail.yaw']);
  const rest = await face('dropped-rest', {});
  const open = await page.differences(rest, await face('dropped-open', { jawOpen: 1 }), REGIONS);
  assert.ok(open.MOUTH > 0.05 && open.EYES < 0.1 * open.MOUTH, JSON.stringify(open));
  const turned = await page.differences(rest, await face('dropped-turned', { 'neck.yaw': 40 }), REGIONS);
  assert.ok(turned.EYES > 0.02, JSON.stringify(turned));
});

test('a VRM of either version, dropped or chosen by the button', async () => {
  await drop(['old.vrm', vrm0Character().glb()]);
  await page.shows('character-name', /^old\.vrm$/);
  const rest = await face('vrm0-rest', {}), { MOUTH: mouth } = await page.differences(rest, await face('vrm0-open', { jawOpen: 1 }), REGIONS);
  assert.ok(mouth > 0.003, String(mouth)); // toon: most of it is one colour
  const [chooser] = await Promise.all([page.page.waitForEvent('filechooser'), page.press('character-open')]);
  await chooser.setFiles({ name: 'puppet.vrm', mimeType: '', buffer: vrm1Character().glb() });
  await page.shows('character-name', /^puppet\.vrm$/);
  assert.ok((await items('gap-arkit')).includes('tongueOut'));
  await face('vrm1-blink', { eyeBlinkLeft: 1, eyeBlinkRight: 1 });
});

// One pixel.
const PNG = Buffer.from('iVBORw0KGgoAAAANSUhEUgAAAAEAAAABCAYAAAAfFcSJAAAADUlEQVR42mNk+M9QDwADhgGAWjR9awAAAABJRU5ErkJggg==', 'base64');

test('a .gltf that comes without its buffer and texture says so, and the character stays', async () => {
  const made = bonesCharacter();
  Object.assign(made.json, { images: [{ uri: 'skin.png' }], textures: [{ source: 0 }] });
  made.paint({ pbrMetallicRoughness: { baseColorTexture: { index: 0 } } });
  await drop(['bones.gltf', made.gltf('bones.bin')]);
  await page.shows('character-problem', /^bones\.gltf needs bones\.bin and skin\.png beside it/);
  assert.equal(await page.text('character-name'), 'puppet.vrm');
  await page.shot('dropped-notice', 'body');
  await drop(['bones.gltf', made.gltf('bones.bin')], ['bones.bin', made.bin], ['skin.png', PNG]);
  await page.shows('character-name', /^bones\.gltf$/);
  assert.equal(await page.page.locator('#character-notice').isVisible(), false);
  assert.ok((await items('character-bone-list')).includes('jaw: Jaw'));
});

test('a broken file is one notice, which goes away', async () => {
  await drop(['half.glb', arkitCharacter(['jawOpen']).glb().subarray(0, 999)]);
  await page.shows('character-problem', /^half\.glb is cut off/);
  await page.press('character-close');
  assert.equal(await page.page.locator('#character-notice').isVisible(), false);
});

test('there is a way back to Otto', async () => {
  await page.press('character-otto');
  await page.shows('character-name', /^Otto$/);
  assert.equal(await page.page.locator('#character-otto').isVisible(), false);
});

const ICT = process.env.FACEWIRE_ICT_HEAD;
test('the mean head of ICT-FaceKit: 51 of 51 shapes, and they are seen', { skip: !ICT && 'FACEWIRE_ICT_HEAD names no file' }, async () => {
  await drop(['ict_head.glb', readFileSync(ICT)]);
  await page.shows('character-name', /^ict_head\.glb$/);
  assert.equal(await page.text('character-shapes'), '51 of 52');
  assert.deepEqual([await items('gap-arkit'), await items('gap-shapes')], [['tongueOut'], []]);
  const rest = await face('ict-rest', {});
  for (const [name, values, region] of [
    ['blink', { eyeBlinkLeft: 1, eyeBlinkRight: 1 }, 'EYES'], ['open', { jawOpen: 1 }, 'MOUTH'],
    ['smile', { mouthSmileLeft: 1, mouthSmileRight: 1 }, 'MOUTH'], ['turn', { 'neck.yaw': 35 }, 'EYES'],
  ]) {
    const changed = await page.differences(rest, await face(`ict-${name}`, values), REGIONS);
    assert.ok(changed[region] > 0.02, `${name}: ${JSON.stringify(changed)}`);
  }
  await page.shot('ict-page', 'body');
});

test('nothing went wrong on the way', () => assert.deepEqual(page.complaints, []));
