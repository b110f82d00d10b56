import assert from 'node:assert/strict';
import { after, before, test } from 'node:test';

import { ARKIT } from '../../../../tools/host/character/shapes.js';
import { arkitCharacter } from '../made_character.mjs';
import { ALL_PIXELS, Browser, Service } from './harness.mjs';

// The whole way: franck.mp4 before the mock camera, the real service, its line, `facewire serve`, WebSocket, the page.

const EYES = [0.28, 0.25, 0.68, 0.42], MOUTH = [0.32, 0.48, 0.66, 0.76], FACE = [0.2, 0.1, 0.8, 0.8];
let browser, service, page, address;

before(async () => {
  [browser, service] = [await Browser.start(), new Service()];
  await service.start();
  address = await service.serve();
  page = await browser.open(address + ALL_PIXELS);
});
after(async () => {
  await browser?.close();
  await service?.stop();
});

// Until a value of the page is as wanted.
const until = (name, wanted) => page.page.waitForFunction(
  ([n, w]) => {
    const now = Number(document.querySelector(`[role=meter][aria-label="${n}"]`)?.getAttribute('aria-valuenow'));
    return w < 0 ? now <= w : now >= w;
  }, [name, wanted], { polling: 'raf' });

test('the page that serve brings follows its line at once', async () => {
  await page.shows('state-text', /^tracking$/);
  assert.equal(await page.figure('damaged'), 0);
  assert.ok(page.requests.every((url) => url.startsWith(address.replace(/\/$/, ''))), page.requests.join(' '));
});

test('frame rate and latency are those of the service', async () => {
  // Both at once: a busy machine has moments without either. The clip has 24 pictures a second.
  const figures = await page.page.waitForFunction(() => {
    const [frames, ms] = ['rate', 'latency'].map((id) => Number.parseFloat(document.getElementById(id).textContent));
    return frames >= 20 && ms >= 0 && [frames, ms];
  });
  const [rate, latency] = await figures.jsonValue();
  assert.ok(Math.abs(rate - 24) < 3, `${rate} a second`);
  assert.ok(latency > 0 && latency < 2000, `${latency} ms`);
  console.log(`# ${rate} frames a second, ${latency} ms from the picture to the page`);
});

test('moments of the performance are different pictures', async () => {
  await until('mouthSmileLeft', 0.6);
  const smile = await page.shot('franck-smile');
  await until('jawOpen', 0.35);
  const open = await page.shot('franck-open');
  const { MOUTH: mouth, FACE: whole } = await page.differences(smile, open, { EYES, MOUTH, FACE });
  assert.ok(mouth > 0.02 && whole > 0.005, `${mouth}, ${whole}`);
});

test('stop and release do what they say', async () => {
  await page.press('stop');
  await page.shows('answer', /^Stop: done$/);
  await page.shows('state-text', /^stopped$/);
  await page.press('release');
  await page.shows('answer', /^Release: done$/);
  await page.shows('state-text', /^tracking$/);
});

test('neutral brings the face to rest, and release the performer back', async () => {
  await page.press('rest');
  await page.shows('answer', /^Neutral: done$/);
  await page.shows('state-text', /^resting$/);
  const values = await page.values();
  for (const name of ['jawOpen', 'mouthSmileLeft', 'eyeBlinkLeft']) assert.ok(Math.abs(values.get(name)) < 0.02, name);
  await page.press('release');
  await page.shows('state-text', /^tracking$/);
});

test('what serve says of safety lets a character with a texture come in, in pieces', async () => {
  const made = arkitCharacter(ARKIT);
  Object.assign(made.json, { images: [{ uri: 'skin.png' }], textures: [{ source: 0 }] });
  made.paint({ pbrMetallicRoughness: { baseColorTexture: { index: 0 } } });
  await page.drop(['head.gltf', made.gltf('head.bin')], ['head.bin', made.bin], ['skin.png', await page.shot('skin')]);
  await page.shows('character-name', /^head\.gltf$/);
  await page.press('character-otto');
  await page.shows('character-name', /^Otto$/);
});

test('a server that goes is said, and taken up again when it is back', async () => {
  await service.server.stop('SIGKILL');
  await page.shows('state-text', /^line lost, trying again$/);
  await page.shows('notice', /Trying again\.$/);
  await page.page.waitForTimeout(2500); // the character holds for a second, then eases
  const first = await page.shot('lost');
  await service.serve(service.port);
  await page.shows('state-text', /^tracking$/);
  assert.ok(await page.page.locator('#notice').isHidden());
  await until('mouthSmileLeft', 0.6);
  const { FACE: whole } = await page.differences(first, await page.shot('back'), { FACE });
  assert.ok(whole > 0.005, String(whole));
});

test('a service that is started again is followed again', async () => {
  await service.service.stop('SIGKILL');
  await page.shows('state-text', /^nothing comes$/);
  await service.start();
  await page.shows('state-text', /^tracking$/);
});

test('nothing went wrong on the way', () => {
  // The browser itself tells of a server that was not there.
  assert.deepEqual(page.complaints.filter((text) => !/WebSocket connection/.test(text)), []);
});
