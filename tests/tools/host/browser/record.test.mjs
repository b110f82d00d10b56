import assert from 'node:assert/strict';
import { execFileSync } from 'node:child_process';
import { readFileSync, writeFileSync } from 'node:fs';
import { join } from 'node:path';
import { after, before, test } from 'node:test';

import { Browser, FILE, SMALL } from './harness.mjs';

// A recording of the page, as the files that people take away.

let browser, page;
before(async () => {
  browser = await Browser.start();
  page = await browser.open(FILE, SMALL);
  await page.shows('state-text', /^recording: tracking$/);
});
after(() => browser?.close());

async function saved(id) {
  const [download] = await Promise.all([page.page.waitForEvent('download'), page.press(id)]);
  const bytes = readFileSync(await download.path());
  if (process.env.FACEWIRE_SHOTS) writeFileSync(join(process.env.FACEWIRE_SHOTS, download.suggestedFilename()), bytes);
  return { name: download.suggestedFilename(), bytes };
}
let table, file, json, binary;
const numbers = (at) => {
  const { bufferView, byteOffset = 0, count, type } = json.accessors[at], view = json.bufferViews[bufferView];
  const size = count * { SCALAR: 1, VEC3: 3, VEC4: 4 }[type];
  return new Float32Array(Uint8Array.from(binary.subarray((view.byteOffset ?? 0) + byteOffset).subarray(0, 4 * size)).buffer);
};

test('before anything is recorded there is nothing to save', async () => {
  for (const id of ['save-glb', 'save-csv']) assert.ok(await page.page.locator(`#${id}`).isDisabled());
});

test('a button begins and ends a recording, and says how long it is', async () => {
  await page.press('record');
  await page.shows('record-text', /^Stop 0:0[2-9]$/);
  await page.press('record');
  await page.shows('record-text', /^Record$/);
  await page.shows('record-note', /^\d+ poses, [2-9]\.\d s\.$/);
});

test('the table has a line for each pose, 24 a second', async () => {
  const { name, bytes } = await saved('save-csv');
  assert.match(name, /^facewire-\d{4}(-\d\d){5}\.csv$/);
  table = bytes.toString().trimEnd().split('\n').map((line) => line.split(','));
  const [header, ...lines] = table;
  assert.deepEqual(header.slice(0, 4), ['frame', 't_us', 'age_us', 'state']);
  assert.equal(header.length - 4, await page.page.locator('[role=meter]').count());
  const times = lines.map((line) => Number(line[1]));
  assert.ok(Math.abs((times.at(-1) - times[0]) / (times.length - 1) / 41667 - 1) < 0.05, times.join());
});

test('the character is saved with its animation, at the same times with the same weights', async () => {
  file = await saved('save-glb');
  const { bytes } = file;
  assert.equal(bytes.toString('latin1', 0, 4), 'glTF');
  assert.equal(bytes.readUInt32LE(8), bytes.length);
  const length = bytes.readUInt32LE(12);
  json = JSON.parse(bytes.subarray(20, 20 + length));
  binary = bytes.subarray(28 + length);
  const { animations: [animation], meshes, nodes } = json;
  const [header, ...lines] = table;
  const mouth = nodes.findIndex(({ name }) => name === 'mouth');
  const channel = animation.channels.find(({ target }) => target.node === mouth && target.path === 'weights');
  const sampler = animation.samplers[channel.sampler];
  const times = numbers(sampler.input), weights = numbers(sampler.output), names = meshes[nodes[mouth].mesh].extras.targetNames;
  assert.equal(times.length, lines.length);
  lines.forEach((line, i) => assert.ok(Math.abs(times[i] - (line[1] - lines[0][1]) / 1e6) < 1e-5));
  for (const shape of ['mouthSmileLeft', 'mouthPucker', 'mouthFunnel']) {
    lines.forEach((line, i) => {
      const [told, is] = [Number(line[header.indexOf(shape)]), weights[i * names.length + names.indexOf(shape)]];
      assert.ok(Math.abs(told - is) < 1e-5, `${shape} at ${i}: ${told}, ${is}`);
    });
  }
  console.log(`# ${(bytes.length / 1e6).toFixed(1)} MB for ${times.at(-1).toFixed(1)} s`);
});

test('facewire reads that character by name', async () => {
  const glb = join(browser.home, file.name), rig = join(browser.home, 'rig.toml');
  writeFileSync(glb, file.bytes);
  const said = execFileSync(join(process.env.FACEWIRE_PROGRAMS, 'tools/facewire/facewire'), ['rig', 'import', glb, '--out', rig], { encoding: 'utf8' });
  assert.match(said, /^ARKit's shapes: 51 of 52 shown/m); // no landmark shows a tongue
});

test('nothing went wrong on the way', () => assert.deepEqual(page.complaints, []));
