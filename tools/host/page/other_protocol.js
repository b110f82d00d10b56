export const SPEAKS_OSC = 'this line speaks OSC; for this page set [host] protocol = "native" in the device\'s facewire.toml';

const BUNDLE = [0xc0, ...new TextEncoder().encode('#bundle\0')];
const ENOUGH = 3; // one may be anything, even text

// Notices that a line speaks OSC instead of the native protocol.
export class OscSpotter {
  #matched = 0;
  #bundles = 0;

  // True from the bytes on with which beginnings of OSC bundles were seen often enough.
  notices(bytes) {
    for (const byte of bytes) {
      this.#matched = byte === BUNDLE[this.#matched] ? this.#matched + 1 : Number(byte === BUNDLE[0]);
      if (this.#matched < BUNDLE.length) continue;
      this.#matched = 0;
      ++this.#bundles;
    }
    return this.#bundles >= ENOUGH;
  }
}
