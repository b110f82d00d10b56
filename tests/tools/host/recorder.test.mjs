import assert from 'node:assert/strict';
import { test } from 'node:test';

import { LONGEST_US, Recorder } from '../../../tools/host/page/recorder.js';

const rig = { rig_id: 3, channels: [{ name: 'jawOpen' }, { name: 'a,"b"' }] };
const pose = (captured, more = {}) => ({ rig_id: 3, frame_seq: 7, captured_us: BigInt(captured), age_us: 12000, state: 2, ...more });

function started() {
  const recorder = new Recorder();
  recorder.start(rig);
  return recorder;
}

test('nothing is recorded before it starts and after it stops', () => {
  const recorder = new Recorder();
  recorder.add(pose(1), [0, 0]);
  recorder.start(rig);
  recorder.add(pose(2), [0, 0]);
  recorder.stop();
  recorder.add(pose(50000), [0, 0]);
  assert.equal(recorder.frames.length, 1);
});

test('times are those of the camera, from the first picture', () => {
  const recorder = started();
  for (const at of [5_000_000, 5_041_667, 5_083_333]) recorder.add(pose(at), [0.5, 1]);
  assert.deepEqual(recorder.frames.map((f) => f.t_us), [0, 41667, 83333]);
  assert.equal(recorder.seconds, 0.083333);
});

test('a line that was lost leaves a gap of its length', () => {
  const recorder = started();
  for (const at of [0, 40_000, 3_040_000, 3_080_000]) recorder.add(pose(at), [0, 0]);
  assert.deepEqual(recorder.frames.map((f) => f.t_us), [0, 40_000, 3_040_000, 3_080_000]);
});

test('a device that starts anew, with another clock, goes on one picture later', () => {
  const recorder = started();
  for (const at of [900_000, 940_000, 980_000, 100, 40_100]) recorder.add(pose(at), [0, 0]);
  assert.deepEqual(recorder.frames.map((f) => f.t_us), [0, 40_000, 80_000, 120_000, 160_000]);
});

test('a pose that tells the same picture again is one frame', () => {
  const recorder = started();
  for (const at of [10, 10, 40_010]) recorder.add(pose(at), [0, 0]);
  assert.equal(recorder.frames.length, 2);
});

test('the values are copies', () => {
  const recorder = started(), values = [0.25, 0.5];
  recorder.add(pose(1), values);
  values[0] = 1;
  assert.deepEqual([...recorder.frames[0].values], [0.25, 0.5]);
});

test('another rig ends a recording, which keeps what it has and says why', () => {
  const recorder = started();
  recorder.add(pose(1), [0, 0]);
  recorder.add(pose(40_001, { rig_id: 4 }), [0, 0]);
  assert.deepEqual([recorder.running, recorder.frames.length, recorder.ended], [false, 1, 'the rig has changed']);
});

test('ten minutes end a recording, which keeps what it has and says why', () => {
  const recorder = started();
  for (const at of [0, LONGEST_US, LONGEST_US + 40_000]) recorder.add(pose(at), [0, 0]);
  assert.deepEqual([recorder.running, recorder.frames.length, recorder.ended], [false, 2, 'ten minutes are the most']);
});

test('its table is that of facewire monitor --csv', () => {
  const recorder = started();
  recorder.add(pose(1000), [0.1, -2.5]);
  recorder.add(pose(41_000, { frame_seq: 8, state: 3 }), [1 / 3, 0]);
  assert.equal(recorder.csv(), 'frame,t_us,age_us,state,jawOpen,"a,""b"""\n7,0,12000,tracking,0.1,-2.5\n8,40000,12000,holding,0.333333,0\n');
});
