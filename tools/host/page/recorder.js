import { STATES } from '../decoder/message.js';

export const LONGEST_US = 600e6; // ten minutes: 15 000 pictures at 25 a second, 5 MB of values

const EARLY_US = 5e6; // longer than what a browser may hold back and hand on at once

// What the character was told, picture by picture, at the times when the camera took them.
export class Recorder {
  running = false;
  rig = null;
  frames = []; // [{ frame, t_us from the first, age_us, state, values in the channels' units }]
  ended = ''; // why it ended by itself
  #began = 0; // the first picture, on the device's clock
  #offset = 0; // of the device's clock now
  #arrived = 0;

  start(rig) {
    Object.assign(this, { running: true, rig, frames: [], ended: '' });
  }
  stop(why = '') {
    this.running = false;
    this.ended = why;
  }

  get seconds() { return (this.frames.at(-1)?.t_us ?? 0) / 1e6; }

  // `values` are the pose's as the character gets them, gains included; `now` is when it came, ms.
  add(pose, values, now) {
    if (!this.running) return;
    if (pose.rig_id !== this.rig.rig_id) {
      this.stop('the rig has changed');
      return;
    }
    const captured = Number(pose.captured_us), last = this.frames.at(-1);
    const passed = last ? captured - this.#offset - last.t_us : 0, elapsed = 1000 * (now - this.#arrived);
    if (!last) this.#began = this.#offset = captured;
    // Another clock (a device that started anew, another line, a recording that begins again): it steps back, or forward more
    // than the time that passed here. A picture comes late, but never early.
    else if (passed < 0 || passed > elapsed + EARLY_US) this.#offset = captured - last.t_us - Math.max(1000, elapsed);
    this.#arrived = now;
    const t_us = Math.round(captured - this.#offset);
    if (last && t_us === last.t_us) return; // the same picture again
    if (t_us > LONGEST_US) {
      this.stop('ten minutes are the most');
      return;
    }
    this.frames.push({ frame: pose.frame_seq, t_us, age_us: pose.age_us, state: STATES[pose.state], values: Float32Array.from(values) });
  }

  // As `facewire monitor --csv` writes it, on the device's clock: what else the device recorded can be laid beside it.
  csv() {
    const name = (text) => (/[,"]/.test(text) ? `"${text.replaceAll('"', '""')}"` : text);
    const number = (value) => String(Number(value.toFixed(6)));
    const lines = this.frames.map(({ frame, t_us, age_us, state, values }) => [frame, this.#began + t_us, age_us, state, ...Array.from(values, number)]);
    return `${[['frame', 't_us', 'age_us', 'state', ...this.rig.channels.map((c) => name(c.name))], ...lines].map((l) => l.join()).join('\n')}\n`;
  }
}
