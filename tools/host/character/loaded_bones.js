import { Euler, MathUtils, Matrix4, Vector3 } from 'three';

import { matchBone, matchHumanoid, partName } from './names.js';

// The bones of somebody else's character, under the names that they have in app/share/otto.toml.

// What of ARKit's moves the same part of a face.
const SHOWN_BY = [
  [/^eye_/, 'eyeLook'], [/_lid_/, 'eyeBlink'], [/^jaw/, 'jawOpen'], [/^brow/, 'brow'], [/^(lip_|upper_lip|lower_lip|chin)/, 'mouth'],
  [/^cheek/, 'cheek'], [/^nostril/, 'nose'],
];
export const shownBy = (part) => SHOWN_BY.find(([pattern]) => pattern.test(part))?.[1] ?? null;

function depthOf(object) {
  let depth = 0;
  for (let at = object; at.parent; at = at.parent) ++depth;
  return depth;
}

// What may be a bone: joints of skins, or, where nothing is skinned, every node: an animatronic head's parts are stiff.
function candidates({ scene, parser }) {
  const joints = new Set(), nodes = [];
  let meshes = 0;
  scene.traverse((object) => {
    for (const bone of object.skeleton?.bones ?? []) joints.add(bone);
    if (object.isMesh) ++meshes;
    if (parser.associations.get(object)?.nodes !== undefined) nodes.push(object);
  });
  const carries = (object) => {
    let count = 0;
    object.traverse((o) => { if (o.isMesh) ++count; });
    return count;
  };
  // A node that carries all there is to see is no joint.
  const bones = joints.size > 0 ? [...joints] : nodes.filter((node) => carries(node) < meshes);
  return bones.sort((a, b) => depthOf(a) - depthOf(b));
}

// part -> { bone, name }, the name being the file's own.
export function findBones(gltf) {
  const { parser, userData: { vrm } } = gltf, found = new Map();
  const nameOf = (bone) => parser.json.nodes[parser.associations.get(bone)?.nodes]?.name ?? bone.name;
  const take = (bone, role) => {
    if (!parser.associations.has(bone) || !role || [...found.values()].some((f) => f.bone === bone)) return;
    const part = partName(role);
    if (!found.has(part)) found.set(part, { bone, name: nameOf(bone) });
  };
  for (const name of Object.keys(vrm?.humanoid?.humanBones ?? {})) take(vrm.humanoid.getRawBoneNode(name), matchHumanoid(name));
  for (const bone of candidates(gltf)) take(bone, matchBone(nameOf(bone)));
  return found;
}

// A bone that is turned and pushed along the character's axes, whatever its own are: it keeps what it rests at. It turns around
// `pivot`, where it is unless it is a lid, which turns around the eye.
export class LoadedBone {
  #bone;
  #rest = new Matrix4(); // in the character's space
  #parent = new Matrix4(); // from the character's space into its parent's
  #pivot;
  #turn = { pitch: 0, yaw: 0, roll: 0 };
  #push = new Vector3();

  // `inCharacter`: from the world into the character's space. The character rests, its matrices are up to date.
  constructor(bone, inCharacter, pivot = null) {
    this.#bone = bone;
    this.#rest.multiplyMatrices(inCharacter, bone.matrixWorld);
    this.#parent.multiplyMatrices(inCharacter, bone.parent.matrixWorld).invert();
    this.#pivot = pivot ?? new Vector3().setFromMatrixPosition(this.#rest);
  }

  get place() { return new Vector3().setFromMatrixPosition(this.#rest); }

  // 'pitch', 'yaw', 'roll' in degrees or 'position_x' ... in cm, from rest.
  set(kind, value) {
    if (kind.startsWith('position_')) this.#push[kind.at(-1)] = value;
    else this.#turn[kind] = MathUtils.degToRad(value);
    const { pitch, yaw, roll } = this.#turn;
    const matrix = new Matrix4().makeRotationFromEuler(new Euler(pitch, yaw, roll, 'YXZ'));
    const at = this.#pivot.clone().sub(this.#pivot.clone().applyMatrix4(matrix)).add(this.#push);
    matrix.setPosition(at).multiply(this.#rest).premultiply(this.#parent);
    matrix.decompose(this.#bone.position, this.#bone.quaternion, this.#bone.scale);
  }

  neutral() {
    this.#push.set(0, 0, 0);
    this.#turn = { pitch: 0, yaw: 0, roll: 0 };
    this.set('pitch', 0);
  }
}
