import { BufferAttribute } from 'three';

import { grid, mapped, pointsOf } from './mesh.js';
import { MOUTH_Y, bump, front, mix, smooth } from './surface.js';

// The skin around the mouth: a ring from where the shells hold it, over the lips, to the line between them and inside.

const LINE_HALF = 2.42; // half the width of the mouth
const COLUMNS = 112;

// Rows of the ring: how far from the shells' edge (0) over the rim of the lips (1) to their line (2), and how high over
// the head's surface; below the line the skin turns inside.
const ROWS = [
  [0, -0.4], [0.03, -0.16], [0.09, -0.05], [0.2, 0.0], [0.4, 0.05], [0.6, 0.08], [0.8, 0.12], [0.92, 0.18], [1, 0.28], [1.15, 0.42], [1.32, 0.5],
  [1.5, 0.48], [1.68, 0.38], [1.85, 0.22], [2, 0.04], [2, -0.35], [2, -0.9], [2, -1.5],
];

const line = (x) => MOUTH_Y + 0.24 * (x / LINE_HALF) ** 2 - 0.05 * bump(x, 0, 0, 0, 0.5);

function between(angle, row) {
  const c = Math.cos(angle), s = Math.sin(angle);
  const edge = [4.75 * c, MOUTH_Y + 0.12 + (s > 0 ? 2.2 : 2.4) * s];
  const x1 = 2.72 * c, x2 = LINE_HALF * c;
  // The upper lip has a bow, the lower one is fuller.
  const height = s > 0
    ? 0.6 * s ** 0.9 + 0.12 * (bump(x1, 0, 0.62, 0, 0.5) + bump(x1, 0, -0.62, 0, 0.5)) * s - 0.06 * bump(x1, 0, 0, 0, 0.3)
    : -0.78 * (-s) ** 0.85;
  const rim = [x1, line(x1) + height];
  const lipLine = [x2, line(x2) + 0.02 * s];
  const [from, to, t] = row < 1 ? [edge, rim, row] : [rim, lipLine, row - 1];
  return [mix(from[0], to[0], t), mix(from[1], to[1], t)];
}

// { geometry, jaw: the part of the jaw in each vertex, for its skin weights and shapes }. Colours blend the shells into skin and skin into lips.
export function mouthSkin(shell, skin, lip) {
  const angles = Array.from({ length: COLUMNS + 1 }, (_, i) => {
    const a = (2 * Math.PI * i) / COLUMNS;
    return a - 0.2 * Math.sin(2 * a); // closer together at the corners
  });
  const at = (angle, k) => {
    const [row, height] = ROWS[k];
    const [x, y] = between(angle, row);
    // Lips are fullest in the middle and end flat in the corners.
    const full = row > 0.85 ? mix(0.25, 1, smooth(1, 0.25, Math.abs(x) / 2.75)) : 1;
    const lower = Math.sin(angle) < 0 ? 0.92 : 1;
    return [x, y, front(x, y) + (height > 0 ? height * full * lower : height)];
  };
  const ring = (of) => grid(angles, ROWS.map((_, k) => k), of, { closed: true });
  const geometry = ring(at);
  // The same grid again, to know each vertex's place in it.
  const places = pointsOf(ring((angle, k) => [angle, k, 0]));
  const colors = new Float32Array(3 * places.length);
  const jaw = places.map(([angle, k], i) => {
    const row = ROWS[Math.round(k)][0] + (Math.round(k) >= 14 ? 0.5 : 0);
    const tint = smooth(0.9, 1.06, row);
    const dark = row > 2.2 ? 0.25 : 1 - 0.55 * smooth(1.72, 2.3, row);
    for (let c = 0; c < 3; ++c) colors[3 * i + c] = mix(mix(shell[c], skin[c], smooth(0.05, 0.75, row)), lip[c], tint) * dark;
    // At the shells' edge half hangs on each; at the lips an ellipse opens, so that it is shared out by their height.
    const s = Math.sin(angle);
    const lips = 0.5 - 0.5 * Math.sign(s) * Math.abs(s) ** 0.62;
    return mix(smooth(0.16, -0.16, s), lips, smooth(0.1, 1, row));
  });
  geometry.setAttribute('color', new BufferAttribute(colors, 3));
  return { geometry, jaw };
}

// A row of teeth on an arch; `down` is the way their edges look.
export function teeth(down) {
  const count = 12, y0 = MOUTH_Y + (down > 0 ? 1.05 : -1.5);
  const arch = (t) => [2.75 * Math.sin(t * 1.35), 0, 1.2 + 2.9 * Math.cos(t * 1.35)];
  return grid(count * 8, 6, (u, v) => {
    const t = 2 * u - 1;
    const [x, , z] = arch(t);
    const within = Math.abs(((u * count) % 1) - 0.5) * 2; // 0 in a tooth's middle, 1 between two
    const gap = smooth(0.72, 1, within);
    const tall = (down > 0 ? 1.62 : 0.95) * (1 - 0.3 * Math.abs(t)) - 0.14 * gap;
    const along = down > 0 ? 1 - v : v; // v upwards
    const thick = Math.sin(Math.PI * Math.min(1, 0.25 + 0.75 * along) * 0.98) ** 0.5;
    return [x, y0 - down * tall * along, z - 0.14 * gap + 0.16 * thick];
  });
}

export function tongue() {
  return mapped(grid(28, 20, (u, v) => {
    const a = 2 * Math.PI * u, b = Math.PI * v;
    return [1.55 * Math.sin(b) * Math.cos(a), 0.42 * Math.sin(b) * Math.sin(a), 3 * -Math.cos(b)];
  }, { closed: true }), ([x, y, z]) => [x, y - 6.0 + 0.12 * z - 0.16 * bump(x, 0, 0, 0, 0.35) * (y > 0 ? 1 : 0), z + 0.6]);
}
