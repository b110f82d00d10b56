import { ARKIT } from './shapes.js';

// A rig may tell the same motion twice: as bones and as blend shapes. Hard parts move by their bones, soft ones by their
// shapes, and by the other only where a rig lacks the one.
const SIDES = ['L', 'R'];
const arkit = (name, side) => name + (side === 'L' ? 'Left' : 'Right');
const TAKEN_BY_BONES = new Map([
  ...['jawOpen', 'jawForward', 'jawLeft', 'jawRight'].map((shape) => [shape, 'jaw']),
  ...SIDES.flatMap((s) => [
    ...['eyeBlink', 'eyeWide'].map((shape) => [arkit(shape, s), `upper_lid_${s}`]),
    [arkit('eyeSquint', s), `lower_lid_${s}`],
    ...['eyeLookUp', 'eyeLookDown', 'eyeLookIn', 'eyeLookOut'].map((shape) => [arkit(shape, s), `eye_${s}`]),
    [arkit('browDown', s), `brow_inner_${s}`],
    [arkit('browOuterUp', s), `brow_outer_${s}`],
  ]),
  ['browInnerUp', 'brow_inner_L'],
]);
const isLip = (bone) => /^(lip_corner_[LR]|upper_lip|lower_lip)$/.test(bone);

// Moves a character by the values of a rig (decoder/rig.js). `unused` names the channels that this character has nothing
// for; those left to their other half are not among them.
export class Driver {
  unused = [];
  #moves = []; // one a channel: value => ..., or null

  constructor(character, rig) {
    this.character = character;
    this.channels = rig.channels;
    const boneOf = (channel) => rig.bones[channel.bone]?.name;
    const moved = new Set(rig.channels.filter((c) => c.kind !== 'parameter').map(boneOf));
    const speaks = rig.channels.some((c) => c.kind === 'parameter' && c.name.startsWith('mouth') && ARKIT.includes(c.name));
    const shapes = new Set(character.shapeNames);
    this.#moves = rig.channels.map((channel) => {
      if (channel.kind === 'parameter') {
        if (moved.has(TAKEN_BY_BONES.get(channel.name))) return null;
        if (shapes.has(channel.name)) return (value) => character.setShape(channel.name, value);
      } else {
        const bone = boneOf(channel);
        if (isLip(bone) && speaks) return null;
        if (character.bones.has(bone) || shapes.has(`${bone}.${channel.kind.at(-1)}`)) {
          return (value) => character.setBone(bone, channel.kind, value);
        }
      }
      this.unused.push(channel.name);
      return null;
    });
  }

  // values: one a channel, in its unit.
  apply(values) {
    this.#moves.forEach((move, i) => move?.(values[i]));
  }
}
