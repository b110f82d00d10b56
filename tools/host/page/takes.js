import { animate, glb } from '../character/animation.js';
import { Recorder } from './recorder.js';

// The section "Record": a button that begins and ends, and the files that come of it.

const $ = (id) => document.getElementById(id);
const put = (id, text) => { if ($(id).textContent !== text) $(id).textContent = text; };
const minutes = (seconds) => `${Math.floor(seconds / 60)}:${String(Math.floor(seconds % 60)).padStart(2, '0')}`;

function save(name, type, content) {
  const link = Object.assign(document.createElement('a'), { href: URL.createObjectURL(new Blob([content], { type })), download: name });
  link.click();
  setTimeout(() => URL.revokeObjectURL(link.href), 60_000);
}

export class Takes {
  #recorder = new Recorder();
  #name = '';
  #problem = '';
  #rig;

  // rig() is that of the line, or null; stage() gives { character, driver }; restage() moves the character back to where it was.
  constructor(rig, stage, restage) {
    this.#rig = rig;
    $('record').onclick = () => this.#toggle();
    $('save-csv').onclick = () => save(`${this.#name}.csv`, 'text/csv', this.#recorder.csv());
    $('save-glb').onclick = async () => {
      const { character, driver } = stage();
      const animation = animate(character, driver, this.#recorder.frames, this.#name);
      restage();
      try {
        save(`${this.#name}.glb`, 'model/gltf-binary', await glb(animation));
      } catch (error) {
        this.#problem = `This character cannot be saved: ${error.message}.`;
      }
    };
    document.addEventListener('keydown', (e) => {
      if (e.key !== 'r' || e.ctrlKey || e.metaKey || e.altKey || e.target.matches('input:not([type=checkbox], [type=range])')) return;
      if (!$('record').disabled) this.#toggle();
    });
  }

  add(pose, values, now) { this.#recorder.add(pose, values, now); }

  tell() {
    const { running, frames, seconds, ended, rig } = this.#recorder;
    $('record').disabled = !running && !this.#rig();
    $('record').setAttribute('aria-pressed', String(running));
    put('record-text', running ? `Stop ${minutes(seconds)}` : 'Record');
    const kept = !running && frames.length > 0;
    $('save-csv').disabled = !kept;
    // The character is driven by the line's rig; another's values mean nothing to it.
    $('save-glb').disabled = !kept || this.#rig()?.rig_id !== rig.rig_id;
    if (!running) put('record-note', kept ? `${frames.length} poses, ${seconds.toFixed(1)} s.${ended && ` Ended: ${ended}.`} ${this.#problem}`.trimEnd() : '');
  }

  #toggle() {
    if (this.#recorder.running) {
      this.#recorder.stop();
    } else {
      this.#recorder.start(this.#rig());
      this.#problem = '';
      this.#name = `facewire-${new Date().toISOString().slice(0, 19).replace(/[T:]/g, '-')}`;
    }
    this.tell();
  }
}
