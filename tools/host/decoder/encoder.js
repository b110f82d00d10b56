import { crc32 } from './crc32.js';
import { COMMAND, VERSION, takesItem, takesValue } from './message.js';

// COBS: no zero is left in what it returns. Blocks end with a zero, or after 254 bytes without one.
function cobs(plain) {
  const out = [];
  let codeAt = -1; // of the open block; none after a full one
  const open = () => { codeAt = out.push(0) - 1; };
  const close = () => {
    if (codeAt >= 0) out[codeAt] = out.length - codeAt;
    codeAt = -1;
  };
  open();
  for (const byte of plain) {
    if (codeAt < 0) open();
    if (byte === 0) {
      close();
      open();
    } else if (out.push(byte) - codeAt === 0xff) {
      close();
    }
  }
  close();
  return out;
}

// One frame for a line, both delimiters included. `payload`: bytes.
export function frame(type, sequence, payload) {
  const inside = new Uint8Array(4 + payload.length + 4);
  const view = new DataView(inside.buffer);
  view.setUint8(0, VERSION);
  view.setUint8(1, type);
  view.setUint16(2, sequence, true);
  inside.set(payload, 4);
  view.setUint32(inside.length - 4, crc32(inside.subarray(0, inside.length - 4)), true);
  return Uint8Array.from([0, ...cobs(inside), 0]);
}
export const nextSequence = (sequence) => (sequence === 0xffff ? 1 : sequence + 1); // 0 says: started anew

// The frames that a host sends: commands, numbered in order.
export class Encoder {
  #sequence = 0;

  // The bytes for the line. `id` is any u16, repeated by the acknowledgement; `code` one of COMMANDS; `value` and
  // `item` are for codes that take one. Throws RangeError for what no command can hold.
  command(id, code, value = 0, item = 0) {
    if (!Number.isInteger(id) || id < 0 || id > 0xffff) throw new RangeError(`a command's id is 0 to 65535, not ${id}`);
    if (!Number.isInteger(code) || code < 0 || code > 0xff) throw new RangeError(`a command's code is 0 to 255, not ${code}`);
    const payload = new Uint8Array(takesItem(code) ? 8 : takesValue(code) ? 7 : 3);
    const view = new DataView(payload.buffer);
    view.setUint16(0, id, true);
    view.setUint8(2, code);
    if (takesValue(code)) {
      if (!Number.isFinite(Math.fround(value))) throw new RangeError(`a command's value is a number, not ${value}`);
      view.setFloat32(3, value, true);
    }
    if (takesItem(code)) {
      if (!Number.isInteger(item) || item < 0 || item > 0xff) throw new RangeError(`a command's item is 0 to 255, not ${item}`);
      view.setUint8(7, item);
    }
    const bytes = frame(COMMAND, this.#sequence, payload);
    this.#sequence = nextSequence(this.#sequence);
    return bytes;
  }
}
