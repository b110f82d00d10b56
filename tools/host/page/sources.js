import { Decoder } from '../decoder/decoder.js';

// Where bytes come from. A source has
//   open(to)   to.bytes(Uint8Array) for what arrives, to.again() when the same sender starts over, to.closed() when it
//              ends; throws (or rejects) when it cannot be opened
//   send(bytes), close(), name, and retry: whether it is worth opening again by itself

// A stream that was recorded, played at its own pace, again and again.
export class Recording {
  name = 'recording';
  retry = false;
  paused = false;
  #pieces = []; // [{ at: ms, bytes }], each up to the end of a pose
  #next = 0;
  #started = 0;
  #to = null;
  #timer = null;

  constructor(bytes, clock = () => performance.now()) {
    this.clock = clock;
    const decoder = new Decoder();
    let from = 0, first = null;
    for (let i = 0; i < bytes.length; ++i) {
      const [message] = decoder.push(bytes.subarray(i, i + 1));
      if (message?.type !== 'pose') continue;
      first ??= message.captured_us;
      this.#pieces.push({ at: Number(message.captured_us - first) / 1000, bytes: bytes.subarray(from, i + 1) });
      from = i + 1;
    }
  }

  open(to) {
    this.#to = to;
    this.#next = 0;
    this.#started = this.clock();
    this.#timer = setInterval(() => this.step(), 8);
  }
  // Hands on what is due.
  step() {
    const now = this.clock();
    const due = () => this.#started + this.#pieces[this.#next].at;
    // A page in the background, or a pause, does not make up for the time that it missed.
    if (this.paused || now - due() > 500) this.#started += now - due();
    while (!this.paused && due() <= now) {
      this.#to.bytes(this.#pieces[this.#next++].bytes);
      if (this.#next < this.#pieces.length) continue;
      this.#next = 0;
      this.#started = now + 400;
      this.#to.again();
    }
  }
  send() {}
  close() { clearInterval(this.#timer); }
}

// `facewire serve`, or anything else that passes a line's bytes on.
export class Socket {
  retry = true;
  #socket = null;

  constructor(url) {
    this.url = url;
    this.name = url;
  }
  open(to) {
    return new Promise((resolve, reject) => {
      const socket = new WebSocket(this.url);
      socket.binaryType = 'arraybuffer';
      let opened = false;
      socket.onopen = () => { opened = true; resolve(); };
      socket.onmessage = ({ data }) => { if (data instanceof ArrayBuffer) to.bytes(new Uint8Array(data)); };
      socket.onclose = () => (opened ? to.closed() : reject(new Error(`nobody answers at ${this.url}`)));
      this.#socket = socket;
    });
  }
  send(bytes) { if (this.#socket?.readyState === WebSocket.OPEN) this.#socket.send(bytes); }
  close() {
    if (!this.#socket) return;
    this.#socket.onclose = null;
    this.#socket.close();
  }
}

// A serial port of this computer (Web Serial): the board's USB gadget, or an adapter on its line.
export class Serial {
  name = 'serial port';
  retry = true;
  #port;
  #reader = null;
  #writer = null;

  constructor(port, baudRate = 115200) {
    this.#port = port;
    this.baudRate = baudRate;
  }
  async open(to) {
    await this.#port.open({ baudRate: this.baudRate });
    this.#writer = this.#port.writable.getWriter();
    this.#reader = this.#port.readable.getReader();
    this.#read(to);
  }
  async #read(to) {
    const reader = this.#reader;
    try {
      for (;;) {
        const { value, done } = await reader.read();
        if (done) break;
        to.bytes(value);
      }
    } catch {
      // The cable was pulled; said below.
    }
    await this.#release();
    to.closed();
  }
  send(bytes) { this.#writer?.write(bytes).catch(() => {}); }
  async close() { await this.#reader?.cancel().catch(() => {}); }
  async #release() {
    this.#reader?.releaseLock();
    this.#writer?.releaseLock();
    this.#reader = this.#writer = null;
    await this.#port.close().catch(() => {});
  }
}
