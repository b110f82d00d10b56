// How fine the picture is drawn, as a part of the screen's own pixels: a weak computer gets fewer, so that motion stays fluent.
// Falls by a step when frames take long, rises again when they have been quick for a while; a rise that fails has the next
// one wait twice as long, so that the picture does not waver.
const STEP = 0.8, FLOOR = 0.5;
const LONG_MS = 24, QUICK_MS = 20; // at 60 Hz: more than every frame, and every frame
const FALL_AFTER = 8, RISE_AFTER_MS = 3000, LONGEST_RISE_MS = 60000;

export class Pace {
  scale = 1;
  #shortest = 34; // between two frames of this screen, ms; none is slower than 30 Hz
  #mean = null;
  #frames = 0;
  #since = 0; // of this scale, or of the last long frame
  #risen = -Infinity;
  #patience = RISE_AFTER_MS;

  // `now` and how long the last frame took, both ms; `drawn`: whether both it and the one before were drawn. True when
  // the scale changed.
  frame(now, took, drawn) {
    this.#shortest = Math.min(this.#shortest, Math.max(4, took));
    if (!drawn || took > 1000) return false; // nothing was drawn, or the page slept
    this.#mean = this.#mean === null ? took : this.#mean + 0.25 * (took - this.#mean);
    ++this.#frames;
    // A screen of 30 Hz is not slow.
    const slack = Math.max(1, this.#shortest / 17);
    if (this.#mean > QUICK_MS * slack) this.#since = now;
    if (this.#mean > LONG_MS * slack && this.#frames >= FALL_AFTER && this.scale > FLOOR) {
      this.#patience = now - this.#risen < RISE_AFTER_MS ? Math.min(LONGEST_RISE_MS, 2 * this.#patience) : RISE_AFTER_MS;
      return this.#change(Math.max(FLOOR, this.scale * STEP), now);
    }
    if (now - this.#since > this.#patience && this.scale < 1) {
      this.#risen = now;
      return this.#change(Math.min(1, this.scale / STEP), now);
    }
    return false;
  }

  #change(scale, now) {
    Object.assign(this, { scale });
    this.#mean = null;
    this.#frames = 0;
    this.#since = now;
    return true;
  }
}
