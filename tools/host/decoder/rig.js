// The description of the device's rig, put together from messages in any order, with repeats and others between them.
//
//   collector.add(message)                  // every message that arrives
//   if (collector.complete) collector.rig   // { rig_id, name, bones: [{ name, rest_cm }], channels: [{ name, kind, ... }] }
export class RigCollector {
  #id = null;
  #header = null;
  #bones = new Map();
  #channels = new Map();

  // Whether the message was part of a description. One with another rig_id than those before starts again.
  add(message) {
    if (!['rig_header', 'bone', 'channel'].includes(message.type)) return false;
    if (message.rig_id !== this.#id) {
      this.#id = message.rig_id;
      this.#header = null;
      this.#bones.clear();
      this.#channels.clear();
    }
    if (message.type === 'rig_header') this.#header = message;
    else (message.type === 'bone' ? this.#bones : this.#channels).set(message.index, message);
    return true;
  }

  get rigId() { return this.#id; }

  // Parts still to come; at least 1 until the header is there.
  get missing() {
    if (!this.#header) return 1;
    const lacking = (parts, count) => {
      let n = 0;
      for (let i = 0; i < count; ++i) n += parts.has(i) ? 0 : 1;
      return n;
    };
    return lacking(this.#bones, this.#header.bones) + lacking(this.#channels, this.#header.channels);
  }
  get complete() { return this.missing === 0; }

  get rig() {
    if (!this.complete) return null;
    const inOrder = (parts, count) => Array.from({ length: count }, (_, i) => parts.get(i));
    return {
      rig_id: this.#id,
      name: this.#header.name,
      bones: inOrder(this.#bones, this.#header.bones),
      channels: inOrder(this.#channels, this.#header.channels),
    };
  }
}

// The values of a pose in the units of the rig's channels; null when the pose is of another rig.
export function valuesOf(pose, rig) {
  if (pose.rig_id !== rig.rig_id || pose.steps.length !== rig.channels.length) return null;
  return Float32Array.from(pose.steps, (q, i) => {
    const { min, max } = rig.channels[i];
    return min + (q / 65535) * (max - min);
  });
}
