import { inHole } from './eyes.js';
import { cross, grid, merged, rounded, sub, tube, turnedSolid, unit } from './mesh.js';
import { MOUTH_Y, JAW_HINGE, TOP, around, front, mix, smooth } from './surface.js';

// The hard parts: shells on the head's surface with seams between them, ears, linkages, neck and bust.

const GAP = 0.09; // half a seam, cm
const SEAM_Y = 7.0; // between face and skull
const RIM = 0.32;

const plate = (columns, rows, [az0, az1], [y0, y1], options = {}) => grid(columns, rows, (u, v) => {
  const y = typeof y0 === 'function' ? mix(y0(u), y1(u), v) : mix(y0, y1, v);
  return around(mix(az0, az1, u), y);
}, { rim: RIM, ...options });

// The mouth's hole in face and jaw, smaller than the skin that fills it.
const inMouth = ([x, y]) => {
  const dx = x / 4.45, dy = (y - MOUTH_Y - 0.12) / 2.08;
  const r = Math.hypot(dx, dy);
  if (r >= 1 || Math.abs(x) > 4.6) return null;
  const px = x / Math.max(r, 1e-6), py = MOUTH_Y + 0.12 + (y - MOUTH_Y - 0.12) / Math.max(r, 1e-6);
  return [px, py, front(px, py)];
};

const FACE_TO = 66, TEMPLE_TO = 118, JAW_TO = 92;
const seamOverForehead = (u) => SEAM_Y - GAP - 0.9 * (2 * u - 1) ** 2; // dips to the temples

export const face = () => plate(100, 72, [-FACE_TO, FACE_TO], [() => MOUTH_Y + 0.12 + GAP, seamOverForehead],
  { hole: (p) => (p[2] < 0 ? null : inHole(p) ?? inMouth(p)) });

export const jaw = () => plate(92, 28, [-JAW_TO, JAW_TO], [-10.2, MOUTH_Y + 0.12 - GAP], { hole: (p) => (p[2] < 0 ? null : inMouth(p)) });

export const temple = () => plate(20, 36, [FACE_TO + 1.4, TEMPLE_TO], [(u) => mix(-3.6, -2.2, u), (u) => SEAM_Y - 0.9 - GAP - 0.1 * u]);

// One half of the skull; the seam over its top is GAP wide on each side.
export const skull = () => grid(40, 22, (u, v) => {
  const azimuth = mix(0, 180, u);
  const low = SEAM_Y + GAP - 0.9 * Math.min(1, azimuth / FACE_TO) ** 2;
  const y = mix(low, TOP - 0.02, Math.sin((v * Math.PI) / 2));
  const [x, py, z] = around(azimuth, y);
  return [x + GAP, py, z];
}, { rim: RIM });

export const occiput = () => plate(36, 28, [TEMPLE_TO + 1.4, 360 - TEMPLE_TO - 1.4], [-4.4, SEAM_Y - 0.9 - GAP]);

// What is seen through the seams, and behind eyes and mouth: there it leaves room for the tongue.
export const core = () => grid(36, 26, (u, v) => {
  const y = mix(-7, TOP - 0.5, v);
  const [x, , z] = around(360 * u, y);
  const shrink = mix(0.8, 0.93, smooth(3, 8, y));
  const deep = y > 7 ? 0.92 : mix(0.62, -0.2, smooth(-0.5, -3.6, y) * smooth(4.2, 2.4, Math.abs(x)));
  return [x * shrink, y, mix(-2.8, z, z > -2.8 ? deep : 0.92)];
}, { closed: true });

// A solid of revolution along an ear's axis: profile [[radius, height], ...] from its middle outwards.
function onEar(profile) {
  return grid(48, profile.length - 1, (u, v) => {
    const [r, h] = profile[profile.length - 1 - Math.round(v * (profile.length - 1))];
    const a = 2 * Math.PI * u;
    return [7.6 + h, 0.3 + r * Math.sin(-a), -2.6 + r * Math.cos(a)];
  }, { closed: true });
}
const ring = (r0, r1, h) => Array.from({ length: 13 }, (_, i) => {
  const a = Math.PI * (i / 12);
  return [mix(r0, r1, 0.5 - 0.5 * Math.cos(a)), h + 0.22 * Math.sin(a)];
});

