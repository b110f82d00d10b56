import { Decoder } from '../../../../tools/host/decoder/decoder.js';
import { frame, nextSequence } from '../../../../tools/host/decoder/encoder.js';
import { COMMANDS, KINDS, STATES } from '../../../../tools/host/decoder/message.js';

// A board at the other end of Web Serial: bundled, and put into the browser before the page's own script. It stands in for
// navigator.serial with the real one's shape; what it says are the native protocol's frames. In the tests' hands as
// `board`: what it shows, what it plays, and its cable.

const PICTURE_MS = 40;
const little = (size, set) => (value) => {
  const bytes = new Uint8Array(size);
  new DataView(bytes.buffer)[set](0, value, true);
  return [...bytes];
};
const u16 = little(2, 'setUint16'), u32 = little(4, 'setUint32'), i64 = little(8, 'setBigInt64'), f32 = little(4, 'setFloat32');
const nameOf = (text) => [text.length, ...new TextEncoder().encode(text)];
const RIG_ID = 7;

class Board {
  commands = []; // those that came, but pings and what is asked for
  results = {}; // by a command's name: what it is answered with, if not 0
  plugged = true;
  refused = null; // a DOMException that opening ends with
  chosen = true; // whether the user picks it when the browser asks
  openings = 0;
  attempts = 0; // to open it
  #rig = { name: 'stand_in', bones: [], channels: [] };
  #steps = [];
  #state = 'tracking';
  #line = null; // the stream's controller while the port is open
  #decoder = new Decoder();
  #sequence = 0;
  #pictures = 0;
  #talks = false; // until it has a rig

  constructor() { setInterval(() => this.#tick(), PICTURE_MS); }

  // Another rig: bones [{ name }], channels [{ name, kind, bone, neutral, min, max }]. It stands at neutral.
  setRig(rig) {
    this.#rig = rig;
    this.set({});
  }
  // A pose that it sends until the next: values by channel names, the others neutral.
  set(values, state = 'tracking') {
    this.#state = state;
    this.#talks = true;
    this.#steps = this.#rig.channels.map(({ name, neutral, min, max }) =>
      Math.round((65535 * ((values[name] ?? neutral) - min)) / (max - min)));
  }
  // Sends nothing of its own any more.
  hush() { this.#talks = false; }
  // Bytes as they are, in pieces as a port hands them on.
  play(bytes) {
    this.hush();
    for (let i = 0; i < bytes.length; i += 512) this.#line?.enqueue(Uint8Array.from(bytes.slice(i, i + 512)));
  }
  // The cable is pulled in the middle of a frame.
  pull() {
    this.plugged = false;
    this.#line?.enqueue(frame(0x10, this.#sequence, this.#pose()).slice(0, 20));
    this.#line?.error(new DOMException('The device has been lost.', 'NetworkError'));
    this.#line = null;
  }

  async open({ baudRate }) {
    ++this.attempts;
    if (!(baudRate > 0)) throw new TypeError('baudRate is required');
    if (this.#line) throw new DOMException('The port is already open.', 'InvalidStateError');
    if (!this.plugged) throw new DOMException('Failed to open serial port.', 'NetworkError');
    if (this.refused) throw this.refused;
    ++this.openings;
    this.#decoder = new Decoder();
    this.#sequence = 0;
    this.readable = new ReadableStream({ start: (line) => { this.#line = line; }, cancel: () => { this.#line = null; } });
    this.writable = new WritableStream({ write: (bytes) => this.#take(bytes) });
  }
  async close() {
    if (this.readable?.locked || this.writable?.locked) throw new TypeError('a stream is locked');
    this.#line = null;
  }

  #send(type, payload) {
    this.#line?.enqueue(frame(type, this.#sequence, Uint8Array.from(payload)));
    this.#sequence = nextSequence(this.#sequence);
  }
  #now() { return BigInt(Math.round(1000 * performance.now())); }
  #pose() {
    return [...u32(RIG_ID), ...u32(this.#pictures), ...i64(this.#now()), ...u32(0), STATES.indexOf(this.#state),
      this.#steps.length, ...this.#steps.flatMap(u16)];
  }
  #tick() {
    if (!this.#line || !this.#talks) return;
    ++this.#pictures;
    this.#send(0x10, this.#pose());
  }
  #describe() {
    const { name, bones, channels } = this.#rig;
    this.#send(0x01, [...u32(RIG_ID), bones.length, channels.length, ...nameOf(name)]);
    bones.forEach((bone, i) => this.#send(0x02, [...u32(RIG_ID), i, ...f32(0), ...f32(0), ...f32(0), ...nameOf(bone.name)]));
    channels.forEach((c, i) => this.#send(0x03, [...u32(RIG_ID), i, KINDS.indexOf(c.kind), c.bone ?? 255, ...f32(c.neutral),
      ...f32(c.min), ...f32(c.max), ...nameOf(c.name)]));
  }
  #take(bytes) {
    for (const { type, id, code } of this.#decoder.push(bytes)) {
      if (type !== 'command' || !this.#talks) continue;
      const name = Object.keys(COMMANDS).find((n) => COMMANDS[n] === code);
      if (name === 'describe_rig') this.#describe();
      else if (!['ping', 'landmarks'].includes(name)) this.commands.push(name);
      this.#send(0x12, [...u16(id), code, this.results[name] ?? 0, ...i64(this.#now())]);
    }
  }
}

const board = new Board();
Object.defineProperty(navigator, 'serial', {
  value: {
    async requestPort() {
      if (!board.chosen) throw new DOMException('No port selected by the user.', 'NotFoundError');
      return board;
    },
    async getPorts() { return []; },
  },
});
window.board = board;
