import assert from 'node:assert/strict';
import { readFileSync } from 'node:fs';
import { test } from 'node:test';
import { Vector3 } from 'three';

import { Character } from '../../../tools/host/character/character.js';
import { Driver } from '../../../tools/host/character/driver.js';
import { ARKIT } from '../../../tools/host/character/shapes.js';
import { EYE } from '../../../tools/host/character/surface.js';

const otto = new Character();
const meshNamed = (name) => otto.meshes.find((m) => m.name === name);

// Where every vertex of a mesh is in the world, with shapes, skin and bones.
function vertices(mesh) {
  otto.root.updateMatrixWorld(true);
  const count = mesh.geometry.getAttribute('position').count;
  return Array.from({ length: count }, (_, i) => {
    const p = mesh.getVertexPosition(i, new Vector3());
    return p.applyMatrix4(mesh.matrixWorld).toArray();
  });
}
const allVertices = () => new Map(otto.meshes.map((m) => [m.name, vertices(m)]));
const rest = allVertices();

// { mesh: [[rest, offset], ...] } of the vertices that `pose` moves by more than a hundredth of a mm.
function moved(pose) {
  otto.neutral();
  pose();
  const result = {};
  for (const [name, now] of allVertices()) {
    const pairs = now.map((p, i) => [rest.get(name)[i], p.map((c, k) => c - rest.get(name)[i][k])])
      .filter(([, d]) => Math.hypot(...d) > 1e-3);
    if (pairs.length > 0) result[name] = pairs;
  }
  otto.neutral();
  return result;
}
const byShape = (name) => moved(() => otto.setShape(name, 1));
const farthest = (pairs) => pairs.reduce((a, b) => (Math.hypot(...b[1]) > Math.hypot(...a[1]) ? b : a));
const furthest = (pose) => farthest(Object.values(pose).flat());

test('there is no number that is none', () => {
  for (const mesh of otto.meshes) {
    const { attributes, morphAttributes } = mesh.geometry;
    for (const a of [...Object.values(attributes), ...Object.values(morphAttributes).flat()]) {
      assert.ok(a.array.every(Number.isFinite), `${mesh.name} ${a.name}`);
    }
    for (const i of mesh.geometry.getIndex().array) assert.ok(i < attributes.position.count, mesh.name);
  }
});

test('it has all 52 shapes of ARKit, and each moves something by 2 mm to 7 cm', () => {
  assert.equal(new Set(ARKIT).size, 52);
  for (const name of ARKIT) {
    const [, offset] = furthest(byShape(name));
    const by = Math.hypot(...offset);
    assert.ok(by > 0.2 && by < 7, `${name} moves by ${by} cm`);
  }
});

