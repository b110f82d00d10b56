import assert from 'node:assert/strict';
import { File } from 'node:buffer';
import { readFileSync } from 'node:fs';
import { test } from 'node:test';
import { Quaternion, Vector3 } from 'three';

import { Driver } from '../../../tools/host/character/driver.js';
import { BadCharacter, loadCharacter } from '../../../tools/host/character/load.js';
import { ARKIT } from '../../../tools/host/character/names.js';
import { ARKIT as OTTOS } from '../../../tools/host/character/shapes.js';
import { MadeCharacter, arkitCharacter, bonesCharacter, vrm0Character, vrm1Character } from './made_character.mjs';

// Somebody else's characters: what of them moves, and what becomes of files that are none. What a browser has and Node lacks:
globalThis.ProgressEvent ??= class extends Event {};

const file = (name, bytes) => new File([bytes], name);
const load = (name, bytes, ...more) => loadCharacter([file(name, bytes), ...more]);
const rig = (bones, channels) => ({
  bones: bones.map((name) => ({ name })),
  channels: channels.map((name) => {
    const [bone, kind] = name.split('.');
    return { name, kind: kind ?? 'parameter', bone: bones.indexOf(bone) };
  }),
});
// The weights of a character's own targets after these values, by index, to a thousandth.
function weights(character, driver, values) {
  driver.apply(values);
  character.update(0);
  return character.meshes.flatMap((m) => [...m.morphTargetInfluences ?? []]).map((w) => Math.round(1000 * w) / 1000);
}
function place(object) {
  object.updateWorldMatrix(true, false);
  return object.getWorldPosition(new Vector3()).toArray();
}
const near = (a, b, by = 1e-3) => a.forEach((c, k) => assert.ok(Math.abs(c - b[k]) < by, `${a} and not ${b}`));
// Which way an object's rest turned along the character's axes, as the world sees it.
function turnOf(object, pose) {
  const before = object.getWorldQuaternion(new Quaternion());
  pose();
  object.updateWorldMatrix(true, false);
  return object.getWorldQuaternion(new Quaternion()).multiply(before.invert());
}

test('Otto has every shape that ARKit has', () => assert.deepEqual([...OTTOS].sort(), [...ARKIT].sort()));

test('every shape by ARKit\'s name is matched and moved', async () => {
  const character = await load('head.glb', arkitCharacter(ARKIT).glb());
  assert.deepEqual(character.lacking, []);
  const driver = new Driver(character, rig([], ARKIT));
  ARKIT.forEach((_, i) => {
    const moved = weights(character, driver, ARKIT.map((__, k) => (k === i ? 0.5 : 0)));
    assert.deepEqual(moved, ARKIT.map((__, k) => (k === i ? 0.5 : 0)));
  });
  assert.deepEqual([driver.unused, character.unmovedBy(driver.moved)], [[], []]);
});

test('other spellings and synonyms are matched, the surest first, and what nothing moves is named', async () => {
  const made = new MadeCharacter();
  made.head('face', ['eyeBlink_L', 'Blink_L', 'Face.M_F00_000_00_Fcl_MTH_A', 'mouth_smile_r', 'halo', 'cheekPuff_L'], { still: ['mouth_smile_r'] });
  const character = await load('head.glb', made.glb());
  assert.deepEqual([...character.matched], [
    ['eyeBlinkLeft', ['eyeBlink_L']], ['jawOpen', ['Face.M_F00_000_00_Fcl_MTH_A']], ['cheekPuff', ['cheekPuff_L']],
  ]);
  assert.deepEqual(character.still, ['mouth_smile_r']);
  const driver = new Driver(character, rig([], ['eyeBlinkLeft', 'jawOpen', 'mouthSmileRight', 'cheekPuff']));
  assert.deepEqual(driver.unused, ['mouthSmileRight']);
  assert.deepEqual(weights(character, driver, [1, 0.5, 1, 0.2]), [1, 0, 0.5, 0, 0, 0.2]);
  assert.deepEqual(character.unmovedBy(driver.moved), ['Blink_L', 'halo']);
});

test('one target for both eyes closes by half for each', async () => {
  const made = new MadeCharacter();
  made.head('face', ['Blink']);
  const character = await load('head.glb', made.glb());
  const driver = new Driver(character, rig([], ['eyeBlinkLeft', 'eyeBlinkRight']));
  assert.deepEqual(weights(character, driver, [1, 0]), [0.5]);
  assert.deepEqual(weights(character, driver, [1, 1]), [1]);
});

