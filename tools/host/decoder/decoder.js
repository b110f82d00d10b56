import { crc32 } from './crc32.js';
import { MAX_INSIDE, VERSION, readPayload } from './message.js';

const HEADER_BYTES = 4, CRC_BYTES = 4;
const NUMBERS = 0xffff; // sequence numbers: 1..65535, then 1 again; 0 is a start

// Counts of what came, as LinkStats of core/wire/decoder.h explains them.
const noStats = () => ({
  frames: 0, unknown: 0, versions: 0, malformed: 0, crc_errors: 0, cobs_errors: 0, truncated: 0, overflows: 0,
  lost: 0, restarts: 0, resyncs: 0,
});

// Finds the messages in a stream of bytes, however it is cut into pieces. Whatever arrives, the first sound frame after
// it is delivered. Needs the same memory whatever comes.
//
//   const decoder = new Decoder();
//   for (const message of decoder.push(bytes)) use(message);   // { sequence, type: 'pose', ... }
export class Decoder {
  #inside = new Uint8Array(MAX_INSIDE); // what COBS decoding has made of the piece so far
  #size = 0;
  #leftInBlock = 0;
  #zeroPending = false; // the COBS block stands for a zero if another block follows
  #started = false; // bytes came since the last delimiter
  #overflowed = false;
  #joined = false; // a delimiter was seen: what follows is a frame from its beginning
  #damaged = false; // since the last sound frame
  #lastSequence = null;

  stats = noStats();

  get damaged() {
    const s = this.stats;
    return s.crc_errors + s.cobs_errors + s.truncated + s.overflows;
  }

  // The messages that end in these bytes (a Uint8Array), in order.
  push(bytes) {
    const messages = [];
    for (const byte of bytes) {
      if (byte !== 0) {
        this.#take(byte);
        continue;
      }
      const message = this.#started ? this.#finish() : null;
      if (message) messages.push(message);
      this.#joined = true;
      this.#size = this.#leftInBlock = 0;
      this.#zeroPending = this.#started = this.#overflowed = false;
    }
    return messages;
  }

  #take(byte) {
    this.#started = true;
    if (this.#leftInBlock > 0) {
      --this.#leftInBlock;
      this.#append(byte);
      return;
    }
    if (this.#zeroPending) this.#append(0);
    this.#leftInBlock = byte - 1;
    this.#zeroPending = byte !== 0xff;
  }

  #append(byte) {
    if (this.#size === MAX_INSIDE) this.#overflowed = true;
    else this.#inside[this.#size++] = byte;
  }

  #finish() {
    const inside = this.#inside.subarray(0, this.#size);
    const damage = this.#damageOf(inside);
    if (damage) {
      // The tail of a frame whose beginning nobody saw is no damage.
      if (this.#joined) {
        ++this.stats[damage];
        this.#damaged = true;
      }
      return null;
    }
    if (this.#damaged) ++this.stats.resyncs;
    this.#damaged = false;
    return this.#read(inside);
  }

  #damageOf(inside) {
    if (this.#overflowed) return 'overflows';
    if (this.#leftInBlock > 0) return 'cobs_errors';
    if (inside.length < HEADER_BYTES + CRC_BYTES) return 'truncated';
    const end = inside.length - CRC_BYTES;
    const sent = new DataView(inside.buffer).getUint32(end, true);
    return crc32(inside.subarray(0, end)) === sent ? null : 'crc_errors';
  }

  #read(inside) {
    const header = new DataView(inside.buffer);
    if (header.getUint8(0) !== VERSION) {
      ++this.stats.versions;
      return null;
    }
    const sequence = header.getUint16(2, true);
    this.#countSequence(sequence);
    const message = readPayload(header.getUint8(1), inside.subarray(HEADER_BYTES, inside.length - CRC_BYTES));
    if (typeof message === 'string') {
      ++this.stats[message];
      return null;
    }
    ++this.stats.frames;
    return { sequence, ...message };
  }

  #countSequence(sequence) {
    const last = this.#lastSequence;
    this.#lastSequence = sequence;
    if (last === null) return;
    const expected = last === NUMBERS ? 1 : last + 1;
    const gap = (sequence - expected + NUMBERS) % NUMBERS;
    // A number from behind is a sender that started again and whose first frame got lost.
    if (sequence === 0 || gap > NUMBERS >> 1) ++this.stats.restarts;
    else this.stats.lost += gap;
  }
}
