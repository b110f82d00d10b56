import { BufferAttribute, BufferGeometry } from 'three';

// Geometry from formulas: grids over (u, v), rims, tubes and solids of revolution. All of it has positions in the
// head's space, normals, and morph targets that are offsets.

const steps = (n) => Array.from({ length: n + 1 }, (_, i) => i / n);
export const sub = (a, b) => [a[0] - b[0], a[1] - b[1], a[2] - b[2]];
export const cross = (a, b) => [a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]];
export const unit = (a) => {
  const l = Math.hypot(...a) || 1;
  return [a[0] / l, a[1] / l, a[2] / l];
};

// A grid of points at(u, v), u and v each a count of steps over 0..1 or a list of values. The face is where u x v points.
//   closed   u comes back to its beginning
//   ring     v does, too
//   hole     point -> the point where it shall lie when it is inside a hole, else null: quads within go, edges move onto
//            the hole's edge
//   rim      so deep do the outer edges fold in: a shell with thickness
export function grid(uSteps, vSteps, at, { closed = false, ring = false, hole = () => null, rim = 0 } = {}) {
  const us = typeof uSteps === 'number' ? steps(uSteps) : uSteps;
  const vs = typeof vSteps === 'number' ? steps(vSteps) : vSteps;
  const columns = closed ? us.length - 1 : us.length;
  const rows = [];
  for (const v of ring ? vs.slice(0, -1) : vs) rows.push(us.slice(0, columns).map((u) => at(u, v)));
  if (rim > 0) foldEdges(rows, rim, closed);
  const width = rows[0].length;
  const points = rows.flat();
  const edges = points.map((p) => hole(p));
  const index = [];
  const wrap = closed ? width : width - 1;
  for (let j = 0; j < (ring ? rows.length : rows.length - 1); ++j) {
    const above = (j + 1) % rows.length;
    for (let i = 0; i < wrap; ++i) {
      const k = (i + 1) % width;
      const quad = [j * width + i, j * width + k, above * width + k, above * width + i];
      if (quad.every((q) => edges[q])) continue;
      index.push(quad[0], quad[1], quad[2], quad[0], quad[2], quad[3]);
    }
  }
  points.forEach((p, i) => { if (edges[i]) points[i] = edges[i]; });
  return fromPoints(points, index);
}

// Two more rows and columns on each open edge: one that starts the bend, one `depth` inside.
function foldEdges(rows, depth, closed) {
  const inward = (edge, next, along0, along1, flip) => {
    const outward = unit(sub(edge, next));
    const normal = unit(cross(outward, sub(along1, along0)));
    const s = flip ? -1 : 1;
    const fold = (out, down) => edge.map((c, k) => c + outward[k] * out + s * normal[k] * down);
    return [fold(0.3 * depth, 0.35 * depth), fold(0.15 * depth, depth)];
  };
  const clamp = (i, n) => Math.min(n - 1, Math.max(0, i));
  const edgeRow = (row, next, flip) => {
    const n = row.length;
    const pairs = row.map((p, i) => {
      const a = closed ? row[(i + n - 1) % n] : row[clamp(i - 1, n)];
      const b = closed ? row[(i + 1) % n] : row[clamp(i + 1, n)];
      return inward(p, next[i], a, b, flip);
    });
    return [pairs.map((p) => p[0]), pairs.map((p) => p[1])];
  };
  const [top, bottom] = [edgeRow(rows[0], rows[1], true), edgeRow(rows.at(-1), rows.at(-2), false)];
  rows.unshift(top[0]);
  rows.unshift(top[1]);
  rows.push(bottom[0], bottom[1]);
  if (closed) return;
  const column = (i) => rows.map((row) => row.at(i));
  const left = edgeRow(column(0), column(1), false), right = edgeRow(column(-1), column(-2), true);
  rows.forEach((row, j) => {
    row.unshift(left[1][j], left[0][j]);
    row.push(right[0][j], right[1][j]);
  });
}

function fromPoints(points, index) {
  const used = new Map();
  for (const i of index) if (!used.has(i)) used.set(i, used.size);
  const positions = new Float32Array(3 * used.size);
  for (const [from, to] of used) positions.set(points[from], 3 * to);
  const geometry = new BufferGeometry();
  geometry.setAttribute('position', new BufferAttribute(positions, 3));
  geometry.setIndex(index.map((i) => used.get(i)));
  geometry.computeVertexNormals();
  return geometry;
}

