import assert from 'node:assert/strict';
import { readFileSync, readdirSync } from 'node:fs';
import { test } from 'node:test';
import { fileURLToPath } from 'node:url';

import { crc32 } from '../../../tools/host/decoder/crc32.js';
import { Decoder } from '../../../tools/host/decoder/decoder.js';
import { Encoder } from '../../../tools/host/decoder/encoder.js';
import { COMMANDS } from '../../../tools/host/decoder/message.js';
import { RigCollector, valuesOf } from '../../../tools/host/decoder/rig.js';

const folder = fileURLToPath(new URL('../../core/wire/vectors/', import.meta.url));
const vectors = readdirSync(folder).filter((f) => f.endsWith('.bin')).map((f) => f.slice(0, -4));
const stream = (name) => new Uint8Array(readFileSync(`${folder}${name}.bin`));

// A vector's .json with its 64-bit integers whole, and its floats as the 32 bits that were on the wire.
function meaning(name) {
  const text = readFileSync(`${folder}${name}.json`, 'utf8').replace(/"(captured_us|now_us)": (-?\d+)/g, '"$1": "$2"');
  return JSON.parse(text, (key, value) => {
    if (key === 'captured_us' || key === 'now_us') return BigInt(value);
    return typeof value === 'number' && !Number.isSafeInteger(value) ? Math.fround(value) : value;
  });
}

test('every vector is read as the C++ decoder reads it', () => {
  assert.ok(vectors.length > 80);
  for (const name of vectors) {
    const decoder = new Decoder();
    const expected = meaning(name);
    assert.deepEqual(decoder.push(stream(name)), expected.messages, name);
    assert.deepEqual(decoder.stats, expected.stats, name);
  }
});

test('a stream is read alike however it is cut in two', () => {
  for (const name of vectors.filter((n) => stream(n).length < 400)) {
    const bytes = stream(name);
    const whole = new Decoder();
    const messages = whole.push(bytes);
    for (let cut = 0; cut <= bytes.length; ++cut) {
      const decoder = new Decoder();
      const both = [...decoder.push(bytes.subarray(0, cut)), ...decoder.push(bytes.subarray(cut))];
      assert.deepEqual(both, messages, `${name} at ${cut}`);
      assert.deepEqual(decoder.stats, whole.stats, `${name} at ${cut}`);
    }
  }
});

test('a bad line costs only what it damaged, byte by byte too', () => {
  const expected = meaning('bad_line');
  const decoder = new Decoder();
  const messages = [...stream('bad_line')].flatMap((byte) => decoder.push(Uint8Array.of(byte)));
  assert.deepEqual(messages, expected.messages);
  assert.ok(decoder.damaged > 10);
  assert.equal(decoder.damaged,
    expected.stats.crc_errors + expected.stats.cobs_errors + expected.stats.truncated + expected.stats.overflows);
});

test('after random bytes the next sound frame is delivered', () => {
  let seed = 1;
  const random = () => (seed = (Math.imul(seed, 1664525) + 1013904223) >>> 0) >>> 24;
  const decoder = new Decoder();
  for (let round = 0; round < 200; ++round) {
    decoder.push(Uint8Array.from({ length: 400 }, () => (random() < 20 ? 0 : random())));
    const [message, ...others] = decoder.push(new Encoder().command(round, COMMANDS.ping));
    assert.equal(message.id, round);
    assert.equal(others.length, 0);
  }
});

test('the encoder writes the bytes of the vectors', () => {
  for (const name of ['commands', 'command_value', 'command_reload']) {
    const encoder = new Encoder();
    const frames = meaning(name).messages.map((m) => [...encoder.command(m.id, m.code, m.value)]);
    assert.deepEqual(frames.flat(), [...stream(name)], name);
  }
});

test('what the encoder writes the decoder reads, whatever zeros are in it', () => {
  const encoder = new Encoder();
  const decoder = new Decoder();
  for (let id = 0; id < 0x10000; id += 37) {
    const value = id / 1000 - 30;
    const [message] = decoder.push(encoder.command(id, COMMANDS.blend_profile, value));
    assert.equal(message.id, id);
    assert.equal(message.value, Math.fround(value));
  }
  assert.equal(decoder.damaged, 0);
  assert.equal(decoder.stats.lost, 0);
});

test('a command that cannot be is refused', () => {
  const encoder = new Encoder();
  assert.throws(() => encoder.command(65536, 1), RangeError);
  assert.throws(() => encoder.command(1, 256), RangeError);
  assert.throws(() => encoder.command(1, COMMANDS.blend_profile, NaN), RangeError);
});

test('the CRC has its check value', () => {
  assert.equal(crc32(new TextEncoder().encode('123456789')), 0xcbf43926);
});

const header = (rig_id, bones, channels) => ({ type: 'rig_header', rig_id, bones, channels, name: 'otto' });
const bone = (rig_id, index) => ({ type: 'bone', rig_id, index, rest_cm: [0, 0, 0], name: `bone${index}` });
const channel = (rig_id, index) =>
  ({ type: 'channel', rig_id, index, kind: 'pitch', bone: 0, neutral: 0, min: -2, max: 24, name: `c${index}` });

test('a rig is put together in any order, with repeats and other messages between', () => {
  const collector = new RigCollector();
  for (const part of [channel(7, 1), bone(7, 0), { type: 'status' }, header(7, 1, 2), bone(7, 0)]) collector.add(part);
  assert.equal(collector.missing, 1);
  assert.equal(collector.rig, null);
  assert.equal(collector.add(channel(7, 0)), true);
  assert.deepEqual(collector.rig.channels.map((c) => c.name), ['c0', 'c1']);
  assert.equal(collector.add({ type: 'pose' }), false);
});

test('a rig that changes starts over', () => {
  const collector = new RigCollector();
  for (const part of [header(7, 1, 1), bone(7, 0), channel(7, 0)]) collector.add(part);
  assert.ok(collector.complete);
  collector.add(bone(8, 0));
  assert.ok(!collector.complete);
  for (const part of [header(8, 1, 1), channel(8, 0)]) collector.add(part);
  assert.equal(collector.rig.rig_id, 8);
});

test('values of a pose are in the units of its channels; of another rig there are none', () => {
  const collector = new RigCollector();
  for (const part of [header(7, 0, 2), channel(7, 0), channel(7, 1)]) collector.add(part);
  assert.deepEqual([...valuesOf({ rig_id: 7, steps: [0, 65535] }, collector.rig)], [-2, 24]);
  assert.equal(valuesOf({ rig_id: 8, steps: [0, 65535] }, collector.rig), null);
  assert.equal(valuesOf({ rig_id: 7, steps: [0] }, collector.rig), null);
});
