// A character file made of code, small and in metres: a head of a person's size on as many bones as are asked for, with morph
// targets that each move something. Facing -z where `front` is -1, as VRM 0 does.

const EYES_Y = 1.6, RINGS = 36, SECTORS = 48, RADII = [0.075, 0.11, 0.09], CENTRE = [0, 1.57, 0];

// Where on the face a shape of that name moves something, and which way; left is where x is greater.
function region(name) {
  const side = /left|_l$/i.test(name) ? 1 : /right|_r$/i.test(name) ? -1 : 0;
  if (/jaw|mouthclose|^a+$|tongue|open/i.test(name)) return { at: [0, 1.5, 0.08], by: [0, -0.02, 0] };
  if (/brow/i.test(name)) return { at: [0.03 * side, 1.63, 0.08], by: [0, 0.012, 0.004] };
  if (/eye|blink|wink|look/i.test(name)) return { at: [0.032 * side, EYES_Y, 0.08], by: [0, -0.01, 0.002], both: side === 0 };
  if (/cheek|nose/i.test(name)) return { at: [0.035 * side, 1.56, 0.075], by: [0, 0.004, 0.012] };
  return { at: [0.02 * side, 1.52, 0.085], by: [0.008 * side, 0.008, 0.004] };
}
const distance = (a, b) => Math.hypot(...a.map((c, k) => c - b[k]));

function headVertices() {
  const positions = [], triangles = [];
  for (let i = 0; i <= RINGS; ++i) {
    for (let j = 0; j <= SECTORS; ++j) {
      const up = Math.PI * (i / RINGS), round = 2 * Math.PI * (j / SECTORS);
      const unit = [Math.sin(up) * Math.sin(round), Math.cos(up), Math.sin(up) * Math.cos(round)];
      positions.push(unit.map((c, k) => CENTRE[k] + RADII[k] * c));
      if (i < RINGS && j < SECTORS) {
        const a = i * (SECTORS + 1) + j, b = a + SECTORS + 1;
        triangles.push([a, b, a + 1], [a + 1, b, b + 1]);
      }
    }
  }
  return { positions, triangles };
}

// The rest of the bones that VRM asks for: [bone, above it, place], those of the sides on the left.
const BODY = [['spine', 'hips', [0, 1.1, 0]]];
const LIMBS = [
  ['UpperLeg', 'hips', [0.1, 0.85, 0]], ['LowerLeg', 'UpperLeg', [0.1, 0.5, 0]], ['Foot', 'LowerLeg', [0.1, 0.08, 0]],
  ['UpperArm', 'spine', [0.15, 1.38, 0]], ['LowerArm', 'UpperArm', [0.4, 1.38, 0]], ['Hand', 'LowerArm', [0.65, 1.38, 0]],
];

export class MadeCharacter {
  json = { asset: { version: '2.0' }, scene: 0, scenes: [{ nodes: [] }], nodes: [], meshes: [], accessors: [], bufferViews: [], buffers: [] };
  #front;
  #places = [];
  #bytes = [];
  #size = 0;

