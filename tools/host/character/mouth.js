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
  const lipLine = [x2, line(x2) - 0.01 * s]; // the lips press on each other: nothing is seen between them
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
    // Deep inside, the lower lip falls off to the teeth, so that they and the tongue are seen over it.
    const fall = row === 2 ? 0.8 * Math.max(0, -height - 0.6) * smooth(0, -0.5, Math.sin(angle)) : 0;
    return [x, y - fall, front(x, y) + (height > 0 ? height * full * lower : height)];
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

// From the middle to the side: how wide a tooth is beside the others, and how much longer, cm.
const TEETH = [[1.25, 0.02], [0.95, -0.06], [1, 0.05], [0.9, -0.05], [0.9, -0.08], [1, -0.1]];
const ACROSS = [0, 0.05, 0.13, 0.3, 0.5, 0.7, 0.87, 0.95]; // where a tooth's columns are; the next one begins at 1
const ROUND = 0.17; // of a tooth's width is its corner

// Columns of a row of teeth: [t from -1 to 1, how far from the gap beside it in widths of a tooth, how much longer]
function toothColumns() {
  const whole = TEETH.reduce((sum, [width]) => sum + width, 0), half = [];
  let from = 0;
  for (const [width, longer] of TEETH) {
    for (const at of ACROSS) half.push([(from + at * width) / whole, Math.min(at, 1 - at), longer]);
    from += width;
  }
  half.push([1, 0, TEETH.at(-1)[1]]);
  return [...half.slice(1).reverse().map(([t, ...rest]) => [-t, ...rest]), ...half];
}

// A row of teeth on an arch; `down` is the way their edges look. The lower ones stand behind the upper ones.
export function teeth(down) {
  const upper = down > 0, columns = toothColumns();
  const y0 = MOUTH_Y + (upper ? 1.05 : -1.5), height = upper ? 1.62 : 1.2, behind = upper ? 0 : 0.3;
  return grid(columns.map((_, i) => i), 6, (u, v) => {
    const [t, beside, longer] = columns[u];
    const round = 1 - Math.sqrt(1 - Math.max(0, 1 - beside / ROUND) ** 2), gap = smooth(0.13, 0, beside);
    const tall = height * (1 - 0.3 * Math.abs(t)) + (upper ? longer : 0.4 * longer) - 0.16 * round;
    const along = upper ? 1 - v : v; // v upwards
    const thick = Math.sin(Math.PI * Math.min(1, 0.25 + 0.75 * along) * 0.98) ** 0.5;
    return [2.75 * Math.sin(t * 1.35), y0 - down * tall * along, 1.2 - behind + 2.9 * Math.cos(t * 1.35) - 0.14 * gap + 0.16 * thick];
  });
}

export function tongue() {
  return mapped(grid(20, 14, (u, v) => {
    const a = 2 * Math.PI * u, b = Math.PI * v;
    return [1.55 * Math.sin(b) * Math.cos(a), 0.42 * Math.sin(b) * Math.sin(a), 3 * -Math.cos(b)];
  }, { closed: true }), ([x, y, z]) => [x, y - 5.7 + 0.12 * z - 0.16 * bump(x, 0, 0, 0, 0.35) * (y > 0 ? 1 : 0), z + 0.6]);
}
