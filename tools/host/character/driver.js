import { MOTIONS } from './motions.js';
import { MATCHES, matchBone, matchShape, partName } from './names.js';

// A rig and a character may tell the same motion as a bone, as a blend shape, or both. What the rig tells as a bone and the
// character has as one moves so, and its shape rests; what only one of them has as a bone is translated. (Otto's jaw, lids
// and eyes are hard, and move by their bones; a character whose shapes do it keeps the bones to itself.)

// Head and neck share what only one of them is told.
const SHARES = [['head', 0.6], ['neck', 0.4]];
const isLip = (part) => /^(lip_corner_[LR]|upper_lip|lower_lip)$/.test(part);
const within01 = (x) => Math.min(1, Math.max(0, x));

// Moves a character by the values of a rig (decoder/rig.js). `unused` names the channels that this character has nothing
// for; those left to their other half are not among them. `moved` has the names of the shapes and bones that it moves.
export class Driver {
  unused = [];
  moved = new Set();
  #character;
  #shapes;
  #channels; // one a channel: [[key of #sums, value => part], ...]
  #sums = new Map(); // key -> { set, value }

  constructor(character, rig) {
    this.#character = character;
    this.#shapes = new Set(character.shapeNames);
    const parts = rig.bones.map(({ name }) => this.#partNamed(name));
    const parameters = this.#parameters(rig);
    const told = new Set([...parameters.values()].flat().map(([signal]) => signal)); // as shapes
    const direct = new Set(rig.channels.filter((c) => c.kind !== 'parameter' && this.#has(parts[c.bone], c.kind))
      .map((c) => `${parts[c.bone]}|${c.kind}`));
    const speaks = [...told].some((signal) => signal.startsWith('mouth'));
    const turners = SHARES.filter(([part]) => parts.includes(part)).length;
    this.#channels = rig.channels.map((channel, i) => {
      const { kind } = channel, part = parts[channel.bone];
      if (kind === 'parameter') return parameters.get(i)?.flatMap(([signal, gain]) => this.#shape(signal, gain, direct)) ?? this.#lacks(channel);
      if (SHARES.some(([name]) => name === part)) return this.#turn(part, kind, turners) ?? this.#lacks(channel);
      if (isLip(part) && speaks) {
        this.moved.add(`${part}.${kind.at(-1)}`);
        return [];
      }
      if (direct.has(`${part}|${kind}`)) return [this.#bone(part, kind, 1)];
      const motions = MOTIONS.filter((m) => m.part === part && this.#shapes.has(m.shape));
      if (motions.some((m) => told.has(m.shape))) return [];
      const same = motions.filter((m) => m.kind === kind);
      return same.length > 0 ? same.map((m) => this.#sink(m.shape, (v) => within01(v / m.amount))) : this.#lacks(channel);
    });
  }

  // values: one a channel, in its unit.
  apply(values) {
    for (const sum of this.#sums.values()) sum.value = 0;
    this.#channels.forEach((sinks, i) => { for (const [key, part] of sinks) this.#sums.get(key).value += part(values[i]); });
    for (const { set, value } of this.#sums.values()) set(value);
  }

  #lacks({ name }) {
    this.unused.push(name);
    return [];
  }
  #partNamed(name) {
    const alias = this.#character.aliases?.get(name);
    if (alias || this.#character.bones.has(name)) return alias ?? name;
    const role = matchBone(name);
    return role ? partName(role) : name;
  }
  // A bone, or what pushes as one: a shape "upper_lip.y".
  #has(part, kind) { return this.#character.bones.has(part) || this.#shapes.has(`${part}.${kind.at(-1)}`); }

  // channel -> [[shape, gain], ...] of the parameters that move something. A shape is told once, by the surest name.
  #parameters(rig) {
    const shows = (shape) => this.#shapes.has(shape) || MOTIONS.some((m) => m.shape === shape && this.#has(m.part, m.kind));
    const matches = rig.channels.flatMap(({ name, kind }, i) => {
      if (kind !== 'parameter') return [];
      const match = shows(name) ? { match: 'exact', signals: [{ signal: name, half: null }] } : matchShape(name);
      return match ? [{ i, ...match }] : [];
    }).sort((a, b) => MATCHES.indexOf(a.match) - MATCHES.indexOf(b.match));
    const found = new Map(), taken = new Set();
    for (const { i, signals } of matches) {
      const free = signals.filter(({ signal }) => shows(signal) && !taken.has(signal));
      for (const { signal, half } of free) if (!half) taken.add(signal);
      if (free.length > 0) found.set(i, free.map(({ signal, half }) => [signal, half ? 0.5 : 1]));
    }
    return found;
  }

  #shape(signal, gain, direct) {
    const motions = MOTIONS.filter((m) => m.shape === signal);
    this.moved.add(signal);
    if (motions.some((m) => direct.has(`${m.part}|${m.kind}`))) return [];
    if (this.#shapes.has(signal)) return [this.#sink(signal, (v) => gain * v)];
    return motions.filter((m) => this.#has(m.part, m.kind)).map((m) => this.#bone(m.part, m.kind, gain * m.amount));
  }

  #turn(part, kind, turners) {
    const there = SHARES.filter(([name]) => this.#character.bones.has(name));
    if (there.length === 0) return null;
    if (there.length === 1) return [this.#bone(there[0][0], kind, 1)];
    if (turners === 2) return [this.#bone(part, kind, 1)];
    return there.map(([name, share]) => this.#bone(name, kind, share));
  }

  #bone(part, kind, gain) {
    const key = `${part}|${kind}`;
    if (!this.#sums.has(key)) this.#sums.set(key, { set: (v) => this.#character.setBone(part, kind, v), value: 0 });
    this.moved.add(part);
    if (!this.#character.bones.has(part)) this.moved.add(`${part}.${kind.at(-1)}`);
    return [key, (v) => gain * v];
  }
  #sink(shape, part) {
    if (!this.#sums.has(shape)) this.#sums.set(shape, { set: (v) => this.#character.setShape(shape, v), value: 0 });
    this.moved.add(shape);
    return [shape, part];
  }
}