  constructor(front = 1) { this.#front = front; }

  // A joint at `place` in the scene, with its own axes turned by `rotation` (a quaternion); returns its node.
  bone(name, place, parent = -1, rotation = null) {
    const { nodes, scenes } = this.json, node = nodes.length;
    const world = [this.#front * place[0], place[1], this.#front * place[2]];
    const from = parent < 0 ? [0, 0, 0] : this.#places[parent];
    nodes.push({ name, translation: world.map((c, k) => c - from[k]), ...(rotation && { rotation }) });
    this.#places.push(world);
    if (parent < 0) scenes[0].nodes.push(node);
    else (nodes[parent].children ??= []).push(node);
    return node;
  }

  // Head, neck and eyes of a person; the nodes by name.
  person() {
    const hips = this.bone('Hips', [0, 0.9, 0]), neck = this.bone('Neck', [0, 1.45, 0], hips), head = this.bone('Head', [0, 1.5, 0], neck);
    const leftEye = this.bone('LeftEye', [0.032, EYES_Y, 0.06], head), rightEye = this.bone('RightEye', [-0.032, EYES_Y, 0.06], head);
    return { hips, neck, head, leftEye, rightEye };
  }

  // The same with a body, by VRM's names.
  humanoid() {
    const nodes = this.person();
    for (const [name, above, place] of BODY) nodes[name] = this.bone(name, place, nodes[above]);
    for (const [side, x] of [['left', 1], ['right', -1]]) {
      for (const [name, above, place] of LIMBS) nodes[side + name] = this.bone(side + name, [x * place[0], place[1], place[2]], nodes[side + above] ?? nodes[above]);
    }
    return nodes;
  }

  // A head with these morph targets, each of which moves something unless it is in `still`; skinned to `joint`, or stiff. Returns the mesh.
  head(name, shapes, { joint = null, still = [] } = {}) {
    const { positions, triangles } = headVertices(), { json } = this, front = this.#front;
    const faced = (p) => [front * p[0], p[1], front * p[2]];
    const colour = (p) => (Math.min(distance(p, [0.032, EYES_Y, 0.075]), distance(p, [-0.032, EYES_Y, 0.075])) < 0.02 ? [0.02, 0.03, 0.05]
      : distance(p, [0, 1.515, 0.08]) < 0.022 ? [0.5, 0.08, 0.08] : [0.7, 0.55, 0.45]);
    const attributes = { POSITION: this.#floats(positions.map(faced), true), COLOR_0: this.#floats(positions.map(colour)) };
    if (joint !== null) {
      attributes.JOINTS_0 = this.#add(new Uint8Array(4 * positions.length), { componentType: 5121, type: 'VEC4', count: positions.length });
      attributes.WEIGHTS_0 = this.#floats(positions.map(() => [1, 0, 0, 0]));
    }
    const targets = shapes.map((shape) => {
      const { at, by, both } = region(shape), nothing = still.includes(shape);
      return { POSITION: this.#floats(positions.map((p) => {
        const near = Math.min(distance(p, at), both ? distance([Math.abs(p[0]), p[1], p[2]], [0.032, at[1], at[2]]) : Infinity);
        return faced(nothing || near > 0.03 ? [0, 0, 0] : by);
      }), true) };
    });
    const indices = this.#add(new Uint16Array(triangles.flat()), { componentType: 5123, type: 'SCALAR', count: 3 * triangles.length });
    const mesh = json.meshes.push({ name, primitives: [{ attributes, indices, ...(targets.length > 0 && { targets }) }], extras: { targetNames: shapes } }) - 1;
    const node = json.nodes.push({ name, mesh }) - 1;
    this.#places.push([0, 0, 0]);
    json.scenes[0].nodes.push(node);
    if (joint !== null) this.#skin(node, joint);
    return mesh;
  }

  // Everything in this material.
  paint(material) {
    this.json.materials = [material];
    for (const { primitives } of this.json.meshes) for (const primitive of primitives) primitive.material = 0;
  }

