import assert from 'node:assert/strict';
import { after, before, test } from 'node:test';

import { ARKIT } from '../../../../tools/host/character/shapes.js';
import { Browser } from './harness.mjs';

// What a person sees: pictures of single expressions beside the face at rest. The board is a stand-in that shows what it
// is told, so the same values are the same picture, to the pixel.

// Parts of the picture of a face at rest.
const EYES = [0.28, 0.25, 0.68, 0.42], MOUTH = [0.32, 0.48, 0.66, 0.76], FOREHEAD = [0.28, 0.08, 0.72, 0.2];
const BUST = [0, 0.88, 1, 1], CORNERS = [0.34, 0.5, 0.6, 0.6], REGIONS = { EYES, MOUTH, FOREHEAD, BUST, CORNERS };

const both = (name, weight = 1) => ({ [`${name}Left`]: weight, [`${name}Right`]: weight });
let browser, page, neutral;

before(async () => {
  browser = await Browser.start();
  page = await browser.open(undefined, { board: true });
  await page.page.evaluate((shapes) => board.setRig({
    name: 'stand_in',
    bones: [{ name: 'neck' }],
    channels: [
      ...shapes.map((name) => ({ name, kind: 'parameter', neutral: 0, min: 0, max: 1 })),
      ...['pitch', 'yaw'].map((kind) => ({ name: `neck.${kind}`, kind, bone: 0, neutral: 0, min: -60, max: 60 })),
    ],
  }), ARKIT);
  await page.press('serial');
  await page.shows('state-text', /^tracking$/);
  neutral = await face('neutral', {});
});
after(() => browser?.close());

async function face(name, values) {
  await page.page.evaluate((v) => board.set(v), values);
  await page.settled();
  return page.shot(name);
}
const changed = async (name, values) => page.differences(neutral, await face(name, values), REGIONS);

test('the same values are the same picture', async () => {
  assert.deepEqual(Object.values(await changed('rest', {})), [0, 0, 0, 0, 0]);
});

test('a blink closes the eyes and moves nothing else', async () => {
  const { EYES: eyes, ...others } = await changed('blink', both('eyeBlink'));
  assert.ok(eyes > 0.1, String(eyes));
  assert.ok(Math.max(...Object.values(others)) < 0.001, JSON.stringify(others));
});

test('a wink closes one eye', async () => {
  const half = { LEFT: [0.28, 0.25, 0.45, 0.42], RIGHT: [0.48, 0.25, 0.68, 0.42] };
  const { LEFT, RIGHT } = await page.differences(neutral, await face('wink', { eyeBlinkLeft: 1 }), half);
  assert.ok(RIGHT > 0.1 && LEFT < 0.001, `${LEFT}, ${RIGHT}`); // the character's left is the picture's right
});

test('an open mouth moves the mouth and the jaw, not the eyes', async () => {
  const { MOUTH: mouth, EYES: eyes, FOREHEAD: forehead } = await changed('open', { jawOpen: 1 });
  assert.ok(mouth > 0.25, String(mouth));
  assert.ok(eyes < 0.001 && forehead < 0.001, `${eyes}, ${forehead}`);
});

test('a smile moves the corners of the mouth, not the eyes', async () => {
  const { CORNERS: corners, EYES: eyes, FOREHEAD: forehead } = await changed('smile', both('mouthSmile'));
  assert.ok(corners > 0.15, String(corners));
  assert.ok(eyes < 0.001 && forehead < 0.001, `${eyes}, ${forehead}`);
});

test('smile, pucker and open mouth are different pictures of the mouth', async () => {
  const mouths = [await face('smile', both('mouthSmile')), await face('pucker', { mouthPucker: 1 }), await face('ajar', { jawOpen: 0.4 })];
  for (const [a, b] of [[0, 1], [0, 2], [1, 2]]) {
    const { MOUTH: mouth } = await page.differences(mouths[a], mouths[b], { MOUTH });
    assert.ok(mouth > 0.08, `${a} and ${b}: ${mouth}`);
  }
});

test('eyes that look aside move in their sockets', async () => {
  const { EYES: eyes, MOUTH: mouth } = await changed('aside', { eyeLookOutLeft: 1, eyeLookInRight: 1 });
  assert.ok(eyes > 0.04, String(eyes));
  assert.ok(mouth < 0.001, String(mouth));
});

test('a head that turns moves the whole face, and not the bust', async () => {
  const turned = await changed('turned', { 'neck.yaw': 30 });
  assert.ok(turned.EYES > 0.3 && turned.MOUTH > 0.2, JSON.stringify(turned));
  assert.ok(turned.BUST < 0.02, String(turned.BUST));
});

test('nothing of the page lies on the head, on a phone and in a narrow window', async () => {
  const { width, height } = page.page.viewportSize();
  await page.page.evaluate(() => board.set({}));
  for (const size of [{ width: 360, height: 740 }, { width: 720, height: 450 }, { width, height }]) {
    await page.page.setViewportSize(size);
    await page.settled();
    assert.deepEqual(await page.page.evaluate(covered), [], `${size.width} x ${size.height}`);
  }
});

// In the browser: what of the header the character is under. Where it is not, the picture is transparent.
function covered() {
  const view = document.getElementById('view');
  const g = new OffscreenCanvas(view.width, view.height).getContext('2d', { willReadFrequently: true });
  g.drawImage(view, 0, 0);
  const { left, top, width } = view.getBoundingClientRect(), ratio = view.width / width;
  return [...document.querySelectorAll('header > *')].filter((e) => {
    const box = e.getBoundingClientRect();
    const { data } = g.getImageData(...[box.left - left, box.top - top, box.width, box.height].map((c) => Math.round(ratio * c)));
    return data.some((alpha, i) => i % 4 === 3 && alpha > 0);
  }).map((e) => e.id || e.tagName);
}

test('a performer who is gone leaves a face at rest and a page that says so', async () => {
  await page.page.evaluate((v) => board.set(v, 'tracking'), both('eyeBlink'));
  await page.page.evaluate(() => board.set({}, 'resting'));
  await page.shows('state-text', /^resting$/);
  await page.settled();
  const { EYES: eyes } = await page.differences(neutral, await page.shot('resting'), { EYES });
  assert.equal(eyes, 0);
});

test('nothing went wrong on the way', () => assert.deepEqual(page.complaints, []));