test('VRM 0: expressions move what they bind, and it is turned to face us', async () => {
  const character = await load('puppet.vrm', vrm0Character().glb());
  const driver = new Driver(character, rig(['neck', 'eye_L'], ['eyeBlinkLeft', 'jawOpen', 'mouthSmileLeft', 'neck.yaw', 'eye_L.yaw']));
  assert.deepEqual(driver.unused, []);
  assert.deepEqual(weights(character, driver, [1, 0.5, 0, 0, 0]), [1, 0, 0, 0.5, 0.15, 0]);
  assert.deepEqual(weights(character, driver, [0, 0, 1, 0, 0]), [0, 0, 0, 0, 0, 0.4]);
  assert.ok(place(character.bones.get('eye_L'))[0] > 3, 'its left is on our right');
  assert.deepEqual([...character.aliases], [['Neck', 'neck'], ['Head', 'head'], ['LeftEye', 'eye_L'], ['RightEye', 'eye_R']]);
});

test('VRM 1: a preset for both eyes, several shapes of one expression, and a custom one', async () => {
  const character = await load('puppet.vrm', vrm1Character().glb());
  const driver = new Driver(character, rig([], ['eyeBlinkLeft', 'eyeBlinkRight', 'jawOpen', 'mouthPucker', 'cheekPuff', 'eyeLookOutLeft', 'eyeLookInRight']));
  assert.deepEqual(driver.unused, []);
  assert.deepEqual(weights(character, driver, [1, 1, 0, 0, 0, 0, 0]), [1, 0, 0, 0, 0]);
  assert.deepEqual(weights(character, driver, [0, 0, 0.8, 1, 0, 0, 0]), [0, 0.8, 0.95, 0, 0]);
  assert.deepEqual(weights(character, driver, [0, 0, 0, 0, 1, 1, 1]), [0, 0, 0, 1, 0.5]);
  assert.deepEqual(character.leftToShapes, ['LeftEye', 'RightEye']); // it looks by expressions
});

for (const [version, make, bonesOf] of [
  [0, vrm0Character, (json) => json.extensions.VRM.humanoid], [1, vrm1Character, (json) => json.extensions.VRMC_vrm.humanoid],
]) {
  test(`VRM ${version} without the bones that VRM asks for, all the way to none: a face is a face`, async () => {
    for (const kept of [['hips', 'neck', 'head'], ['head'], []]) {
      const made = make(), { json } = made, humanoid = bonesOf(json);
      humanoid.humanBones = Array.isArray(humanoid.humanBones) ? humanoid.humanBones.filter(({ bone }) => kept.includes(bone))
        : Object.fromEntries(Object.entries(humanoid.humanBones).filter(([bone]) => kept.includes(bone)));
      for (const [i, node] of json.nodes.entries()) if (node.mesh === undefined) node.name = `bone ${i}`; // found by their roles, if at all
      const character = await load('face.vrm', made.glb());
      const driver = new Driver(character, rig([], ['eyeBlinkLeft', 'eyeBlinkRight', 'jawOpen']));
      assert.deepEqual(driver.unused, []);
      const moved = weights(character, driver, [1, 1, 0.5]);
      assert.equal(moved.filter((w) => w > 0).length, version === 0 ? 4 : 3, moved.join());
      assert.deepEqual([...character.aliases.values()], kept.filter((bone) => bone === 'neck' || bone === 'head'));
    }
  });
}

test('what swings by itself goes on for a while after the head has turned, and hangs as in metres', async () => {
  const character = await load('puppet.vrm', vrm1Character().glb());
  const hair = character.root.getObjectByName('hair_1'), turn = () => hair.quaternion.toArray();
  const driver = new Driver(character, rig(['neck'], ['neck.yaw']));
  const swing = (seconds) => {
    for (let t = 0; t < seconds; t += 1 / 60) assert.equal(character.update(1 / 60), true);
    return turn();
  };
  const still = swing(3);
  driver.apply([60]);
  const away = swing(0.1);
  assert.ok(Math.hypot(...away.map((c, k) => c - still[k])) > 0.01, `${away}`);
  near(swing(5), turn(), 1e-3);
  const before = turn();
  near(swing(1), before, 1e-3);
});

test('a face comes to where Otto\'s is, in centimetres, whatever the file has', async () => {
  for (const make of [() => arkitCharacter(ARKIT), vrm0Character, vrm1Character, bonesCharacter]) {
    const character = await load('puppet.glb', make().glb());
    const eyes = character.meshes[0].skeleton.bones.filter((b) => /Eye$/.test(b.name)).map(place);
    near(eyes[0].map((c, k) => (c + eyes[1][k]) / 2), [0, 2.6, 2.6], 0.3);
    near([Math.hypot(...eyes[0].map((c, k) => c - eyes[1][k]))], [6.4], 0.3);
  }
});

