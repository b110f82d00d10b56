import assert from 'node:assert/strict';
import { after, before, test } from 'node:test';

import { Decoder } from '../../../../tools/host/decoder/decoder.js';
import { RigCollector, valuesOf } from '../../../../tools/host/decoder/rig.js';
import { Browser, FILE, SMALL, recording } from './harness.mjs';

// Web Serial, with a stand-in for the browser's own: captured bytes of a real service, a cable that is pulled, a user who
// changes their mind.

let browser, page;
before(async () => {
  browser = await Browser.start();
});
after(() => browser?.close());

async function open() {
  await page?.close();
  page = await browser.open(FILE, { board: true, ...SMALL });
}
const plays = (bytes) => page.page.evaluate((b) => board.play(b), [...bytes]);
// The captured stream up to its n-th pose, by its parts.
function upTo(n) {
  const bytes = recording(), decoder = new Decoder();
  let poses = 0, at = 0;
  for (; at < bytes.length && poses < n; ++at) if (decoder.push(bytes.subarray(at, at + 1))[0]?.type === 'pose') ++poses;
  return bytes.subarray(0, at);
}

test('captured bytes make the page show the rig, its values and how the line fares', async () => {
  await open();
  await page.press('serial');
  const messages = new Decoder().push(upTo(200)), rig = new RigCollector();
  messages.forEach((message) => rig.add(message));
  const values = valuesOf(messages.findLast((m) => m.type === 'pose'), rig.rig);
  await page.shows('state-text', /^waiting for the device$/);
  await plays(upTo(200));
  await page.shows('state-text', /^(tracking|nothing comes)$/);
  const { channels } = rig.rig;
  assert.equal(await page.page.locator('[role=meter]').count(), channels.length);
  const shown = await page.values();
  for (const [i, { name }] of channels.entries()) assert.ok(Math.abs(shown.get(name) - values[i]) < 0.006, name);
  assert.equal(await page.figure('lost'), 0);
  assert.equal(await page.figure('damaged'), 0);
});

test('damaged bytes are counted and lose no more than their frames', async () => {
  await open();
  await page.press('serial');
  await page.shows('state-text', /^waiting for the device$/);
  const bytes = upTo(200).slice();
  for (const at of [0.5, 0.6, 0.7]) bytes[Math.round(at * bytes.length)] ^= 0x55;
  await plays(bytes);
  await page.shows('damaged', /^3$/);
  await page.shows('state-text', /^(tracking|nothing comes)$/);
});

test('buttons reach the board, and its answers the page', async () => {
  await open();
  await page.page.evaluate(() => {
    board.setRig({ name: 'small', bones: [], channels: [{ name: 'jawOpen', kind: 'parameter', neutral: 0, min: 0, max: 1 }] });
    board.results = { calibrate_neutral: 3 };
  });
  for (const id of ['calibrate', 'rest', 'stop', 'release']) assert.ok(await page.page.locator(`#${id}`).isDisabled(), id);
  await page.press('serial');
  await page.shows('state-text', /^tracking$/);
  for (const [id, answer] of [['calibrate', 'Calibrate: no face'], ['rest', 'Neutral: done'], ['stop', 'Stop: done'], ['release', 'Release: done']]) {
    await page.press(id);
    await page.shows('answer', `^${answer}$`);
  }
  assert.deepEqual(await page.page.evaluate(() => board.commands), ['calibrate_neutral', 'rest', 'stop', 'release']);
});

test('latency and frame rate are read while the board sends 25 poses a second', async () => {
  await page.shows('rate', /^2[3-7]$/);
  await page.shows('latency', /^\d+$/);
  assert.ok((await page.figure('latency')) < 1000);
});

test('a cable that is pulled is said, and taken up again when it is back', async () => {
  await page.page.evaluate(() => {
    board.set({ jawOpen: 1 });
    board.pull();
  });
  await page.shows('state-text', /^line lost, trying again$/);
  await page.shows('notice', /Trying again\.$/);
  await page.page.evaluate(() => { board.plugged = true; });
  await page.shows('state-text', /^tracking$/);
  assert.equal(await page.page.evaluate(() => board.openings), 2);
  assert.ok(await page.page.locator('#notice').isHidden());
});

test('a line that speaks OSC is said, with what to do about it', async () => {
  await open();
  await page.press('serial');
  await page.shows('state-text', /^waiting for the device$/);
  await plays(Array(3).fill([0xc0, ...Buffer.from('#bundle\0'), 0, 0, 0, 0, 0, 0, 0, 1, 0xc0]).flat());
  await page.shows('notice', /^This line speaks OSC; .* protocol = "native" .*\.toml\.$/);
  await plays(upTo(200));
  await page.shows('notice', /^$/);
});

test('a user who picks no port keeps what plays', async () => {
  await open();
  await page.page.evaluate(() => { board.chosen = false; });
  await page.press('serial');
  await page.shows('state-text', /^recording/);
  assert.ok(await page.page.locator('#notice').isHidden());
});

test('a port that another program has is said in words, and tried again', async () => {
  await open();
  await page.page.evaluate(() => { board.refused = new DOMException('Failed to open serial port.', 'NetworkError'); });
  await page.press('serial');
  await page.shows('notice', /^Failed to open serial port\. Trying again\.$/);
  // What is said stands still while one attempt follows the other.
  const said = await page.page.evaluate(() => new Promise((resolve) => {
    const texts = new Set(), from = board.attempts, notice = document.getElementById('notice');
    const look = () => {
      texts.add(`${document.getElementById('state-text').textContent}, ${notice.hidden ? 'no notice' : 'notice'}`);
      if (board.attempts < from + 2) setTimeout(look, 5);
      else resolve([...texts]);
    };
    look();
  }));
  assert.deepEqual(said, ['line lost, trying again, notice']);
  await page.page.evaluate(() => {
    board.setRig({ name: 'small', bones: [], channels: [{ name: 'jawOpen', kind: 'parameter', neutral: 0, min: 0, max: 1 }] });
    board.refused = null;
  });
  await page.shows('state-text', /^tracking$/);
});

test('nothing went wrong on the way', () => assert.deepEqual(page.complaints, []));