// Discs where ears would be, the jaw's servos; around each a metal ring, and in it one that glows.
export const ear = () => onEar([[0.01, 0.62], [0.5, 0.62], [0.62, 0.5], [0.9, 0.5], [1.0, 0.55], [1.55, 0.55], [1.72, 0.45], [1.8, 0.1], [1.8, -1.2]]);
export const earRing = () => onEar([...ring(1.8, 2.25, 0.1), [2.25, -1]]);
export const earLight = () => onEar(ring(1.12, 1.42, 0.45));

// The heads of the screws that hold the shells: a disc on the surface with a slot across.
const SCREWS = [[59, 5.5], [59, -3.3], [59, -5.2], [108, 5.2], [30, 7.9], [118, 7.2], [82, -5.2]];
export const screws = () => merged(SCREWS.map(([azimuth, y]) => {
  const at = around(azimuth, y), right = around(azimuth + 1, y), up = around(azimuth, y + 0.1);
  const e1 = unit(sub(right, at)), n = unit(cross(e1, sub(up, at))), e2 = cross(n, e1);
  const profile = [[0.27, -0.1], [0.27, 0.03], [0.24, 0.06], [0.16, 0.07], [0.08, 0.08], [0.01, 0.08]];
  return grid(14, profile.length - 1, (u, v) => {
    const [r, h] = profile[Math.round(v * (profile.length - 1))], a = 2 * Math.PI * u;
    const [p, q] = [r * Math.cos(a), r * Math.sin(a)];
    const sunk = Math.abs(p * 0.8 + q * 0.6) < 0.07 ? -0.03 : 0;
    return at.map((c, k) => c + p * e1[k] + q * e2[k] + (h + sunk) * n[k]);
  }, { closed: true });
}));

// From the ear to the jaw: a rod that turns with it.
export const jawRod = () => tube(Array.from({ length: 13 }, (_, i) => {
  const t = i / 12;
  return [mix(6.9, 5.2, t), mix(JAW_HINGE[1], -6.0, t), mix(JAW_HINGE[2], 0.2, t)];
}), 0.32, { sides: 12 });

// A pad on the cheekbone: rings around its middle, [radius, height over the face] each. Its edge ends deep inside, because a smile
// lifts it.
const PAD = [[1, -0.75], [1.01, -0.1], [1, -0.02], [0.98, 0.03], [0.94, 0.06], [0.86, 0.09], [0.7, 0.115], [0.45, 0.13], [0.2, 0.14], [0.001, 0.14]];
export const cheekPad = () => grid(32, PAD.length - 1, (u, v) => {
  const [r, h] = PAD[Math.round(v * (PAD.length - 1))], a = 2 * Math.PI * u;
  const x = 4.65 + 1.12 * r * Math.cos(a), y = -1.5 + 0.98 * r * Math.sin(a);
  return [x, y, front(x, y) + h];
}, { closed: true });

// The bar of a brow: thick at its inner end, thin at the outer.
export function brow() {
  const at = (t) => {
    const x = mix(1.25, 5.75, t), y = 5.35 + 0.75 * Math.sin(0.75 * Math.PI * t) - 0.45 * t;
    return [x, y, front(x, y) + 0.18];
  };
  const path = Array.from({ length: 41 }, (_, i) => at(i / 40));
  return tube(path, (t) => mix(0.37, 0.17, t) * Math.min(1, 6 * t + 0.05, 6 * (1 - t) + 0.05) ** 0.5, { sides: 14, flat: 0.62 });
}

// Bellows, and the rods beside them. They end below the tongue, which an open mouth shows.
export const bellows = () => turnedSolid(Array.from({ length: 61 }, (_, i) => {
  const y = mix(-7.6, -16.1, i / 60);
  return [3.7 + 0.26 * Math.cos((y * 2 * Math.PI) / 1.05), y];
}), -3.2, 32);
export const neckRod = () => tube([[4.7, -15.6, -2.4], [4.7, -13, -2.4], [4.65, -10, -2.6], [4.6, -6, -2.8]], 0.3, { sides: 14 });
export const collar = () => turnedSolid([[4.0, -15.1], [5.0, -15.2], [5.2, -15.5], [5.2, -16.0], [5.0, -16.3], [4.0, -16.4]], -3.2, 56);

const BUST = [[3.8, -16], [5.0, -16.2], [7.0, -16.6], [9.4, -17.6], [11.2, -19.2], [12.2, -21.2], [12.5, -24.5], [12.1, -25]];
export const bust = () => turnedSolid([...rounded(BUST, 3), [0.1, -25]], -3.2, 64);