test('bones turn along the character\'s axes, whatever their own are, and come back to rest', async () => {
  const character = await load('head.glb', bonesCharacter().glb());
  const jaw = character.bones.get('jaw'), rest = jaw.quaternion.toArray();
  const driver = new Driver(character, rig(['jaw', 'neck'], ['jaw.pitch', 'jaw.position_z', 'neck.yaw']));
  const turn = turnOf(jaw, () => driver.apply([20, 0, 0]));
  near(turn.toArray(), [Math.sin(Math.PI / 18), 0, 0, Math.cos(Math.PI / 18)]);
  const before = place(jaw);
  driver.apply([0, 1, 0]);
  near(place(jaw), [before[0], before[1], before[2] + 1]);
  character.neutral();
  near(jaw.quaternion.toArray(), rest);
});

test('head and neck share what a rig tells only one of them', async () => {
  const character = await load('head.glb', bonesCharacter().glb());
  const [neck, head] = [character.bones.get('neck'), character.bones.get('head')];
  new Driver(character, rig(['neck'], ['neck.yaw'])).apply([50]);
  near(neck.quaternion.toArray(), [0, Math.sin(Math.PI / 18), 0, Math.cos(Math.PI / 18)]);
  near(head.getWorldQuaternion(new Quaternion()).toArray(), [0, Math.sin(50 * Math.PI / 360), 0, Math.cos(50 * Math.PI / 360)]);
  new Driver(character, rig(['Head', 'Neck'], ['Head.yaw', 'Neck.yaw'])).apply([30, 20]);
  near(head.getWorldQuaternion(new Quaternion()).toArray(), [0, Math.sin(50 * Math.PI / 360), 0, Math.cos(50 * Math.PI / 360)]);
});

test('a lid whose bone is at its edge goes round the eye', async () => {
  const character = await load('head.glb', bonesCharacter().glb());
  const lid = character.bones.get('upper_lid_R'), before = place(lid);
  new Driver(character, rig(['upper_lid_R'], ['upper_lid_R.pitch'])).apply([45]);
  const after = place(lid);
  assert.ok(after[1] < before[1] - 0.5, `${before} ${after}`);
});

test('a rig of bones alone moves a character of shapes, and the other way round', async () => {
  const made = new MadeCharacter();
  made.head('face', ['jawOpen', 'eyeBlinkLeft', 'eyeWideLeft', 'eyeLookInLeft']);
  const shapes = await load('head.glb', made.glb());
  const driver = new Driver(shapes, rig(['jaw', 'upper_lid_L', 'eye_L'], ['jaw.pitch', 'upper_lid_L.pitch', 'eye_L.yaw']));
  assert.deepEqual(driver.unused, []);
  assert.deepEqual(weights(shapes, driver, [11, 45, 28]), [0.5, 1, 0, 0]);
  assert.deepEqual(weights(shapes, driver, [0, -12, -14]), [0, 0, 1, 0.5]);
  const bones = await load('head.glb', bonesCharacter().glb()), jaw = bones.bones.get('jaw');
  const turn = turnOf(jaw, () => new Driver(bones, rig([], ['jawOpen'])).apply([1]));
  near(turn.toArray(), [Math.sin(11 * Math.PI / 180), 0, 0, Math.cos(11 * Math.PI / 180)]);
});

test('what a rig tells twice moves once, by the shapes that the character has', async () => {
  const character = await load('head.glb', arkitCharacter(ARKIT).glb());
  const driver = new Driver(character, rig(['jaw', 'eye_L'], ['jaw.pitch', 'jawOpen', 'eye_L.yaw', 'eyeLookOutLeft']));
  assert.deepEqual(driver.unused, []);
  const moved = weights(character, driver, [22, 0.25, 28, 0.5]);
  assert.equal(moved[ARKIT.indexOf('jawOpen')], 0.25);
  assert.equal(moved[ARKIT.indexOf('eyeLookOutLeft')], 0.5);
  assert.deepEqual(character.leftToShapes, ['LeftEye', 'RightEye']);
});

test('a rig that was imported from a character finds its parts by their own names', async () => {
  const made = new MadeCharacter(), head = made.bone('My Head', [0, 1.5, 0]);
  made.bone('bone 17', [0, 1.5, 0.05], head);
  made.head('face', ['a shape of "mine" with a rather long name', 'halo'], { joint: head });
  const character = await load('head.glb', made.glb());
  const driver = new Driver(character, rig(['My_Head'], ['My_Head.yaw', 'a_shape_of_mine_with_a_rather_lo', 'halo'].map((n) => n.slice(0, 31))));
  assert.deepEqual(driver.unused, []);
  assert.deepEqual(weights(character, driver, [0, 1, 0.5]), [1, 0.5]);
});

