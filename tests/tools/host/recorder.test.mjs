import assert from 'node:assert/strict';
import { test } from 'node:test';

import { LONGEST_US, Recorder } from '../../../tools/host/page/recorder.js';

const rig = { rig_id: 3, channels: [{ name: 'jawOpen' }, { name: 'a,"b"' }] };
const pose = (captured, more = {}) => ({ rig_id: 3, frame_seq: 7, captured_us: BigInt(captured), age_us: 12000, state: 2, ...more });

// It comes as long after the one before as it was taken after it, unless the test says when.
const add = (recorder, at, values = [0, 0], now = at / 1000, more = {}) => recorder.add(pose(at, more), values, now);

function started() {
  const recorder = new Recorder();
  recorder.start(rig);
  return recorder;
}

test('nothing is recorded before it starts and after it stops', () => {
  const recorder = new Recorder();
  add(recorder, 1);
  recorder.start(rig);
  add(recorder, 2);
  recorder.stop();
  add(recorder, 50000);
  assert.equal(recorder.frames.length, 1);
});

test('times are those of the camera, from the first picture', () => {
  const recorder = started();
  for (const at of [5_000_000, 5_041_667, 5_083_333]) add(recorder, at, [0.5, 1]);
  assert.deepEqual(recorder.frames.map((f) => f.t_us), [0, 41667, 83333]);
  assert.equal(recorder.seconds, 0.083333);
});

test('a line that was lost leaves a gap of its length', () => {
  const recorder = started();
  for (const at of [0, 40_000, 3_040_000, 3_080_000]) add(recorder, at);
  assert.deepEqual(recorder.frames.map((f) => f.t_us), [0, 40_000, 3_040_000, 3_080_000]);
});

for (const [what, clock] of [['before', 100], ['far ahead', 9e12]]) {
  test(`another clock, ${what}, goes on as long after the last picture as it came`, () => {
    const recorder = started();
    for (const at of [900_000, 940_000]) add(recorder, at);
    add(recorder, clock, [0, 0], 940 + 500);
    add(recorder, clock + 40_000, [0, 0], 940 + 540);
    assert.deepEqual(recorder.frames.map((f) => f.t_us), [0, 40_000, 540_000, 580_000]);
  });
}

test('pictures that a busy browser took late, all at once, keep their own times', () => {
  const recorder = started();
  add(recorder, 0, [0, 0], 0);
  for (const at of [40_000, 80_000, 1_500_000]) add(recorder, at, [0, 0], 3000);
  assert.deepEqual(recorder.frames.map((f) => f.t_us), [0, 40_000, 80_000, 1_500_000]);
});

test('a pose that tells the same picture again is one frame', () => {
  const recorder = started();
  for (const at of [10, 10, 40_010]) add(recorder, at);
  assert.equal(recorder.frames.length, 2);
});

test('the values are copies', () => {
  const recorder = started(), values = [0.25, 0.5];
  add(recorder, 1, values);
  values[0] = 1;
  assert.deepEqual([...recorder.frames[0].values], [0.25, 0.5]);
});

test('another rig ends a recording, which keeps what it has and says why', () => {
  const recorder = started();
  add(recorder, 1);
  add(recorder, 40_001, [0, 0], 40, { rig_id: 4 });
  assert.deepEqual([recorder.running, recorder.frames.length, recorder.ended], [false, 1, 'the rig has changed']);
});

test('ten minutes end a recording, which keeps what it has and says why', () => {
  const recorder = started();
  for (const at of [0, LONGEST_US, LONGEST_US + 40_000]) add(recorder, at);
  assert.deepEqual([recorder.running, recorder.frames.length, recorder.ended], [false, 2, 'ten minutes are the most']);
});

test('its table is that of facewire monitor --csv, on the clock of the device', () => {
  const recorder = started();
  add(recorder, 1000, [0.1, -2.5]);
  add(recorder, 41_000, [1 / 3, 0], 41, { frame_seq: 8, state: 3 });
  assert.equal(recorder.csv(), 'frame,t_us,age_us,state,jawOpen,"a,""b"""\n7,1000,12000,tracking,0.1,-2.5\n8,41000,12000,holding,0.333333,0\n');
});
