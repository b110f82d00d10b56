import assert from 'node:assert/strict';
import { test } from 'node:test';

import { Vector3 } from 'three';

import { animate } from '../../../tools/host/character/animation.js';
import { Character } from '../../../tools/host/character/character.js';
import { Driver } from '../../../tools/host/character/driver.js';

// A recording as the animation of a character. The file that is made of it needs a browser: browser/record.test.mjs.

const rig = {
  bones: [{ name: 'neck' }, { name: 'jaw' }],
  channels: [
    { name: 'mouthPucker', kind: 'parameter' }, { name: 'jaw.pitch', kind: 'pitch', bone: 1 }, { name: 'neck.yaw', kind: 'yaw', bone: 0 },
  ],
};
const frames = [[0, 0, 0], [0.5, 0, 0], [1, 10, 30]].map((values, i) => ({ t_us: 40_000 * i, values: Float32Array.from(values) }));
const otto = new Character();
const { model, clip } = animate(otto, new Driver(otto, rig), frames, 'take');
const nodes = new Map();
model.traverse((node) => nodes.set(node.uuid, node));
const trackOf = (name, part) => clip.tracks.find((t) => {
  const [uuid, property] = t.name.split('.');
  return nodes.get(uuid).name === name && property === part;
});

test('times are seconds, one key a frame', () => {
  assert.equal(clip.duration, Math.fround(0.08));
  for (const track of clip.tracks) assert.deepEqual([...track.times], [0, 0.04, 0.08].map(Math.fround));
});

test('bones turn as they were told', () => {
  const { values } = trackOf('neck', 'quaternion');
  assert.deepEqual([...values.slice(0, 8)], [0, 0, 0, 1, 0, 0, 0, 1]);
  assert.ok(Math.abs(values[9] - Math.sin(Math.PI / 12)) < 1e-6); // 30 degrees about y
  assert.ok(Math.abs(trackOf('jaw', 'quaternion').values[8] - Math.sin(Math.PI / 36)) < 1e-6);
});

test('morph targets have the weights that they were told, under their own names', () => {
  const { values } = trackOf('mouth', 'morphTargetInfluences');
  const mouth = [...nodes.values()].find(({ name }) => name === 'mouth'), count = mouth.morphTargetInfluences.length;
  const pucker = mouth.morphTargetDictionary.mouthPucker;
  assert.deepEqual([0, 1, 2].map((n) => values[n * count + pucker]), [0, 0.5, 1]);
});

test('what never moves has no track', () => {
  assert.equal(trackOf('eye_L', 'quaternion'), undefined);
  assert.ok(clip.tracks.every(({ name }) => !name.endsWith('.scale') && !name.endsWith('.position')));
});

test('a pose stays over a gap, until shortly before the next', () => {
  const gap = [0, 40_000, 3_040_000].map((t_us, i) => ({ t_us, values: Float32Array.from([0, 0, 20 * (i === 2)]) }));
  const { tracks: [track] } = animate(otto, new Driver(otto, rig), gap, 'gap').clip;
  assert.deepEqual([...track.times], [0, 0.04, 3, 3.04].map(Math.fround));
  assert.deepEqual([...track.values.slice(0, 12)], [0, 0, 0, 1, 0, 0, 0, 1, 0, 0, 0, 1]);
});

test('the model is a copy at neutral, in metres, and the character is back at neutral', () => {
  assert.ok([...nodes.values()].every((node) => node.morphTargetInfluences?.every((w) => w === 0) ?? true));
  assert.ok(!nodes.has(otto.root.uuid));
  model.updateMatrixWorld(true);
  const eye = [...nodes.values()].find(({ name }) => name === 'eye_L').getWorldPosition(new Vector3());
  const own = otto.bones.get('eye_L').getWorldPosition(new Vector3());
  assert.ok(eye.distanceTo(own.multiplyScalar(0.01)) < 1e-6);
  assert.equal(otto.bones.get('neck').rotation.y, 0);
});
