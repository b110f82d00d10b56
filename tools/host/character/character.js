import { Bone, BufferAttribute, Color, Group, MathUtils, Mesh, Skeleton, SkinnedMesh } from 'three';

import * as eyes from './eyes.js';
import { SHELL, materials } from './materials.js';
import { addShapes, mirrored } from './mesh.js';
import * as mouth from './mouth.js';
import * as shapes from './shapes.js';
import * as shells from './shells.js';
import { EYE, JAW_HINGE, NECK, mirror } from './surface.js';

// Where a bone turns. Those that are not here (lips, brows) do not turn: they push on a skin or a bar, as shapes named
// after bone and axis, one cm each: "upper_lip.y".
const PIVOTS = {
  neck: NECK, jaw: JAW_HINGE,
  eye_L: EYE, upper_lid_L: EYE, lower_lid_L: EYE,
  eye_R: mirror(EYE), upper_lid_R: mirror(EYE), lower_lid_R: mirror(EYE),
};

const CASTS = new Set(['shell', 'lid', 'skin', 'brow', 'rubber', 'brass', 'steel']);
const INSIDE = new Set(['enamel', 'tongue', 'cornea', 'light']);

// Otto: the character of app/share/otto.toml, in centimetres, looking along z. `root` goes into a scene; bones and shapes
// are set by name.
export class Character {
  name = 'Otto';
  root = new Group();
  bones = new Map(); // name -> Bone
  meshes = []; // in the order of their names
  #shapes = new Map(); // name -> [[mesh, index], ...]
  #limits = new Map(); // offsets of turning bones from where they stand

  constructor() {
    this.root.name = 'otto';
    this.materials = materials();
    this.#addBone('neck', this.root, [0, 0, 0]);
    for (const name of Object.keys(PIVOTS)) if (name !== 'neck') this.#addBone(name, this.bones.get('neck'), NECK);
    this.#build();
  }

  get shapeNames() { return [...this.#shapes.keys()]; }

  // Its shapes that nothing moves, where a driver has `moved`.
  unmovedBy(moved) { return this.shapeNames.filter((name) => !moved.has(name)); }

  // weight: of an ARKit shape 0..1; of a bone's push, cm.
  setShape(name, weight) {
    for (const [mesh, index] of this.#shapes.get(name) ?? []) mesh.morphTargetInfluences[index] = weight;
  }

  // One channel of a bone: 'pitch', 'yaw', 'roll' in degrees or 'position_x' ... in cm, from rest.
  setBone(name, kind, value) {
    const bone = this.bones.get(name);
    const axis = kind.startsWith('position_') ? kind.at(-1) : null;
    if (!bone) {
      if (axis) this.setShape(`${name}.${axis}`, value);
    } else if (axis) {
      bone.position[axis] = bone.userData.rest[axis] + value;
    } else {
      bone.rotation[{ pitch: 'x', yaw: 'y', roll: 'z' }[kind]] = MathUtils.degToRad(value);
    }
  }

  neutral() {
    for (const name of this.shapeNames) this.setShape(name, 0);
    for (const bone of this.bones.values()) {
      bone.position.copy(bone.userData.rest);
      bone.rotation.set(0, 0, 0, 'YXZ');
    }
  }

  #addBone(name, parent, parentPivot) {
    const bone = new Bone();
    bone.name = name;
    bone.rotation.order = 'YXZ'; // Ry Rx Rz
    bone.position.set(...PIVOTS[name].map((c, k) => c - parentPivot[k]));
    bone.userData.rest = bone.position.clone();
    parent.add(bone);
    this.bones.set(name, bone);
  }

  // Geometry is in the head's space; a bone's own space begins at its pivot.
  #add(name, bone, geometry, material, fields = {}, jaw = () => 0) {
    addShapes(geometry, Object.fromEntries(Object.entries(fields).map(([n, f]) => [n, (p, i) => f(p, jaw(i))])));
    const mesh = new Mesh(geometry, this.materials[material]);
    if (bone) mesh.position.set(...PIVOTS[bone].map((c) => -c));
    this.#adopt(name, mesh, bone ? this.bones.get(bone) : this.root);
    return mesh;
  }

  #adopt(name, mesh, parent) {
    mesh.name = name;
    // What lies deep or is small would only cost time in the shadow map; teeth and tongue shall be seen in the mouth's dark.
    mesh.castShadow = CASTS.has(mesh.material.name);
    mesh.receiveShadow = !INSIDE.has(mesh.material.name);
    parent.add(mesh);
    this.meshes.push(mesh);
    mesh.updateMorphTargets();
    for (const [shape, index] of Object.entries(mesh.morphTargetDictionary ?? {})) {
      if (!this.#shapes.has(shape)) this.#shapes.set(shape, []);
      this.#shapes.get(shape).push([mesh, index]);
    }
  }

  // A part of the left side, and its mirror image.
  #addPair(name, bone, make, material, fields = {}) {
    const right = (n) => n?.replace(/_L$/, '_R');
    const bothSided = bone === 'neck';
    this.#add(`${name}_L`, bone, make(), material, fields);
    this.#add(`${name}_R`, right(bone), mirrored(make()), material, bothSided ? fields : shapes.onTheRight(fields));
  }

