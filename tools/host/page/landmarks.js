// The performer: the landmarks that the device sees, as lines. Not mirrored, as the character is not: who turns to the
// left of the picture turns the character to the left of the screen.

// Lines of MediaPipe's canonical face mesh, by landmark. Right and left are the performer's own: the right eye is on the
// left of the picture.
export const CONTOURS = {
  oval: [10, 338, 297, 332, 284, 251, 389, 356, 454, 323, 361, 288, 397, 365, 379, 378, 400, 377, 152,
    148, 176, 149, 150, 136, 172, 58, 132, 93, 234, 127, 162, 21, 54, 103, 67, 109, 10],
  lipsOuter: [61, 146, 91, 181, 84, 17, 314, 405, 321, 375, 291, 409, 270, 269, 267, 0, 37, 39, 40, 185, 61],
  lipsInner: [78, 95, 88, 178, 87, 14, 317, 402, 318, 324, 308, 415, 310, 311, 312, 13, 82, 81, 80, 191, 78],
  eyeRight: [33, 7, 163, 144, 145, 153, 154, 155, 133, 173, 157, 158, 159, 160, 161, 246, 33],
  eyeLeft: [263, 249, 390, 373, 374, 380, 381, 382, 362, 398, 384, 385, 386, 387, 388, 466, 263],
  browRight: [46, 53, 52, 65, 55, 107, 66, 105, 63, 70, 46],
  browLeft: [276, 283, 282, 295, 285, 336, 296, 334, 293, 300, 276],
  noseBridge: [168, 6, 197, 195, 5, 4],
  noseWings: [98, 97, 2, 326, 327],
};
// Four points each, on a circle. The mesh network has none.
export const IRISES = { irisRight: [469, 470, 471, 472], irisLeft: [474, 475, 476, 477] };
const STRONG = new Set(['lipsOuter', 'lipsInner', 'eyeRight', 'eyeLeft']);
// By the camera's clock, because a busy browser takes what came at once.
const NO_FACE_US = 250_000n; // a picture or two without a face is a blink of the tracker
const SILENCE_US = 1_500_000n;

export class Performer {
  static PICTURES = 30; // a second, asked for
  #canvas;
  #note;
  #picture = null; // the newest with a face
  #points = null; // where they are drawn: on their way to it
  #newest = null; // captured_us of the newest, with or without a face
  #every = 40; // ms between pictures
  #before = 0;
  #theme = null; // the colours, and of which theme
  #stale = true;

  constructor(canvas, note) {
    this.#canvas = canvas;
    this.#note = note;
    new ResizeObserver(() => { this.#stale = true; }).observe(canvas);
  }

  // A picture as LandmarkCollector gives it.
  show(picture) {
    if (picture.width_px > 0 && picture.height_px > 0) {
      this.#canvas.style.aspectRatio = `${picture.width_px} / ${picture.height_px}`;
    }
    const passed = this.#newest === null ? 0n : picture.captured_us - this.#newest;
    if (passed > 0n && passed < 500_000n) this.#every += 0.2 * (Number(passed) / 1000 - this.#every);
    this.#newest = picture.captured_us;
    if (picture.points.length === 0) return;
    // A face that was away does not fly in from where it was.
    if (!this.#faceIsThere || this.#points?.length !== picture.points.length) this.#points = Float32Array.from(picture.points);
    this.#picture = picture;
    this.#stale = true;
  }

  get #faceIsThere() {
    const age = this.#picture === null ? -1n : this.#newest - this.#picture.captured_us;
    return age >= 0n && age <= NO_FACE_US;
  }

  // What a line of text says about it; '' while a face is shown. `pose` is the newest, or null when there is no line;
  // `held` says that no more come at present; `problem` why the device sends no landmarks.
  say(pose, held, problem) {
    const age = pose && this.#newest !== null ? pose.captured_us - this.#newest : SILENCE_US + 1n;
    const text = !pose ? 'nothing comes' : age > SILENCE_US || -age > SILENCE_US ? problem || 'no landmarks come'
      : this.#faceIsThere ? '' : 'no face';
    if (this.#note.textContent !== text) this.#note.textContent = text;
    this.#canvas.toggleAttribute('data-held', held);
    if (text !== '' && this.#picture) {
      this.#picture = this.#points = null;
      this.#stale = true;
    }
  }

  // As often as the screen likes.
  draw(now = performance.now()) {
    const passed = Math.min(100, now - this.#before);
    this.#before = now;
    this.#follow(1 - Math.exp(-passed / (0.4 * this.#every)));
    const { theme } = document.documentElement.dataset;
    if (this.#theme?.name !== theme) {
      const style = getComputedStyle(this.#canvas);
      const colour = (name) => style.getPropertyValue(name);
      this.#theme = { name: theme, strong: colour('--accent'), fine: colour('--faint') };
      this.#stale = true;
    }
    if (!this.#stale || this.#canvas.clientWidth === 0) return;
    this.#stale = false;
    this.#paint();
  }

  // From picture to picture in small steps, so that ten a second look like more.
  #follow(part) {
    if (!this.#points) return;
    let most = 0;
    this.#picture.points.forEach((target, i) => {
      const step = part * (target - this.#points[i]);
      most = Math.max(most, Math.abs(step));
      this.#points[i] += step;
    });
    if (most > 0.02) this.#stale = true;
  }

  #paint() {
    const canvas = this.#canvas, ratio = window.devicePixelRatio || 1;
    const width = canvas.clientWidth, height = canvas.clientHeight;
    for (const [side, pixels] of [['width', Math.round(width * ratio)], ['height', Math.round(height * ratio)]]) {
      if (canvas[side] !== pixels) canvas[side] = pixels;
    }
    const g = canvas.getContext('2d');
    g.setTransform(1, 0, 0, 1, 0, 0);
    g.clearRect(0, 0, canvas.width, canvas.height);
    if (!this.#points) {
      delete canvas.dataset.frame;
      return;
    }
    canvas.dataset.frame = this.#picture.frame_seq; // for who watches from outside
    g.setTransform(ratio, 0, 0, ratio, 0, 0);
    const scale = width / this.#picture.width_px;
    const at = (i) => [scale * this.#points[2 * i], scale * this.#points[2 * i + 1]];
    g.fillStyle = this.#theme.fine;
    g.globalAlpha = 0.45;
    for (let i = 0; 2 * i < this.#points.length; ++i) {
      const [x, y] = at(i);
      g.fillRect(x - 0.5, y - 0.5, 1, 1);
    }
    g.globalAlpha = 1;
    g.lineJoin = g.lineCap = 'round';
    for (const [name, line] of Object.entries(CONTOURS)) {
      g.strokeStyle = STRONG.has(name) ? this.#theme.strong : this.#theme.fine;
      g.lineWidth = STRONG.has(name) ? 1.4 : 1;
      g.beginPath();
      line.forEach((i, n) => g[n === 0 ? 'moveTo' : 'lineTo'](...at(i)));
      g.stroke();
    }
    g.strokeStyle = this.#theme.strong;
    g.lineWidth = 1.4;
    for (const rim of Object.values(IRISES)) {
      if (2 * rim.at(-1) >= this.#points.length) continue;
      const mean = (values) => values.reduce((sum, v) => sum + v, 0) / values.length;
      const [x, y] = [0, 1].map((k) => mean(rim.map((i) => at(i)[k])));
      g.beginPath();
      g.arc(x, y, mean(rim.map((i) => Math.hypot(at(i)[0] - x, at(i)[1] - y))), 0, 2 * Math.PI);
      g.stroke();
    }
  }
}
