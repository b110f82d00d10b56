// The shape of the head, as a formula: every shell, seam and patch of skin lies on it. Centimetres, x to the
// character's left, y up, z out of its face; the origin and the features are those of app/share/otto.toml.

export const EYE = [3.18, 2.6, 2.6]; // centre of the left eye
export const EYE_RADIUS = 1.95;
export const MOUTH_Y = -4.35;
export const JAW_HINGE = [0, -0.6, -2.2];
export const NECK = [0, -11, -3];

const CENTRE_Z = -2.8;
const ROUNDNESS = 2.35; // of the superellipses that the head is cut into by level planes

// y, half the width, depth before and behind CENTRE_Z.
const LEVELS = [
  [13, 8.1, 8.5, 8.6], [9, 8.1, 8.5, 8.7], [4, 7.95, 8.2, 8.6], [2.6, 7.8, 7.95, 8.5], [0, 7.5, 7.95, 7.9],
  [-2.5, 7.15, 7.95, 6.8], [-5, 6.55, 7.9, 5.4], [-7.5, 5.75, 7.5, 4], [-9.2, 4.4, 6.7, 2.6], [-10.3, 2.7, 4.9, 1],
];
const CAP_FROM = 2.5, CAP_HEIGHT = 9.2, CAP_ROUNDNESS = 2.35; // above, the head closes as a superellipsoid
export const TOP = CAP_FROM + CAP_HEIGHT;

export const smooth = (from, to, x) => {
  const t = Math.min(1, Math.max(0, (x - from) / (to - from)));
  return t * t * (3 - 2 * t);
};
export const mix = (a, b, t) => a + (b - a) * t;
export const bump = (x, y, cx, cy, rx, ry = rx) => Math.exp(-(((x - cx) / rx) ** 2) - ((y - cy) / ry) ** 2);

// Half width, front and back depth at a height: Catmull-Rom through LEVELS, times the cap.
function level(y) {
  const cap = y > CAP_FROM ? Math.max(0, 1 - ((y - CAP_FROM) / CAP_HEIGHT) ** CAP_ROUNDNESS) ** (1 / CAP_ROUNDNESS) : 1;
  let i = 1;
  while (i < LEVELS.length - 2 && y < LEVELS[i + 1][0]) ++i;
  if (y > LEVELS[1][0]) i = 0;
  const row = (k) => LEVELS[Math.min(LEVELS.length - 1, Math.max(0, k))];
  const [p0, p1, p2, p3] = [row(i - 1), row(i), row(i + 1), row(i + 2)];
  const t = Math.min(1, Math.max(0, (y - p1[0]) / (p2[0] - p1[0])));
  return [1, 2, 3].map((k) => {
    // Slopes by height, because the levels are not evenly spaced.
    const slope = (a, b) => (a[0] === b[0] ? 0 : (b[k] - a[k]) / (b[0] - a[0]));
    const h = p2[0] - p1[0];
    const m1 = slope(p0, p2) * h, m2 = slope(p1, p3) * h;
    const t2 = t * t, t3 = t2 * t;
    const value = (2 * t3 - 3 * t2 + 1) * p1[k] + (t3 - 2 * t2 + t) * m1 + (3 * t2 - 2 * t3) * p2[k] + (t3 - t2) * m2;
    return value * cap;
  });
}

// What makes a face of an egg: added to z, in front.
function features(x, y) {
  const side = Math.abs(x);
  const nose = (y > -1.15 ? smooth(4.4, -1.15, y) ** 1.15 : smooth(-2.35, -1.15, y)) * 2.75;
  const width = mix(0.85, 1.2, smooth(3, -1, y));
  return nose * Math.exp(-(Math.abs(x / width) ** 2.2))
    + 0.55 * bump(side, y, 1.25, -1.45, 0.6, 0.55) // wings of the nose
    - 1.45 * bump(side, y, 3.2, 2.5, 2.45, 1.9) // sockets
    + 0.5 * bump(side, y, 3.2, 5.2, 2.8, 0.95) // brow ridge
    + 0.55 * bump(side, y, 4.7, -0.5, 1.9, 1.7) // cheekbones
    - 0.45 * bump(side, y, 5.3, -4.4, 1.5, 2.2) // hollow below them
    + 0.55 * bump(x, y, 0, -4.4, 3.2, 2.3) // muzzle
    - 0.45 * bump(x, y, 0, -6.75, 2.6, 0.6) // fold above the chin
    + 0.75 * bump(x, y, 0, -8.7, 1.9, 1.25); // chin
}

// On the front half, over (x, y).
export function front(x, y) {
  const [width, depth] = level(y);
  const along = Math.min(1, Math.abs(x) / Math.max(width, 1e-6));
  const round = (1 - along ** ROUNDNESS) ** (1 / ROUNDNESS);
  return CENTRE_Z + depth * round + features(x, y) * smooth(0, 0.55, round);
}

// All around: `azimuth` from the front to the left, in degrees.
export function around(azimuth, y) {
  const a = (azimuth * Math.PI) / 180;
  const [width, depth, back] = level(y);
  const power = (v) => Math.sign(v) * Math.abs(v) ** (2 / ROUNDNESS);
  const x = width * power(Math.sin(a));
  const c = power(Math.cos(a));
  const z = CENTRE_Z + c * (c > 0 ? depth : back);
  return [x, y, c > 0 ? z + features(x, y) * smooth(0, 0.55, c) : z];
}

export const mirror = ([x, y, z]) => [-x, y, z];

// The point turned about a pivot: pitch nods down, yaw turns to the character's left, in degrees.
export function turned([x, y, z], pivot, { pitch = 0, yaw = 0 }) {
  const [px, py, pz] = pivot;
  const a = (pitch * Math.PI) / 180, b = (yaw * Math.PI) / 180;
  const [dx, dy, dz] = [x - px, y - py, z - pz];
  const y1 = dy * Math.cos(a) - dz * Math.sin(a), z1 = dy * Math.sin(a) + dz * Math.cos(a);
  return [px + dx * Math.cos(b) + z1 * Math.sin(b), py + y1, pz - dx * Math.sin(b) + z1 * Math.cos(b)];
}
