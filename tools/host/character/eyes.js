import { BufferAttribute } from 'three';

import { grid, pointsOf, tube } from './mesh.js';
import { EYE, EYE_RADIUS, front, mix, smooth } from './surface.js';

// The left eye; the right one is its mirror image.

const DEGREES = Math.PI / 180;
const PUPIL = 12, IRIS = 31; // degrees from the axis
const LID_RADIUS = EYE_RADIUS + 0.18;
const COVER = 0.03; // how far over the lower lid the upper one turns, so that it hides the other's lash
export const UPPER_EDGE = 27, LOWER_EDGE = -26; // of the lids at rest, degrees above the axis

const noise = (n) => {
  const v = Math.sin(n * 127.1) * 43758.5453;
  return v - Math.floor(v);
};

// A cap around the axis, from its rim to its pole, with `bulge` over the eyeball's radius.
function cap(degrees, columns, bulge) {
  const rings = degrees.map((d) => d * DEGREES);
  return grid(columns, rings, (u, a) => {
    const r = EYE_RADIUS + bulge(a / DEGREES), t = 2 * Math.PI * u;
    return [EYE[0] + r * Math.sin(a) * Math.cos(t), EYE[1] + r * Math.sin(a) * Math.sin(t), EYE[2] + r * Math.cos(a)];
  }, { closed: true });
}

export function eyeball() {
  const rings = [130, 100, 80, 64, 48, 41, 36, 33.4, 32.4, 31.4, 30, 28, 26, 24, 22, 20, 18, 16, 14, 12.6, 11.8, 11, 8, 4, 0.01];
  // The iris lies a little sunk behind the cornea.
  const geometry = cap(rings, 64, (d) => -0.12 * smooth(33, 22, d));
  const colors = new Float32Array(3 * geometry.getAttribute('position').count);
  pointsOf(geometry).forEach(([x, y, z], i) => {
    const dx = x - EYE[0], dy = y - EYE[1];
    const d = Math.atan2(Math.hypot(dx, dy), z - EYE[2]) / DEGREES;
    const spoke = Math.round((Math.atan2(dy, dx) / (2 * Math.PI) + 1) * 64) % 64;
    const fibre = 0.72 + 0.28 * noise(spoke) + 0.18 * noise(spoke * 7 + Math.round(d));
    const inIris = [mix(0.11, 0.015, smooth(14, 29, d)), mix(0.5, 0.16, smooth(14, 29, d)), mix(0.52, 0.22, smooth(14, 29, d))].map((c) => c * fibre);
    const white = [0.86, 0.85, 0.82].map((c) => c * (1 - 0.25 * smooth(60, 110, d)));
    const limbus = smooth(29, 31, d) * smooth(34.5, 32.4, d);
    let c = d > 32.2 ? white : inIris;
    c = c.map((v) => mix(v, 0.012, limbus));
    if (d < PUPIL) c = [0.003, 0.003, 0.004];
    colors.set(c, 3 * i);
  });
  geometry.setAttribute('color', new BufferAttribute(colors, 3));
  return geometry;
}

export const cornea = () => cap([42, 38, 34, 30, 25, 20, 14, 8, 0.01], 48, (d) => 0.015 + 0.13 * smooth(IRIS + 7, 10, d));

// On a sphere around the eye: `across` degrees to the left, `up` degrees about the axis through both eyes.
const onLid = (r, across, up) => {
  const a = across * DEGREES, b = up * DEGREES;
  return [EYE[0] + r * Math.sin(a), EYE[1] + r * Math.cos(a) * Math.sin(b), EYE[2] + r * Math.cos(a) * Math.cos(b)];
};
const WIDE = 84;
// Towards the corners the edges come together, so that the opening is an almond.
const edgeAt = (edge, across) => edge * (1 - 0.55 * smooth(25, WIDE, Math.abs(across)));

export const upperLid = () => grid(36, 10, (u, v) => {
  const across = mix(-WIDE, WIDE, u);
  return onLid(LID_RADIUS + COVER + 0.03 * smooth(0.3, 0, v), across, mix(edgeAt(UPPER_EDGE, across), 128, v)); // thicker at its edge
}, { rim: 0.16 });

export const lowerLid = () => grid(36, 8, (u, v) => {
  const across = mix(-WIDE, WIDE, u);
  return onLid(LID_RADIUS - 0.02, across, mix(-120, edgeAt(LOWER_EDGE, across), v));
}, { rim: 0.16 });

// The rubber along a lid's edge, which draws the eye's line; its middle is `height` over the lid.
export function lash(edge, radius, height) {
  const path = Array.from({ length: 33 }, (_, i) => {
    const across = mix(-68, 68, i / 32);
    return onLid(LID_RADIUS + height, across, edgeAt(edge, across));
  });
  return tube(path, (t) => radius * Math.sin(Math.PI * mix(0.01, 0.99, t)) ** 0.5, { sides: 6 });
}

// The hole in the shell, and the metal ring around it. The hole is an ellipse, a little higher outside.
export const HOLE = { rx: 2.3, ry: 2.05 };
export function inHole([x, y], grow = 1) {
  const side = Math.sign(x) || 1;
  const dx = Math.abs(x) - EYE[0] - 0.06, dy = y - EYE[1] + 0.02;
  const r = Math.hypot(dx / (HOLE.rx * grow), dy / (HOLE.ry * grow));
  if (r >= 1) return null;
  const k = 1 / Math.max(r, 1e-6);
  const px = side * (EYE[0] + 0.06 + dx * k), py = EYE[1] - 0.02 + dy * k;
  return [px, py, front(px, py)];
}
const onHole = (a) => {
  const x = EYE[0] + 0.06 + (HOLE.rx + 0.03) * Math.cos(a), y = EYE[1] - 0.02 + (HOLE.ry + 0.03) * Math.sin(a);
  return [x, y, front(x, y) + 0.06];
};

// The membrane from the ring to the lids, which turn in it: it sags, but not into them, and its end reaches through them to the
// eyeball, so that nothing is seen past them from aside.
const INWARD = [0, 0.3, 0.6, 0.8, 1]; // the way to the lids
export const membrane = () => grid(52, INWARD.length, (u, step) => {
  const a = 2 * Math.PI * u, tilt = 66 * DEGREES, k = Math.round(step * INWARD.length);
  const direction = [Math.sin(tilt) * Math.cos(a), Math.sin(tilt) * Math.sin(a), Math.cos(tilt)];
  const onSphere = (radius) => EYE.map((c, i) => c + radius * direction[i]);
  if (k === INWARD.length) return onSphere(EYE_RADIUS - 0.05);
  const v = INWARD[k], r = LID_RADIUS + 0.1, from = onHole(a), to = onSphere(r);
  const away = from.map((c, i) => mix(c, to[i], v) - (i === 2 ? 0.35 * Math.sin(Math.PI * v) : 0) - EYE[i]);
  const out = Math.max(1, r / Math.hypot(...away));
  return away.map((c, i) => EYE[i] + out * c);
}, { closed: true });

export function bezel() {
  const path = Array.from({ length: 72 }, (_, i) => onHole((2 * Math.PI * i) / 72));
  return tube(path, 0.17, { sides: 8, closed: true });
}
