import { Bone, Group, Matrix4 } from 'three';
import { VRMUtils } from '@pixiv/three-vrm';

import { frame } from './framing.js';
import { LoadedBone, findBones, shownBy } from './loaded_bones.js';
import { LoadedShapes } from './loaded_shapes.js';
import { ARKIT, rigName } from './names.js';
import { smooth } from './normals.js';
import { NECK } from './surface.js';

const LONGEST = 31, LONGEST_BONE = 25; // characters of a rig's names
const TOON = 0.5; // of a toon material's own brightness

// Somebody else's character, behind the interface of Character: ARKit's shapes and Otto's bones by name, whatever the file calls
// them, and what it calls them too. In centimetres, looking along z, with its eyes where Otto's are. Nothing is seen of
// setShape until update().
export class LoadedCharacter {
  root = new Group();
  bones = new Map(); // part -> Bone
  aliases = new Map(); // the file's own name of a bone -> part
  leftToShapes = []; // bones that a shape of the same part moves already, by the file's own names
  meshes = [];
  #vrm;
  #parts = new Map(); // part -> LoadedBone
  #shapes;

  // gltf: as loadCharacter() has it; throws an Error where there is nothing to see.
  constructor(gltf, name) {
    this.name = name;
    this.root.name = name;
    this.#vrm = gltf.userData.vrm ?? null;
    const found = findBones(gltf);
    const gazeByBones = this.#vrm?.lookAt?.applier?.constructor.type === 'bone';
    this.#shapes = new LoadedShapes(gltf, gazeByBones);
    const shown = new Map([...this.#shapes.names].map(([signal, names]) => [signal, names.flatMap((n) => this.#shapes.targets.get(n) ?? [])]));
    this.#place(gltf.scene, frame(gltf.scene, found, shown, this.#vrm?.meta?.metaVersion === '0'));
    this.#takeBones(found, gazeByBones);
    this.neutral();
  }

  get shapeNames() { return this.#shapes.settable; }
  // Which of ARKit's shapes it shows, and what it calls them; what it has that nothing of ARKit's moves.
  get matched() { return this.#shapes.names; }
  get lacking() { return ARKIT.filter((name) => !this.#shapes.names.has(name)); }
  get ownShapes() { return this.#shapes.own; }
  // Its own shapes that nothing moves, where a driver has `moved`.
  unmovedBy(moved) {
    const held = new Set([...this.#shapes.names].filter(([signal]) => moved.has(signal)).flatMap(([, names]) => names));
    return this.ownShapes.filter((name) => !held.has(name) && !moved.has(rigName(name, LONGEST)));
  }
  get still() { return this.#shapes.still; }

  setShape(name, weight) { this.#shapes.set(name, weight); }
  setBone(part, kind, value) { this.#parts.get(part)?.set(kind, value); }

  neutral() {
    for (const name of this.shapeNames) this.setShape(name, 0);
    for (const part of this.#parts.values()) part.neutral();
    this.update(0);
    this.#vrm?.springBoneManager?.reset();
  }

  // What moves by itself goes on by `seconds`; whether there is such.
  update(seconds) {
    this.#shapes.apply();
    const vrm = this.#vrm;
    if (!vrm) return false;
    vrm.nodeConstraintManager?.update();
    if (seconds > 0) vrm.springBoneManager?.update(seconds);
    for (const material of vrm.materials ?? []) material.update?.(seconds);
    return (vrm.springBoneManager?.joints.size ?? 0) > 0;
  }

  // Gives back what the graphics card holds of it.
  dispose() { VRMUtils.deepDispose(this.root); }

  #place(scene, framed) {
    if (!framed) throw new Error('has nothing to see: a mesh with vertices belongs in it');
    const { scale, turned, from, to } = framed, inner = new Group(), neck = new Bone();
    inner.scale.setScalar(scale);
    inner.rotation.y = turned ? Math.PI : 0;
    inner.position.copy(from).multiplyScalar(-scale).applyEuler(inner.rotation).add(to);
    inner.add(scene);
    neck.name = 'neck';
    neck.position.set(...NECK);
    inner.position.sub(neck.position);
    neck.add(inner);
    this.root.add(neck);
    scene.traverse((object) => {
      if (!object.isMesh) return;
      object.frustumCulled = false; // bounds are those of a body at rest
      object.castShadow = object.receiveShadow = true;
      smooth(object);
      this.meshes.push(object);
    });
    this.root.updateMatrixWorld(true);
    this.#scaleVrm(scale);
  }

  // Springs and outlines count in metres, whatever the scale. Toon's light is one lamp of strength 1; the studio has four, and
  // the lit and the shaded side get some of each.
  #scaleVrm(scale) {
    const springs = this.#vrm?.springBoneManager;
    if (springs) {
      for (const { settings } of springs.joints) {
        for (const key of ['stiffness', 'gravityPower', 'hitRadius']) settings[key] *= scale;
      }
      for (const { shape } of springs.colliders) if (shape.radius) shape.radius *= scale;
      springs.setInitState();
    }
    for (const material of this.#vrm?.materials ?? []) {
      if (!material.isMToonMaterial) continue;
      if (material.outlineWidthMode === 'worldCoordinates') material.outlineWidthFactor *= scale;
      material.color.multiplyScalar(TOON);
      material.shadeColorFactor.multiplyScalar(TOON);
    }
  }

  #takeBones(found, gazeByBones) {
    const inCharacter = new Matrix4().copy(this.root.matrixWorld).invert();
    const eyes = new Map([...found].filter(([part]) => part.startsWith('eye_'))
      .map(([part, { bone }]) => [part.at(-1), new LoadedBone(bone, inCharacter).place]));
    const matched = [...this.#shapes.names.keys()];
    for (const [part, { bone, name }] of found) {
      const signal = shownBy(part);
      if (signal && !(part.startsWith('eye_') && gazeByBones) && matched.some((m) => m.startsWith(signal))) {
        this.leftToShapes.push(name);
        continue;
      }
      this.bones.set(part, bone);
      this.aliases.set(rigName(name, LONGEST_BONE), part);
      this.#parts.set(part, new LoadedBone(bone, inCharacter, part.includes('_lid_') ? eyes.get(part.at(-1)) ?? null : null));
    }
    if (this.bones.has('head') || this.bones.has('neck')) return;
    // A head without joints turns as a whole.
    const neck = this.root.children[0];
    this.bones.set('neck', neck);
    this.#parts.set('neck', new LoadedBone(neck, inCharacter));
  }
}