  #build() {
    const whole = () => 1;
    this.#add('bust', null, shells.bust(), 'shell');
    this.#add('collar', null, shells.collar(), 'brass');
    this.#add('bellows', null, shells.bellows(), 'rubber');
    this.#addPair('neck_rod', null, shells.neckRod, 'steel');

    this.#add('core', 'neck', shells.core(), 'graphite');
    this.#add('face', 'neck', shells.face(), 'shell', shapes.faceShapes);
    this.#addPair('temple', 'neck', shells.temple, 'shell');
    this.#addPair('skull', 'neck', shells.skull, 'shell');
    this.#add('occiput', 'neck', shells.occiput(), 'shell');
    this.#addPair('ear', 'neck', shells.ear, 'graphite');
    this.#addPair('ear_ring', 'neck', shells.earRing, 'brass');
    this.#addPair('cheek_pad', 'neck', shells.cheekPad, 'blush', shapes.cheekShapes);
    this.#addPair('ear_light', 'neck', shells.earLight, 'light');
    this.#addPair('screws', 'neck', shells.screws, 'brass');
    this.#addPair('membrane', 'neck', eyes.membrane, 'lid');
    this.#addPair('bezel', 'neck', eyes.bezel, 'brass');
    this.#addPair('brow', 'neck', shells.brow, 'brow', { ...shapes.browShapes, ...shapes.browBones });
    this.#add('upper_teeth', 'neck', mouth.teeth(1), 'enamel');

    this.#add('jaw_shell', 'jaw', shells.jaw(), 'shell', shapes.jawShapes, whole);
    this.#addJawRods();
    this.#add('lower_teeth', 'jaw', mouth.teeth(-1), 'enamel', shapes.jawShapes, whole);
    this.#add('tongue', 'jaw', mouth.tongue(), 'tongue', { ...shapes.jawShapes, ...shapes.tongueShapes }, whole);

    this.#addPair('eyeball', 'eye_L', eyes.eyeball, 'eye', shapes.eyeShapes);
    this.#addPair('cornea', 'eye_L', eyes.cornea, 'cornea', shapes.eyeShapes);
    this.#addPair('upper_lid', 'upper_lid_L', eyes.upperLid, 'lid', shapes.upperLidShapes);
    this.#addPair('upper_lash', 'upper_lid_L', () => eyes.lash(eyes.UPPER_EDGE, 0.13, 0.05), 'rubber', shapes.upperLidShapes);
    this.#addPair('lower_lid', 'lower_lid_L', eyes.lowerLid, 'lid', shapes.lowerLidShapes);
    this.#addPair('lower_lash', 'lower_lid_L', () => eyes.lash(eyes.LOWER_EDGE, 0.08, -0.06), 'rubber', shapes.lowerLidShapes);
    this.#addMouth();
  }

  #addJawRods() {
    const whole = () => 1;
    this.#add('jaw_rod_L', 'jaw', shells.jawRod(), 'steel', shapes.jawShapes, whole);
    this.#add('jaw_rod_R', 'jaw', mirrored(shells.jawRod()), 'steel', shapes.jawShapes, whole);
  }

  // The one part that two bones share: its upper half hangs on the head, its lower half on the jaw.
  #addMouth() {
    const tone = (hex) => new Color(hex).toArray();
    const { geometry, jaw } = mouth.mouthSkin(tone(SHELL), tone(0xdcc3af), tone(0xb06a5d));
    const fields = { ...shapes.mouthShapes, ...shapes.lipBones };
    addShapes(geometry, Object.fromEntries(Object.entries(fields).map(([n, f]) => [n, (p, i) => f(p, jaw[i])])));
    geometry.setAttribute('skinIndex', new BufferAttribute(new Uint16Array(jaw.flatMap((w) => [0, w > 0 ? 1 : 0, 0, 0])), 4));
    geometry.setAttribute('skinWeight', new BufferAttribute(new Float32Array(jaw.flatMap((w) => [1 - w, w, 0, 0])), 4));
    const mesh = new SkinnedMesh(geometry, this.materials.skin);
    mesh.frustumCulled = false;
    this.#adopt('mouth', mesh, this.root);
    this.root.updateMatrixWorld(true);
    mesh.bind(new Skeleton([this.bones.get('neck'), this.bones.get('jaw')]));
  }
}
