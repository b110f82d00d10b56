import assert from 'node:assert/strict';
import { readFileSync } from 'node:fs';
import { test } from 'node:test';

import { Decoder } from '../../../tools/host/decoder/decoder.js';
import { LandmarkCollector } from '../../../tools/host/decoder/landmarks.js';
import { RigCollector, valuesOf } from '../../../tools/host/decoder/rig.js';
import { CONTOURS, IRISES } from '../../../tools/host/page/landmarks.js';
import { describe, duration } from '../../../tools/host/page/status.js';

const bytes = (at) => new Uint8Array(readFileSync(new URL(`../../../${at}`, import.meta.url)));
const vector = (name) => new Decoder().push(bytes(`tests/core/wire/vectors/${name}.bin`));
const recorded = new Decoder().push(bytes('tools/host/page/franck.bin'));
const pictures = (messages) => {
  const collector = new LandmarkCollector();
  return messages.map((m) => collector.add(m)).filter((p) => p);
};

test('a picture is there with its last part, in pixels', () => {
  const parts = vector('landmarks_picture');
  assert.equal(parts.length, 15);
  const [picture, ...others] = pictures(parts);
  assert.equal(others.length, 0);
  assert.equal(picture.frame_seq, 7);
  assert.deepEqual([picture.width_px, picture.height_px], [640, 480]);
  assert.equal(picture.points.length, 2 * 478);
  // What tests/core/wire/landmark_vectors.cc put into it.
  assert.deepEqual([...picture.points.slice(0, 4)], [100, 50, 100.125, 49.75]);
  assert.equal(picture.points[2 * 477], 100 + 477 / 8);
});

test('a picture without a face is one without points', () => {
  const [picture] = pictures(vector('landmarks_no_face'));
  assert.deepEqual([picture.points.length, picture.width_px, picture.frame_seq], [0, 1280, 8]);
});

test('a picture that lost a part is none, and the next one is', () => {
  const parts = vector('landmarks_picture');
  const next = parts.map((p) => ({ ...p, frame_seq: 8 }));
  for (let lost = 0; lost < parts.length; ++lost) {
    const got = pictures([...parts.filter((_, i) => i !== lost), ...next]);
    assert.deepEqual(got.map((p) => p.frame_seq), [8], `without part ${lost}`);
  }
  assert.equal(pictures([...parts, ...parts]).length, 2, 'a frame number that comes again');
});

test('parts that repeat complete nothing', () => {
  const [part] = vector('landmarks');
  assert.equal(pictures(Array(40).fill(part)).length, 0);
});

test('other messages between the parts change nothing', () => {
  const [pose] = vector('pose');
  assert.equal(pictures(vector('landmarks_picture').flatMap((p) => [p, pose])).length, 1);
});

test('the recording shows the performer in all its poses, eight times a second', () => {
  const poses = recorded.filter((m) => m.type === 'pose');
  const seconds = Number(poses.at(-1).captured_us - poses[0].captured_us) / 1e6;
  const faces = pictures(recorded).filter((p) => p.points.length > 0);
  assert.ok(faces.length > 7 * seconds && faces.length < 9 * seconds, `${faces.length} in ${seconds} s`);
  for (const { points, width_px, height_px } of faces) {
    assert.ok(points.every((v, i) => v > -100 && v < 100 + (i % 2 ? height_px : width_px)));
  }
});

test('the recording smiles, blinks, opens its mouth and turns its head both ways', () => {
  const collector = new RigCollector();
  recorded.forEach((m) => collector.add(m));
  const { rig } = collector;
  const all = recorded.filter((m) => m.type === 'pose').map((pose) => valuesOf(pose, rig));
  const of = (name) => all.map((values) => values[rig.channels.findIndex((c) => c.name === name)]);
  assert.ok(Math.max(...of('mouthSmileLeft')) > 0.5);
  assert.ok(Math.max(...of('eyeBlinkLeft')) > 0.6);
  assert.ok(Math.max(...of('jawOpen')) > 0.3);
  assert.ok(Math.max(...of('neck.yaw')) > 5 && Math.min(...of('neck.yaw')) < -5);
});

test('lines lie on landmarks, go to each at most once, and are the mirror images of those on the other side', () => {
  const [{ points }] = pictures(recorded).filter((p) => p.points.length > 0);
  const centre = (line) => line.reduce((sum, i) => sum + points[2 * i], 0) / line.length;
  const lines = { ...CONTOURS, ...IRISES };
  for (const [name, line] of Object.entries(lines)) {
    assert.ok(line.every((i) => Number.isInteger(i) && i >= 0 && i < 478), name);
    const inside = line[0] === line.at(-1) ? line.slice(1) : line;
    assert.equal(new Set(inside).size, inside.length, name);
    // No jump across the face: neighbours are near.
    const far = Math.abs(points[2 * 454] - points[2 * 234]) / 3;
    line.slice(1).forEach((i, n) => {
      const [dx, dy] = [0, 1].map((k) => points[2 * i + k] - points[2 * line[n] + k]);
      assert.ok(Math.hypot(dx, dy) < far, `${name}: ${line[n]} to ${i}`);
    });
  }
  for (const part of ['eye', 'brow', 'iris']) {
    assert.equal(lines[`${part}Left`].length, lines[`${part}Right`].length);
    assert.ok(centre(lines[`${part}Right`]) < centre(lines.noseBridge), `${part}: the right one is on the picture's left`);
    assert.ok(centre(lines[`${part}Left`]) > centre(lines.noseBridge), part);
  }
});

// The character is not mirrored: its left is the screen's right. Nor is the picture: when the performer's nose goes to the
// picture's right, against the ears, the character must turn to its left, which is a positive yaw.
test('performer and character turn the same way on the screen', () => {
  const collector = new RigCollector();
  recorded.forEach((m) => collector.add(m));
  const yaw = collector.rig.channels.findIndex((c) => c.name === 'neck.yaw');
  const turned = new Map();
  for (const pose of recorded.filter((m) => m.type === 'pose' && m.state === 2)) {
    turned.set(pose.frame_seq, valuesOf(pose, collector.rig)[yaw]);
  }
  const pairs = pictures(recorded).flatMap(({ frame_seq, points }) => {
    const x = (i) => points[2 * i];
    const nose = (x(1) - x(234)) / (x(454) - x(234)); // 0.5: between the ears
    return points.length > 0 && turned.has(frame_seq) ? [[turned.get(frame_seq), nose]] : [];
  });
  const mean = (k) => pairs.reduce((sum, p) => sum + p[k], 0) / pairs.length;
  const [yawMean, noseMean] = [mean(0), mean(1)];
  const sum = (f) => pairs.reduce((total, [a, b]) => total + f(a - yawMean, b - noseMean), 0);
  const correlation = sum((a, b) => a * b) / Math.sqrt(sum((a) => a * a) * sum((_, b) => b * b));
  assert.ok(pairs.length > 100 && correlation > 0.8, `correlation ${correlation} of ${pairs.length} pictures`);
});

test('a status in words and figures', () => {
  const [status] = vector('status');
  assert.deepEqual(describe(status), {
    state: 'holding: the face was just lost', uptime: '1 d 0 h', fps: '30.0', frames: '2589408', dropped: '17', losses: '5',
    errors: '2', p50: '31', p99: '48',
  });
});

test('durations have two units at most', () => {
  const cases = [[0, '0 s'], [59, '59 s'], [60, '1 min 0 s'], [75, '1 min 15 s'], [3600, '1 h 0 min'], [90061, '1 d 1 h']];
  for (const [seconds, text] of cases) assert.equal(duration(seconds), text);
});
