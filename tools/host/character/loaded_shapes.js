import { MATCHES, matchShape, rigName } from './names.js';

// The shapes of somebody else's character: which of ARKit's move them, and how far. As `facewire rig import` has it, every
// signal goes to the surest match, and between equals to an expression, because its author chose the weights.

const isGaze = ({ signals }) => signals.some(({ signal }) => signal.startsWith('eyeLook'));
const LONGEST = 31; // characters of a rig's name
const moves = (attribute) => attribute.array.some((v) => v !== 0);

// Morph targets of a file by their own names: name -> [[mesh, index], ...]. Those that move no vertex are left out and come
// second, as a list of names.
export function targetsOf({ scene, parser }) {
  const targets = new Map(), still = new Set();
  scene.traverse((mesh) => {
    const positions = mesh.isMesh && mesh.geometry.morphAttributes.position;
    if (!positions) return;
    const at = parser.associations.get(mesh), json = parser.json.meshes[at?.meshes] ?? {};
    // Names are no part of glTF itself; most exporters put them here, older VRM ones there.
    const names = json.extras?.targetNames ?? json.primitives?.find((p) => p.extras?.targetNames)?.extras.targetNames ?? [];
    positions.forEach((attribute, i) => {
      const name = names[i] || `${json.name ?? ''}_target${i}`;
      if (!moves(attribute)) still.add(name);
      else if (targets.has(name)) targets.get(name).push([mesh, i]);
      else targets.set(name, [[mesh, i]]);
    });
  });
  return [targets, [...still].filter((name) => !targets.has(name))];
}

export class LoadedShapes {
  names = new Map(); // ARKit's name -> names of what shows it
  #vrm;
  #targets; // own name -> [[mesh, index], ...]
  #aliases; // how a rig writes it -> own name
  #direct = new Map(); // own name -> weight that somebody set by that name
  #weights = new Map(); // signal -> weight
  #movers = []; // { name, expression, parts: [[signal, gain], ...] }

  constructor(gltf, gazeByBones) {
    this.#vrm = gltf.userData.vrm ?? null;
    [this.#targets, this.still] = targetsOf(gltf);
    this.#aliases = new Map([...this.#targets.keys()].map((name) => [rigName(name, LONGEST), name]));
    const candidates = this.#candidates().filter((c) => !(c.expression && gazeByBones && isGaze(c)));
    const holders = []; // [signal, half] that are spoken for
    for (const candidate of candidates) {
      const { name, expression, signals } = candidate;
      const taken = signals.some((s) => holders.some(([signal, half]) => signal === s.signal && (half === s.half || !half || !s.half)));
      if (taken) continue;
      for (const { signal, half } of signals) holders.push([signal, half]);
      this.#movers.push({ name, expression, parts: signals.map(({ signal, gain }) => [signal, gain]) });
      for (const { signal } of signals) this.names.set(signal, [...(this.names.get(signal) ?? []), name]);
    }
  }

  // Every name that something goes by: targets, and a VRM's expressions.
  get own() {
    const expressions = this.#expressions().map((e) => e.expressionName);
    return [...new Set([...this.#targets.keys(), ...expressions])];
  }
  get targets() { return this.#targets; }
  get settable() { return [...new Set([...this.names.keys(), ...this.#aliases.keys()])]; }

  #expressions() {
    return (this.#vrm?.expressionManager?.expressions ?? []).filter((e) => e.binds.length > 0);
  }

  #candidates() {
    const named = (name, expression) => ({ name, expression, ...matchShape(name) });
    return [...this.#expressions().map((e) => named(e.expressionName, true)), ...[...this.#targets.keys()].map((n) => named(n, false))]
      .filter((c) => c.match)
      .sort((a, b) => MATCHES.indexOf(a.match) - MATCHES.indexOf(b.match)); // stable: expressions stay first
  }

  // By ARKit's name, or a target's own as a rig writes it. Nothing is seen of it until apply().
  set(name, weight) {
    if (this.names.has(name)) this.#weights.set(name, weight);
    else if (this.#aliases.has(name)) this.#direct.set(this.#aliases.get(name), weight);
  }

  apply() {
    for (const meshes of this.#targets.values()) for (const [mesh, i] of meshes) mesh.morphTargetInfluences[i] = 0;
    const added = [...this.#direct];
    for (const { name, expression, parts } of this.#movers) {
      const weight = parts.reduce((sum, [signal, gain]) => sum + gain * (this.#weights.get(signal) ?? 0), 0);
      if (expression) this.#vrm.expressionManager.setValue(name, weight);
      else added.push([name, weight]);
    }
    this.#vrm?.expressionManager?.update(); // sets the targets of expressions from nought
    for (const [name, weight] of added) for (const [mesh, i] of this.#targets.get(name)) mesh.morphTargetInfluences[i] += weight;
  }
}