  #skin(node, joint) {
    const joints = [joint, ...this.json.nodes.keys()].filter((n, i, all) => all.indexOf(n) === i && this.json.nodes[n].mesh === undefined);
    const inverse = joints.map((n) => [1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0, ...this.#places[n].map((c) => -c), 1]);
    const skins = (this.json.skins ??= []);
    this.json.nodes[node].skin = skins.push({ joints, inverseBindMatrices: this.#floats(inverse, false, 'MAT4') }) - 1;
  }

  #floats(rows, bounds = false, type = `VEC${rows[0].length}`) {
    const limit = (f) => rows[0].map((_, k) => Math.fround(f(...rows.map((r) => Math.fround(r[k])))));
    return this.#add(new Float32Array(rows.flat()), { componentType: 5126, type, count: rows.length, ...(bounds && { min: limit(Math.min), max: limit(Math.max) }) });
  }
  #add(array, accessor) {
    const bytes = Buffer.from(array.buffer, array.byteOffset, array.byteLength), padding = Buffer.alloc(-bytes.length & 3);
    const bufferView = this.json.bufferViews.push({ buffer: 0, byteOffset: this.#size, byteLength: bytes.length }) - 1;
    this.#bytes.push(bytes, padding);
    this.#size += bytes.length + padding.length;
    return this.json.accessors.push({ bufferView, ...accessor }) - 1;
  }

  get bin() { return Buffer.concat(this.#bytes); }
  // As text; what it refers to is `bin`, under the name `uri`.
  gltf(uri) { return Buffer.from(JSON.stringify({ ...this.json, buffers: [{ byteLength: this.#size, uri }] })); }
  glb() {
    const text = Buffer.from(JSON.stringify({ ...this.json, buffers: [{ byteLength: this.#size }] }));
    const json = Buffer.concat([text, Buffer.alloc(-text.length & 3, ' ')]);
    const words = (...list) => Buffer.from(new Uint32Array(list).buffer);
    return Buffer.concat([words(0x46546c67, 2, 28 + json.length + this.#size, json.length, 0x4e4f534a), json, words(this.#size, 0x004e4942), this.bin]);
  }
}

// --- the conventions

// Every shape by ARKit's name, on a skinned head.
export function arkitCharacter(shapes) {
  const made = new MadeCharacter(), { head } = made.person();
  made.head('face', shapes, { joint: head });
  return made;
}

// How far eyes turn for what they look at: linear, as most files have it.
const LOOK_0 = Object.fromEntries(['HorizontalInner', 'HorizontalOuter', 'VerticalDown', 'VerticalUp']
  .map((way) => [`lookAt${way}`, { curve: [0, 0, 0, 1, 1, 1, 1, 0], xRange: 90, yRange: 10 }]));

// VRM 0: faces -z, expressions combine shapes, the eyes turn by bones.
export function vrm0Character() {
  const made = new MadeCharacter(-1), nodes = made.humanoid(), { head } = nodes;
  const mesh = made.head('Face', ['Close_L', 'Close_R', 'Close', 'A', 'MouthWide', 'Grin'], { joint: head });
  const group = (presetName, ...binds) => ({ name: presetName, presetName, binds: binds.map(([index, weight]) => ({ mesh, index, weight })) });
  const human = Object.entries(nodes).map(([bone, node]) => ({ bone, node }));
  made.json.extensionsUsed = ['VRM'];
  made.paint({ name: 'toon' });
  made.json.extensions = { VRM: {
    specVersion: '0.0', exporterVersion: 'made', meta: { title: 'Old Puppet' }, humanoid: { humanBones: human },
    firstPerson: { lookAtTypeName: 'Bone', firstPersonBone: head, ...LOOK_0 },
    materialProperties: [{
      name: 'toon', shader: 'VRM/MToon', floatProperties: { _ShadeToony: 0.9 }, vectorProperties: { _Color: [1, 1, 1, 1] },
      textureProperties: {}, keywordMap: {}, tagMap: {},
    }],
    blendShapeMaster: { blendShapeGroups: [
      group('blink_l', [0, 100]), group('blink_r', [1, 100]), group('blink', [2, 100]), group('a', [3, 100], [4, 30]),
      group('joy', [5, 80]), group('lookup'), group('neutral'),
    ] },
  } };
  return made;
}

// VRM 1: looks by expressions; its hair swings.
export function vrm1Character() {
  const made = new MadeCharacter(), nodes = made.humanoid(), { head } = nodes;
  const hair = ['hair_1', 'hair_2', 'hair_3'].reduce((above, name, i) => [...above, made.bone(name, [0, 1.66 - 0.05 * i, -0.1], above.at(-1) ?? head)], []);
  made.head('Face', ['m0_eye', 'm1_open', 'm2', 'm3_look', 'm4_cheek'], { joint: head });
  const node = made.json.nodes.length - 1;
  const expression = (...binds) => ({ morphTargetBinds: binds.map(([index, weight]) => ({ node, index, weight })) });
  const human = Object.fromEntries(Object.entries(nodes).map(([bone, n]) => [bone, { node: n }]));
  made.json.extensionsUsed = ['VRMC_vrm', 'VRMC_springBone', 'VRMC_materials_mtoon'];
  made.paint({ name: 'toon', extensions: { VRMC_materials_mtoon: {
    specVersion: '1.0', shadeColorFactor: [0.6, 0.4, 0.4], outlineWidthMode: 'worldCoordinates', outlineWidthFactor: 0.002,
  } } });
  made.json.extensions = { VRMC_springBone: {
    specVersion: '1.0', springs: [{ joints: hair.map((node) => ({ node, stiffness: 1, gravityPower: 0.5, dragForce: 0.4, hitRadius: 0.01 })) }],
  }, VRMC_vrm: {
    specVersion: '1.0', meta: { name: 'New Puppet', authors: ['nobody'], licenseUrl: 'https://vrm.dev/licenses/1.0/' },
    humanoid: { humanBones: human }, lookAt: { type: 'expression' },
    expressions: {
      preset: { blink: expression([0, 1]), aa: expression([1, 1], [2, 0.25]), ou: expression([2, 0.75]), lookLeft: expression([3, 1]) },
      custom: { cheekPuff: expression([4, 0.5]) },
    },
  } };
  return made;
}

// No shapes: a head of stiff parts on bones, one of whose own axes are turned.
export function bonesCharacter() {
  const made = new MadeCharacter(), { head } = made.person();
  made.bone('Jaw', [0, 1.57, 0.02], head, [0, 0, Math.SQRT1_2, Math.SQRT1_2]);
  made.bone('eyelid_upper_L', [0.032, EYES_Y, 0.06], head);
  made.bone('eyelid_upper_R', [-0.032, EYES_Y + 0.003, 0.073], head);
  made.bone('mouth_corner.L', [0.025, 1.52, 0.075], head);
  made.bone('tail', [0, 0.9, -0.1], 0);
  made.head('face', [], { joint: head });
  return made;
}