test('a head without bones turns as a whole', async () => {
  const made = new MadeCharacter();
  made.head('head', ['jawOpen']);
  const character = await load('head.glb', made.glb());
  new Driver(character, rig(['neck'], ['neck.yaw'])).apply([90]);
  character.root.updateMatrixWorld(true);
  near(new Vector3(0, 0, 1).transformDirection(character.meshes[0].matrixWorld).toArray(), [1, 0, 0]);
});

test('a .gltf comes with its buffer, and says what is missing', async () => {
  const made = arkitCharacter(ARKIT), gltf = file('head.gltf', made.gltf('My%20face.bin'));
  const character = await loadCharacter([file('notes.txt', 'x'), gltf, file('my face.bin', made.bin)]);
  assert.equal(character.matched.size, 52);
  await assert.rejects(loadCharacter([gltf]), { message: 'head.gltf needs My face.bin beside it: drop them together, or the folder that they are in' });
});

const glb = arkitCharacter(['jawOpen']).glb();
const edited = (edit) => {
  const made = arkitCharacter(['jawOpen']);
  edit(made.json);
  return made.glb();
};
for (const [what, name, bytes, message] of [
  ['a file that was cut off', 'head.glb', glb.subarray(0, glb.length / 2), /^head\.glb is cut off: \d+ of \d+ bytes are there$/],
  ['a file that was cut off at once', 'head.glb', glb.subarray(0, 10), /^head\.glb is cut off after 10 bytes$/],
  ['another magic number', 'head.glb', Buffer.from(glb).fill('x', 0, 4), /^head\.glb is no glTF; \.glb, \.gltf and \.vrm are right$/],
  ['version 1', 'head.glb', Buffer.from(glb).fill(1, 4, 5), /^head\.glb is a \.glb of version 1; version 2 would be right$/],
  ['damaged JSON', 'head.glb', Buffer.from(glb).fill('?', 30, 31), /^head\.glb is damaged: its JSON cannot be read$/],
  ['no glTF 2', 'head.glb', edited((j) => { j.asset.version = '1.0'; }), /^head\.glb does not say that it is glTF 2/],
  ['no mesh', 'head.glb', edited((j) => { j.meshes = []; }), /^head\.glb has no mesh: there is nothing to show$/],
  ['a mesh that is nowhere', 'head.glb', edited((j) => { j.scenes[0].nodes = [0]; }), /^head\.glb has nothing to see: a mesh with vertices belongs in it$/],
  ['a node that is not there', 'head.glb', edited((j) => { j.nodes[0].children = [99]; }), /^head\.glb is damaged: /],
  ['a view beyond its buffer', 'head.glb', edited((j) => { j.bufferViews[0].byteOffset = 1e8; }), /^head\.glb is damaged: /],
  ['an address that is none', 'head.glb', edited((j) => { j.images = [{ uri: '%' }]; }), /^head\.glb is damaged: /],
  ['Draco', 'head.glb', edited((j) => { j.extensionsUsed = ['KHR_draco_mesh_compression']; }), /^head\.glb cannot be shown: its meshes are compressed by Draco/],
  ['KTX2', 'head.glb', edited((j) => { j.extensionsRequired = j.extensionsUsed = ['KHR_texture_basisu']; }), /^head\.glb cannot be shown: its textures are KTX2/],
  ['a picture', 'me.png', Buffer.from('x'), /^me\.png is no character: \.glb, \.gltf and \.vrm are right$/],
]) {
  test(`${what}: one clear line`, async () => {
    await assert.rejects(load(name, bytes), (error) => {
      assert.ok(error instanceof BadCharacter);
      assert.match(error.message, message);
      return true;
    });
  });
}

test('files with damage anywhere load or give one clear line', async () => {
  let seed = 1;
  const random = (n) => { seed = (seed * 48271) % 0x7fffffff; return seed % n; };
  for (let i = 0; i < 300; ++i) {
    const bytes = Buffer.from(glb);
    for (let k = 0; k < 3; ++k) bytes[random(i % 2 ? 4000 : bytes.length)] = random(256);
    await load('head.glb', bytes).catch((error) => {
      assert.ok(error instanceof BadCharacter, error.stack);
      assert.doesNotMatch(error.message, /\n/);
    });
  }
});

test('the mean head of ICT-FaceKit: 51 of 51 shapes', { skip: !process.env.FACEWIRE_ICT_HEAD && 'FACEWIRE_ICT_HEAD names no file' }, async () => {
  const character = await load('ict_head.glb', readFileSync(process.env.FACEWIRE_ICT_HEAD));
  assert.deepEqual([character.matched.size, character.ownShapes.length, character.lacking], [51, 51, ['tongueOut']]);
});
