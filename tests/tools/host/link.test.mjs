import assert from 'node:assert/strict';
import { readFileSync } from 'node:fs';
import { test } from 'node:test';

import { Decoder } from '../../../tools/host/decoder/decoder.js';
import { COMMANDS } from '../../../tools/host/decoder/message.js';
import { Link, SILENCE_MS } from '../../../tools/host/page/link.js';
import { Recording, Serial } from '../../../tools/host/page/sources.js';

const franck = new Uint8Array(readFileSync(new URL('../../../tools/host/page/franck.bin', import.meta.url)));
const soon = () => new Promise((resolve) => setImmediate(resolve));

// A line in the test's hands: what the page sends, and a device that may be there or not.
class Line {
  retry = true;
  there = true;
  opened = 0;
  sent = [];
  #decoder = new Decoder();
  open(to) {
    if (!this.there) throw new Error('nobody answers');
    ++this.opened;
    this.to = to;
    this.#decoder = new Decoder();
  }
  send(bytes) { this.sent.push(...this.#decoder.push(bytes)); }
  close() {}
  codes() { return this.sent.splice(0).map((m) => m.code); }
}

async function context(line = new Line()) {
  const time = { now: 1000 };
  const link = new Link(() => time.now);
  link.open(line);
  await soon();
  const pass = async (ms) => {
    for (const end = time.now + ms; time.now < end;) {
      time.now = Math.min(end, time.now + 100);
      link.tick();
      await soon();
    }
  };
  return { link, line, time, pass };
}

test('the recording on the page is sound, describes its rig and moves its face', () => {
  const decoder = new Decoder();
  const messages = decoder.push(franck);
  assert.equal(decoder.damaged + decoder.stats.lost + decoder.stats.malformed, 0);
  const poses = messages.filter((m) => m.type === 'pose');
  assert.ok(poses.length > 300);
  assert.ok(poses.filter((p) => p.state === 2).length > 250);
});

test('a link asks for the rig until it is there, and then follows poses', async () => {
  const { link, line, pass } = await context();
  assert.equal(link.state, 'waiting');
  await pass(2100);
  assert.equal(line.codes().filter((c) => c === COMMANDS.describe_rig).length, 3);
  line.to.bytes(franck);
  assert.equal(link.state, 'live');
  assert.equal(link.rig.name, 'otto');
  assert.equal(link.values.length, link.rig.channels.length);
  assert.ok(Math.abs(link.rate - 24) < 1, String(link.rate));
  line.codes();
  await pass(2000);
  assert.ok(!line.codes().includes(COMMANDS.describe_rig));
});

test('a line that speaks OSC is named, until it speaks the native protocol', async () => {
  const { link, line } = await context();
  const bundle = [0xc0, ...new TextEncoder().encode('#bundle\0'), 0, 0, 0, 0, 0, 0, 0, 1, 0xc0];
  line.to.bytes(Uint8Array.from([...bundle, ...bundle].slice(1)));
  assert.equal(link.problem, '');
  const more = Uint8Array.from([...bundle, ...bundle]);
  line.to.bytes(more.slice(0, 4)); // cut anywhere
  line.to.bytes(more.slice(4));
  assert.match(link.problem, /speaks OSC; .* protocol = "native"/);
  assert.equal(link.state, 'waiting');
  line.to.bytes(franck);
  assert.equal(link.problem, '');
});

test('another line begins without the problem of the one before', async () => {
  const { link, line } = await context();
  const bundle = [0xc0, ...new TextEncoder().encode('#bundle\0'), 0, 0, 0, 0, 0, 0, 0, 1, 0xc0];
  line.to.bytes(Uint8Array.from([...bundle, ...bundle, ...bundle]));
  assert.notEqual(link.problem, '');
  link.open({ open() {}, close() {}, send() {} });
  assert.equal(link.problem, '');
});

test('a rig that changes is taken up though its poses come between its parts', async () => {
  const { link, line, pass } = await context();
  line.to.bytes(franck);
  assert.equal(link.rig.name, 'otto');
  const text = (name) => [name.length, ...new TextEncoder().encode(name)];
  const f32 = (value) => [...new Uint8Array(Float32Array.of(value).buffer)];
  const channel = (i, name) => frame(0x03, [...little(5, 4), i, 0, 255, ...f32(0), ...f32(0), ...f32(1), ...text(name)]);
  const pose = frameOf({ rig_id: 5, frame_seq: 1, captured_us: 1n, age_us: 0, state: 2, steps: [0, 65535] });
  const parts = [frame(0x01, [...little(5, 4), 0, 2, ...text('new')]), channel(0, 'a'), channel(1, 'b')];
  line.to.bytes(pose);
  await pass(1100);
  assert.ok(line.codes().includes(COMMANDS.describe_rig));
  for (const part of parts) {
    line.to.bytes(part);
    line.to.bytes(pose);
  }
  assert.equal(link.rig.name, 'new');
  assert.deepEqual([...link.values], [0, 1]);
});

test('without poses a link is silent, and live again with the next', async () => {
  const { link, line, pass } = await context();
  line.to.bytes(franck.subarray(0, 90000));
  await pass(SILENCE_MS - 100);
  assert.equal(link.state, 'live');
  await pass(300);
  assert.equal(link.state, 'silent');
  line.to.bytes(franck.subarray(90000));
  assert.equal(link.state, 'live');
});

test('a line that is closed is opened again by itself, at growing intervals until it is there', async () => {
  const { link, line, pass } = await context();
  line.to.bytes(franck);
  line.there = false;
  line.to.closed();
  assert.equal(link.state, 'lost');
  await pass(10000);
  assert.equal(link.state, 'lost');
  assert.equal(link.problem, 'nobody answers');
  line.there = true;
  await pass(4200);
  assert.equal(line.opened, 2);
  assert.equal(link.openings, 2);
  assert.equal(link.state, 'waiting');
  line.to.bytes(franck);
  assert.equal(link.state, 'live');
  assert.equal(link.lost, 0);
});

test('bytes of an earlier opening change nothing', async () => {
  const { link, line } = await context();
  const before = line.to;
  link.open(new Line());
  await soon();
  before.bytes(franck);
  before.closed();
  assert.equal(link.state, 'waiting');
  assert.equal(link.rig, null);
});

test('damage and loss are counted over every opening', async () => {
  const { link, line, pass } = await context();
  const bad = franck.slice();
  for (let i = 5000; i < bad.length; i += 5000) bad[i] ^= 1;
  line.to.bytes(bad);
  const { damaged, lost } = link;
  assert.ok(damaged > 10 && lost > 10);
  line.to.closed();
  await pass(1000);
  line.to.bytes(franck);
  assert.deepEqual([link.damaged, link.lost], [damaged, lost]);
});

test('with pings the latency is that from the picture to the page', async () => {
  const { link, line, time, pass } = await context();
  line.to.bytes(franck);
  assert.equal(link.latencyIsWhole, false);
  assert.ok(link.latency > 0 && link.latency < 1000);
  await pass(100);
  const ping = line.sent.findLast((m) => m.code === COMMANDS.ping);
  time.now += 10; // the round trip: its middle is when the device looked at its clock
  const pose = new Decoder().push(franck).findLast((m) => m.type === 'pose');
  const device = Number(pose.captured_us) + 30000;
  line.to.bytes(acknowledgement(ping.id, device));
  time.now += 5;
  line.to.bytes(frameOf(pose));
  assert.equal(link.latencyIsWhole, true);
  // 30 ms old when the device answered, 5 until its answer came, 5 since.
  assert.ok(Math.abs(link.latency - 40) < 1, String(link.latency));
});

test('landmarks are asked for as long as they are wanted, and then once that they end', async () => {
  const { link, line, pass } = await context();
  await pass(2000);
  assert.ok(!line.codes().includes(COMMANDS.landmarks), 'nobody wants any');
  link.landmarkRate = 30;
  await pass(4000);
  const asked = line.sent.splice(0).filter((m) => m.code === COMMANDS.landmarks);
  assert.ok(asked.length >= 4 && asked.every((m) => m.value === 30), 'each second: they last five');
  link.landmarkRate = 0;
  await pass(3000);
  assert.deepEqual(line.sent.filter((m) => m.code === COMMANDS.landmarks).map((m) => m.value), [0]);
});

test('pictures of landmarks are told when they are whole', async () => {
  const { link, line } = await context();
  const told = [];
  link.onLandmarks = (picture) => told.push(picture);
  line.to.bytes(franck);
  assert.ok(told.length > 140, String(told.length));
  assert.ok(told.every(({ points }) => points.length === 2 * 478 && points.every(Number.isFinite)));
});

test('a device that has no landmarks is asked once, and again when the line was opened anew', async () => {
  for (const [result, name] of [[1, 'unknown'], [2, 'refused']]) {
    const { link, line, pass } = await context();
    link.landmarkRate = 30;
    await pass(1000);
    const { id } = line.sent.findLast((m) => m.code === COMMANDS.landmarks);
    line.to.bytes(acknowledgement(id, 0, COMMANDS.landmarks, result));
    assert.equal(link.landmarksRefused, name);
    line.codes();
    await pass(5000);
    assert.ok(!line.codes().includes(COMMANDS.landmarks));
    line.to.closed();
    await pass(3000);
    assert.equal(link.landmarksRefused, '');
    assert.ok(line.codes().includes(COMMANDS.landmarks));
  }
});

// The device's side, for this test alone: frames made from their spelled-out bytes.
function frame(type, payload) {
  const inside = Uint8Array.from([1, type, 0, 0, ...payload]);
  const crc = Uint32Array.of(crc32(inside));
  const out = [0];
  let block = [];
  for (const byte of [...inside, ...new Uint8Array(crc.buffer)]) {
    if (byte !== 0) block.push(byte);
    if (byte === 0 || block.length === 254) {
      out.push(block.length + 1, ...block);
      block = [];
    }
  }
  return Uint8Array.from([...out, block.length + 1, ...block, 0]);
}
function crc32(bytes) {
  let r = 0xffffffff;
  for (const byte of bytes) {
    r ^= byte;
    for (let bit = 0; bit < 8; ++bit) r = (r >>> 1) ^ (r & 1 ? 0xedb88320 : 0);
  }
  return ~r >>> 0;
}
const little = (value, size) => Array.from({ length: size }, (_, i) => Number((BigInt(value) >> BigInt(8 * i)) & 255n));
const acknowledgement = (id, now, code = COMMANDS.ping, result = 0) => frame(0x12, [...little(id, 2), code, result, ...little(now, 8)]);
const frameOf = (pose) => frame(0x10, [...little(pose.rig_id, 4), ...little(pose.frame_seq, 4), ...little(pose.captured_us, 8),
  ...little(pose.age_us, 4), pose.state, pose.steps.length, ...pose.steps.flatMap((s) => little(s, 2))]);

test('a recording plays at its own pace, pauses, and begins again', () => {
  const time = { now: 0 };
  const recording = new Recording(franck, () => time.now);
  const decoder = new Decoder();
  let poses = 0, again = 0;
  recording.open({
    bytes: (bytes) => { poses += decoder.push(bytes).filter((m) => m.type === 'pose').length; },
    again: () => ++again,
  });
  const pass = (ms) => { for (let i = 0; i < ms; i += 10, time.now += 10) recording.step(); };
  pass(2000);
  assert.ok(Math.abs(poses - 48) <= 3, `${poses} poses in two seconds of 24`);
  recording.paused = true;
  pass(5000);
  const paused = poses;
  recording.paused = false;
  pass(100);
  assert.ok(poses > paused && poses < paused + 6);
  pass(30000);
  assert.equal(again, 1);
  recording.close();
});

test('a serial port passes bytes both ways, and says when its cable is pulled', async () => {
  const wire = { in: null, out: [] };
  const port = {
    async open() {
      this.readable = new ReadableStream({ start: (c) => { wire.in = c; } });
      this.writable = new WritableStream({ write: (bytes) => { wire.out.push(...bytes); } });
    },
    async close() { this.closed = true; },
  };
  const got = [];
  let closed = 0;
  const serial = new Serial(port);
  await serial.open({ bytes: (b) => got.push(...b), closed: () => ++closed });
  wire.in.enqueue(Uint8Array.of(1, 2));
  serial.send(Uint8Array.of(3));
  for (let i = 0; i < 5; ++i) await soon();
  assert.deepEqual([got, wire.out], [[1, 2], [3]]);
  wire.in.error(new Error('the device has been lost'));
  for (let i = 0; i < 5; ++i) await soon();
  assert.equal(closed, 1);
  assert.ok(port.closed);
  serial.send(Uint8Array.of(4)); // nobody is there: nothing happens
});