test('every bone axis and parameter of the default rig moves something', () => {
  const rig = readFileSync(new URL(process.env.FACEWIRE_RIG), 'utf8');
  const axes = [...rig.matchAll(/\[\[bone\]\]\nname = "(\w+)"([^[]*(?:\[[^[][^\n]*\n[^[]*)*)/g)].flatMap(([, bone, body]) =>
    [...body.matchAll(/^(x|y|z|pitch|yaw|roll) = /gm)].map(([, axis]) => [bone, axis]));
  const parameters = [...rig.matchAll(/\[\[parameter\]\]\nname = "(\w+)"/g)].map(([, name]) => name);
  assert.ok(axes.length > 25 && parameters.length > 40);
  for (const [bone, axis] of axes) {
    const kind = axis.length === 1 ? `position_${axis}` : axis;
    assert.notDeepEqual(moved(() => otto.setBone(bone, kind, axis.length === 1 ? 1 : 10)), {}, `${bone}.${axis}`);
  }
  for (const name of parameters) assert.ok(otto.shapeNames.includes(name), name);
});

test('a shape of the left leaves the right alone, and the other way round', () => {
  for (const name of ARKIT.filter((n) => /(Left|Right)$/.test(n) && !/^(jaw|mouth)(Left|Right)$/.test(n))) {
    const sign = name.endsWith('Left') ? 1 : -1;
    const pairs = Object.values(byShape(name)).flat();
    const most = Math.hypot(...farthest(pairs)[1]);
    const wrong = pairs.filter(([p]) => sign * p[0] < -1).map(([, d]) => Math.hypot(...d));
    const allowed = /^mouth/.test(name) ? 0.12 * most : 0.02 * most; // lips are one skin
    assert.ok(Math.max(0, ...wrong) <= allowed, `${name}: ${Math.max(...wrong)} of ${most}`);
  }
});

test('left and right are mirror images', () => {
  for (const name of ARKIT.filter((n) => n.endsWith('Left'))) {
    const mass = (shape, sign) => Object.values(byShape(shape)).flat()
      .reduce((sum, [p, d]) => sum.map((s, k) => s + [sign * p[0], p[1], p[2], sign * d[0], d[1], d[2]][k]), [0, 0, 0, 0, 0, 0]);
    const left = mass(name, 1), right = mass(name.replace('Left', 'Right'), -1);
    left.forEach((v, k) => assert.ok(Math.abs(v - right[k]) <= 0.05 + 0.002 * Math.abs(v), `${name}: ${left} and ${right}`));
  }
});

// What a shape must do to be read at a glance: in which mesh, where its strongest motion is, and which way.
const up = (d) => d[1] > 0.2, down = (d) => d[1] < -0.3, forward = (d) => d[2] > 0.3;
for (const [shape, mesh, check] of [
  ['eyeBlinkLeft', 'upper_lid_L', (p, d) => down(d) && p[0] > 0],
  ['eyeBlinkRight', 'upper_lid_R', (p, d) => down(d) && p[0] < 0],
  ['eyeWideLeft', 'upper_lid_L', (p, d) => up(d)],
  ['eyeSquintLeft', 'lower_lid_L', (p, d) => up(d)],
  ['eyeLookOutLeft', 'eyeball_L', (p, d) => d[0] > 0.5],
  ['eyeLookInLeft', 'eyeball_L', (p, d) => d[0] < -0.5],
  ['eyeLookInRight', 'eyeball_R', (p, d) => d[0] > 0.5],
  ['eyeLookUpLeft', 'eyeball_L', (p, d) => up(d)],
  ['browDownLeft', 'brow_L', (p, d) => down(d)],
  ['browInnerUp', 'brow_R', (p, d) => up(d) && p[0] > -2.5],
  ['browOuterUpRight', 'brow_R', (p, d) => up(d) && p[0] < -4],
  ['jawOpen', 'jaw_shell', (p, d) => down(d)],
  ['jawLeft', 'jaw_shell', (p, d) => d[0] > 0.5],
  ['jawForward', 'lower_teeth', (p, d) => forward(d)],
  ['mouthSmileLeft', 'mouth', (p, d) => up(d) && d[0] > 0.3 && p[0] > 1.5],
  ['mouthFrownRight', 'mouth', (p, d) => down(d) && p[0] < -1.5],
  ['mouthPucker', 'mouth', (p, d) => d[0] * p[0] < 0 || d[2] > 0.7],
  ['mouthFunnel', 'mouth', (p, d) => forward(d)],
  ['mouthLeft', 'mouth', (p, d) => d[0] > 0.5],
  ['mouthLowerDownLeft', 'mouth', (p, d) => down(d) && p[1] < -4.3],
  ['mouthUpperUpRight', 'mouth', (p, d) => up(d) && p[1] > -4.5],
  ['cheekPuff', 'cheek_pad_L', (p, d) => forward(d)],
  ['cheekSquintRight', 'cheek_pad_R', (p, d) => up(d)],
  ['noseSneerLeft', 'face', (p, d) => up(d) && p[0] > 0],
  ['tongueOut', 'tongue', (p, d) => forward(d)],
]) {
  test(`${shape} moves ${mesh} the right way`, () => {
    const [at, offset] = farthest(byShape(shape)[mesh]);
    assert.ok(check(at, offset), `at ${at} by ${offset}`);
  });
}

test('lips meet at rest, open with the jaw, and close again over it', () => {
  const mesh = meshNamed('mouth');
  const gap = () => {
    const middle = vertices(mesh).filter((p, i) => Math.abs(rest.get('mouth')[i][0]) < 0.15 && rest.get('mouth')[i][2] > 5);
    const ys = middle.map((p) => p[1]).sort((a, b) => a - b);
    return Math.max(...ys.slice(1).map((y, i) => y - ys[i]));
  };
  otto.neutral();
  const closed = gap();
  otto.setBone('jaw', 'pitch', 22);
  const open = gap();
  otto.setShape('mouthClose', 1);
  const again = gap();
  otto.neutral();
  assert.ok(open > closed + 2, `${closed} ${open}`);
  assert.ok(again < 0.6 * open, `${open} ${again}`);
});

const eye = (name) => [name.endsWith('_L') ? EYE[0] : -EYE[0], EYE[1], EYE[2]];
// Of each vertex of a part of an eye: how far from the eye's middle, and how far across and up, degrees.
const aroundEye = (name) => vertices(meshNamed(name)).map((p) => p.map((c, k) => c - eye(name)[k]))
  .map(([x, y, z]) => ({ radius: Math.hypot(x, y, z), across: (180 / Math.PI) * Math.asin(x / Math.hypot(x, y, z)), up: (180 / Math.PI) * Math.atan2(y, z) }));

for (const side of ['L', 'R']) {
  test(`the lids of eye ${side} close without a gap, and the lower one's lash goes under the upper one`, () => {
    otto.neutral();
    for (const shape of ['eyeBlinkLeft', 'eyeBlinkRight']) otto.setShape(shape, 1);
    const [upper, lower, lash] = ['upper_lid', 'lower_lid', 'lower_lash'].map((part) => aroundEye(`${part}_${side}`));
    otto.neutral();
    for (let across = -60; across <= 60; across += 10) {
      const near = (lid) => lid.filter((v) => Math.abs(v.across - across) < 4).map(({ up }) => up);
      assert.ok(Math.min(...near(upper)) < Math.max(...near(lower)), `at ${across}`);
    }
    const outside = upper.filter(({ up, across }) => up > 20 && up < 60 && Math.abs(across) < 60).map(({ radius }) => radius);
    assert.ok(Math.max(...lash.map(({ radius }) => radius)) <= Math.min(...outside), 'the lash sticks out');
  });
}

test('a cheek pad is an even oval, also where a smile lifts it', () => {
  otto.neutral();
  for (const smile of [0, 1]) {
    otto.setShape('mouthSmileLeft', smile);
    const pad = vertices(meshNamed('cheek_pad_L')), [x, y] = [0, 1].map((k) => pad.reduce((sum, p) => sum + p[k], 0) / pad.length);
    const outline = Array.from({ length: 24 }, (_, i) => {
      const [c, s] = [Math.cos((2 * Math.PI * i) / 24) / 1.12, Math.sin((2 * Math.PI * i) / 24) / 0.98];
      return Math.max(...pad.map((p) => c * (p[0] - x) + s * (p[1] - y)));
    });
    assert.ok(Math.max(...outline) - Math.min(...outline) < 0.025, `${smile}: ${Math.min(...outline)} to ${Math.max(...outline)}`);
  }
  otto.neutral();
});

test('in an open mouth nothing stands in the tongue, and the lower teeth come over the lip', () => {
  otto.neutral();
  otto.setBone('jaw', 'pitch', 22);
  const tongue = vertices(meshNamed('tongue')).filter((p) => p[2] > -2.5);
  const [low, high] = [Math.min, Math.max].map((most) => [0, 1, 2].map((k) => most(...tongue.map((p) => p[k]))));
  const between = ['core', 'bellows'].flatMap((name) => vertices(meshNamed(name))).filter((p) => p.every((c, k) => c > low[k] && c < high[k]));
  assert.deepEqual(between, []);
  const middle = (name) => vertices(meshNamed(name)).filter((p) => Math.abs(p[0]) < 0.5);
  const teeth = Math.max(...middle('lower_teeth').map((p) => p[1]));
  // Lip and teeth as they are seen from before.
  const mouth = middle('mouth').filter((p, i) => rest.get('mouth')[i][1] < -4.4 && p[2] > 2.5 && p[1] < -5);
  assert.ok(teeth > Math.max(...mouth.filter((p) => p[2] > 3.2).map((p) => p[1])), `teeth up to ${teeth}`);
  otto.neutral();
});

test('the jaw opens alike as a bone and as a shape', () => {
  const asBone = moved(() => otto.setBone('jaw', 'pitch', 22)), asShape = byShape('jawOpen');
  for (const mesh of ['jaw_shell', 'lower_teeth', 'mouth']) {
    assert.equal(asBone[mesh].length, asShape[mesh].length, mesh);
    asBone[mesh].forEach(([, d], i) => d.forEach((c, k) => assert.ok(Math.abs(c - asShape[mesh][i][1][k]) < 1e-3, mesh)));
  }
});

test('the neck turns the whole head and leaves the bust', () => {
  const parts = moved(() => otto.setBone('neck', 'yaw', 30));
  for (const name of ['face', 'mouth', 'jaw_shell', 'eyeball_L', 'skull_R']) assert.ok(parts[name], name);
  assert.ok(!parts.bust && !parts.bellows);
  const [nose] = parts.face.filter(([p]) => p[2] > 7);
  assert.ok(nose[1][0] > 1); // to its own left
});

const rig = (bones, channels) => ({
  bones: bones.map((name) => ({ name })),
  channels: channels.map(([name, kind = 'parameter']) => ({ name, kind, bone: bones.indexOf(name.split('.')[0]) })),
});

test('what a rig says twice moves once: hard parts by bones, soft ones by shapes', () => {
  const twice = rig(['jaw', 'upper_lip'], [['jaw.pitch', 'pitch'], ['jawOpen'], ['upper_lip.y', 'position_y'], ['mouthUpperUpLeft']]);
  const driver = new Driver(otto, twice);
  assert.deepEqual(driver.unused, []);
  const apply = (values) => moved(() => driver.apply(values));
  assert.deepEqual(apply([0, 1, 1, 0]), {});
  assert.ok(apply([10, 0, 0, 0]).jaw_shell && apply([0, 0, 0, 1]).mouth);
});

test('a rig of shapes alone, or of bones alone, moves the same face', () => {
  const shapes = new Driver(otto, rig([], [['jawOpen'], ['browInnerUp'], ['eyeBlinkLeft']]));
  assert.deepEqual(Object.keys(moved(() => shapes.apply([0, 1, 0]))), ['brow_L', 'brow_R']);
  assert.ok(moved(() => shapes.apply([1, 0, 1])).upper_lid_L);
  const bones = new Driver(otto, rig(['upper_lip'], [['upper_lip.y', 'position_y']]));
  assert.deepEqual(Object.keys(moved(() => bones.apply([1]))), ['mouth']);
});

test('channels that the character has nothing for are named', () => {
  const driver = new Driver(otto, rig(['tail'], [['tail.yaw', 'yaw'], ['wiggle'], ['jawOpen']]));
  assert.deepEqual(driver.unused, ['tail.yaw', 'wiggle']);
  driver.apply([1, 1, 0]);
});