// A tube around a line of points; radius(t) over 0..1, `flat` presses it along z.
export function tube(path, radius, { sides = 10, closed = false, flat = 1 } = {}) {
  const n = path.length;
  const frame = (i) => {
    const a = path[closed ? (i + n - 1) % n : Math.max(0, i - 1)], b = path[closed ? (i + 1) % n : Math.min(n - 1, i + 1)];
    const along = unit(sub(b, a));
    const side = unit(cross(along, [0, 0, 1]));
    return [side, unit(cross(side, along))];
  };
  const last = closed ? n : n - 1;
  return grid(sides, last, (u, v) => {
    const i = Math.round(v * last) % n;
    const [side, out] = frame(i);
    const r = typeof radius === 'number' ? radius : radius(v);
    const a = -2 * Math.PI * u;
    return path[i].map((c, k) => c + r * (Math.cos(a) * side[k] + flat * Math.sin(a) * out[k]));
  }, { closed: true, ring: closed });
}

// A line through the same points (two numbers each), `parts` times as fine and without kinks (Catmull-Rom).
export function rounded(points, parts) {
  const at = (i) => points[Math.min(points.length - 1, Math.max(0, i))];
  return points.slice(0, -1).flatMap((_, i) => Array.from({ length: parts }, (__, n) => {
    const t = n / parts, [a, b, c, d] = [at(i - 1), at(i), at(i + 1), at(i + 2)];
    return [0, 1].map((k) => b[k] + 0.5 * t * (c[k] - a[k] + t * (2 * a[k] - 5 * b[k] + 4 * c[k] - d[k] + t * (3 * (b[k] - c[k]) + d[k] - a[k]))));
  })).concat([points.at(-1)]);
}

// A solid of revolution about the vertical through (0, z): profile [[radius, y], ...] from the top down.
export function turnedSolid(profile, z, sides = 48) {
  return grid(sides, profile.length - 1, (u, v) => {
    const [r, y] = profile[Math.round(v * (profile.length - 1))];
    const a = -2 * Math.PI * u;
    return [r * Math.sin(a), y, z + r * Math.cos(a)];
  }, { closed: true });
}

export const pointsOf = (geometry) => {
  const p = geometry.getAttribute('position');
  return Array.from({ length: p.count }, (_, i) => [p.getX(i), p.getY(i), p.getZ(i)]);
};

export function mapped(geometry, move) {
  const position = geometry.getAttribute('position');
  pointsOf(geometry).forEach((p, i) => position.setXYZ(i, ...move(p, i)));
  geometry.computeVertexNormals();
  return geometry;
}

// Several geometries as one.
export function merged(geometries) {
  const points = [], index = [];
  for (const g of geometries) {
    index.push(...Array.from(g.getIndex().array, (i) => i + points.length));
    points.push(...pointsOf(g));
  }
  return fromPoints(points, index);
}

// The other side: x turned about, and the faces with it.
export function mirrored(geometry) {
  const copy = geometry.clone();
  const index = copy.getIndex().array;
  for (let i = 0; i < index.length; i += 3) [index[i], index[i + 1]] = [index[i + 1], index[i]];
  return mapped(copy, ([x, y, z]) => [-x, y, z]);
}

// fields: { shape: (point, i) => offset }. A shape that moves nothing here is left out.
export function addShapes(geometry, fields) {
  const rest = pointsOf(geometry);
  const normals = geometry.getAttribute('normal').array;
  const names = [], positions = [], bends = [];
  for (const [name, field] of Object.entries(fields)) {
    const offsets = new Float32Array(rest.flatMap((p, i) => field(p, i)));
    if (offsets.every((v) => Math.abs(v) < 1e-4)) continue;
    const moved = geometry.clone();
    mapped(moved, (p, i) => [p[0] + offsets[3 * i], p[1] + offsets[3 * i + 1], p[2] + offsets[3 * i + 2]]);
    const bend = moved.getAttribute('normal').array.map((v, i) => v - normals[i]);
    names.push(name);
    positions.push(named(new BufferAttribute(offsets, 3), name));
    bends.push(named(new BufferAttribute(bend, 3), name));
  }
  if (names.length > 0) {
    geometry.morphTargetsRelative = true;
    geometry.morphAttributes.position = positions;
    geometry.morphAttributes.normal = bends;
  }
  return names;
}

function named(attribute, name) {
  attribute.name = name;
  return attribute;
}
