import assert from 'node:assert/strict';
import { test } from 'node:test';

import { Pace } from '../../../tools/host/page/pace.js';

// Plays `seconds` of frames that take cost(scale) ms, on a screen that shows one every `screen` ms; the scales it went through.
function play(pace, seconds, cost, { from = 0, screen = 16.7 } = {}) {
  const scales = [pace.scale];
  for (let now = from; now < from + 1000 * seconds;) {
    const took = Math.ceil(cost(pace.scale) / screen) * screen;
    now += took;
    if (pace.frame(now, took, true)) scales.push(pace.scale);
  }
  return scales;
}

test('a quick computer keeps every pixel', () => {
  assert.deepEqual(play(new Pace(), 20, () => 8), [1]);
});

test('a slow one falls by steps to a floor, not below', () => {
  const pace = new Pace();
  const scales = play(pace, 20, () => 120);
  assert.ok(scales.length > 3 && scales.every((s, i) => i === 0 || s < scales[i - 1]));
  assert.equal(scales.at(-1), 0.5);
});

test('it recovers when the computer has time again', () => {
  const pace = new Pace();
  pace.frame(0, 16.7, false);
  play(pace, 10, () => 60);
  assert.equal(pace.scale, 0.5);
  play(pace, 30, () => 8, { from: 10000 });
  assert.equal(pace.scale, 1);
});

test('between two steps it does not waver: ever fewer tries', () => {
  const pace = new Pace();
  pace.frame(0, 16.7, false);
  const changes = (from, seconds) => play(pace, seconds, (scale) => 20 * scale ** 2, { from }).length - 1;
  changes(0, 60);
  assert.ok(changes(60000, 60) <= 6);
});

test('a screen of 30 Hz is not slow, nor is a page that slept', () => {
  const pace = new Pace();
  assert.deepEqual(play(pace, 10, () => 8, { screen: 33.3 }), [1]);
  assert.equal(pace.frame(20000, 9000, true), false);
  assert.equal(pace.scale, 1);
});
