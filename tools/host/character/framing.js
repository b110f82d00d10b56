import { Box3, Vector3 } from 'three';

import { EYE } from './surface.js';

// Where a character's face is and how large, and so how it is laid over Otto's: its eyes onto his, in centimetres, looking
// along z. Whatever it is, as much of the stage is face.

const OTTO = {
  eyes: new Vector3(0, EYE[1], EYE[2]), between: 2 * EYE[0], // cm, of the eyes' centres
  face: new Vector3(0, -2.4, 4), height: 15, // from the brows to the chin
  head: new Vector3(0, -0.5, 0), whole: 25, // from the chin to the crown, and a bit of neck
};
const CROWN_ABOVE_NECK = 26; // cm from the head's joint: more than that, hair and all, does not fit the stage
const SAMPLES = 3000; // vertices of a mesh that are looked at

const sided = (name) => (/_L$|Left$/.test(name) ? 1 : /_R$|Right$/.test(name) ? -1 : 0);

function* vertices(mesh) {
  const { count } = mesh.geometry.attributes.position, step = Math.max(1, Math.ceil(count / SAMPLES)), p = new Vector3();
  for (let i = 0; i < count; i += step) yield mesh.getVertexPosition(i, p).applyMatrix4(mesh.matrixWorld);
}

function boxOf(scene) {
  const box = new Box3();
  scene.traverse((object) => {
    if (object.isMesh) for (const p of vertices(object)) box.expandByPoint(p);
  });
  return box;
}

// Where a morph target moves what it moves: the middle of its vertices by how far they go, and their box.
function placeOf(targets) {
  const middle = new Vector3(), box = new Box3(), p = new Vector3(), d = new Vector3();
  let weight = 0;
  for (const [mesh, index] of targets) {
    const offsets = mesh.geometry.morphAttributes.position[index];
    const by = Array.from({ length: offsets.count }, (_, i) => d.fromBufferAttribute(offsets, i).length());
    const most = by.reduce((a, b) => Math.max(a, b), 0);
    by.forEach((length, i) => {
      if (length < 0.2 * most) return;
      mesh.getVertexPosition(i, p).applyMatrix4(mesh.matrixWorld);
      box.expandByPoint(p);
      middle.addScaledVector(p, length);
      weight += length;
    });
  }
  return weight > 0 ? { middle: middle.divideScalar(weight), box } : null;
}

// { scale, turned, from, to }: what is at `from` in the file comes to `to`, `scale` times as large; `turned`: half round, because
// it looks along -z. `bones`: part -> { bone }; `shapes`: ARKit's name -> [[mesh, index], ...]. Null: there is nothing to see.
export function frame(scene, bones, shapes, isVrm0) {
  scene.updateMatrixWorld(true);
  const box = boxOf(scene);
  if (box.isEmpty() || ![...box.min, ...box.max].every(Number.isFinite) || box.min.distanceTo(box.max) === 0) return null;
  const place = new Map([...bones].map(([part, { bone }]) => [part, new Vector3().setFromMatrixPosition(bone.matrixWorld)]));
  const moved = new Map([...shapes].map(([name, targets]) => [name, placeOf(targets)]).filter(([, at]) => at));
  const left = place.get('eye_L') ?? moved.get('eyeBlinkLeft')?.middle, right = place.get('eye_R') ?? moved.get('eyeBlinkRight')?.middle;

  // The left is where x is greater, unless the character looks along -z.
  let sides = 0;
  for (const [name, p] of place) sides += sided(name) * p.x;
  if (sides === 0) for (const [name, { middle }] of moved) if (!/^(jaw|mouth)(Left|Right)$/.test(name)) sides += sided(name) * middle.x;
  const turned = sides === 0 ? isVrm0 : sides < 0;

  const neck = place.get('head');
  const largest = neck && neck.y < box.max.y ? CROWN_ABOVE_NECK / (box.max.y - neck.y) : Infinity;
  const between = left && right ? left.distanceTo(right) : 0;
  if (between > 0) return { scale: Math.min(OTTO.between / between, largest), turned, from: left.clone().lerp(right, 0.5), to: OTTO.eyes };
  const face = [...moved.values()].reduce((all, at) => all.union(at.box), new Box3());
  const tall = face.max.y - face.min.y;
  if (tall > 0) return { scale: Math.min(OTTO.height / tall, largest), turned, from: face.getCenter(new Vector3()), to: OTTO.face };
  const size = box.getSize(new Vector3());
  if (largest < Infinity) {
    const from = new Vector3(neck.x, 0.5 * (neck.y + box.max.y), neck.z);
    return { scale: largest, turned, from, to: OTTO.head };
  }
  // A head stands as high as it is wide; a body is eight heads high.
  const wide = Math.max(size.x, size.z), head = size.y > 3 * wide || size.y > 5 * Math.min(size.x, size.z) ? size.y / 7.5 : size.y;
  const middle = box.getCenter(new Vector3()).setY(box.max.y - head / 2);
  return { scale: OTTO.whole / (head || wide), turned, from: middle, to: OTTO.head };
}
