import { EYE, JAW_HINGE, MOUTH_Y, bump, front, mirror, mix, smooth, turned } from './surface.js';

// What each ARKit-named shape does, as fields of offsets over the head: (point, part of the jaw) => [dx, dy, dz] in cm at
// weight 1. Those of the left side are written down; those of the right are their mirror images.

export const JAW_OPEN = 22; // degrees, as jaw.pitch of the default rig
const BLINK = 45, WIDE = -14, SQUINT = -19, LOWER_BLINK = -10;
const LOOK = { Up: { pitch: -22 }, Down: { pitch: 25 }, In: { yaw: -28 }, Out: { yaw: 28 } };

export const ARKIT = ['eyeBlink', 'eyeLookDown', 'eyeLookIn', 'eyeLookOut', 'eyeLookUp', 'eyeSquint', 'eyeWide']
  .flatMap((n) => [`${n}Left`, `${n}Right`])
  .concat(['jawForward', 'jawLeft', 'jawRight', 'jawOpen', 'mouthClose', 'mouthFunnel', 'mouthPucker', 'mouthLeft', 'mouthRight'])
  .concat(['mouthSmile', 'mouthFrown', 'mouthDimple', 'mouthStretch', 'mouthPress', 'mouthLowerDown', 'mouthUpperUp']
    .flatMap((n) => [`${n}Left`, `${n}Right`]))
  .concat(['mouthRollLower', 'mouthRollUpper', 'mouthShrugLower', 'mouthShrugUpper', 'browInnerUp', 'cheekPuff', 'tongueOut'])
  .concat(['browDown', 'browOuterUp', 'cheekSquint', 'noseSneer'].flatMap((n) => [`${n}Left`, `${n}Right`]));

const minus = (a, b) => [a[0] - b[0], a[1] - b[1], a[2] - b[2]];
const times = (k, v) => [k * v[0], k * v[1], k * v[2]];
const sum = (...all) => [0, 1, 2].map((k) => all.reduce((s, v) => s + v[k], 0));

// { nameLeft: field } with its mirror image as nameRight.
function bothSides(fields) {
  const all = {};
  for (const [name, field] of Object.entries(fields)) {
    all[`${name}Left`] = field;
    all[`${name}Right`] = (p, jaw) => mirror(field(mirror(p), jaw));
  }
  return all;
}

const opened = (p) => minus(turned(p, JAW_HINGE, { pitch: JAW_OPEN }), p);

// What moves with the jaw, by the part of the jaw in it (1 for the jaw itself).
export const jawShapes = {
  jawOpen: (p, jaw) => times(jaw, opened(p)),
  jawForward: (p, jaw) => [0, 0, 0.9 * jaw],
  jawLeft: (p, jaw) => [0.9 * jaw, 0, 0],
  jawRight: (p, jaw) => [-0.9 * jaw, 0, 0],
};

// On the lips 1, fading to 0 where the skin is held by the shells.
const lips = ([x, y]) => smooth(1, 0.42, Math.hypot(x / 4.6, (y - MOUTH_Y) / 2.3));
const corner = ([x, y]) => bump(x, y, 2.6, MOUTH_Y, 1.75, 1.5) * smooth(1, 0.5, Math.hypot(x / 4.75, (y - MOUTH_Y) / 2.4));
const leftHalf = ([x]) => smooth(-0.7, 0.9, x);
const upper = (p, jaw) => lips(p) * smooth(0.6, 0.2, jaw);
const lower = (p, jaw) => lips(p) * smooth(0.4, 0.8, jaw);
const toLine = ([, y]) => MOUTH_Y - y;
// Along the head's surface.
const along = ([x, y], dx, dy) => [dx, dy, front(x + dx, y + dy) - front(x, y)];

export const mouthShapes = {
  ...jawShapes,
  ...bothSides({
    mouthSmile: (p) => sum(along(p, 0.8 * corner(p), 0.95 * corner(p)), times(lips(p) * leftHalf(p), [0, 0.12 * toLine(p), -0.12])),
    mouthFrown: (p) => times(corner(p), [0.15, -1.05, -0.15]),
    mouthDimple: (p) => times(corner(p), [0.45, 0.1, -0.6]),
    mouthStretch: (p) => times(corner(p), [1.0, -0.35, -0.5]),
    mouthPress: (p, jaw) => times(lips(p) * leftHalf(p) * (0.4 + 0.6 * Math.abs(1 - 2 * jaw)), [0, 0.38 * toLine(p), -0.3]),
    mouthLowerDown: (p, jaw) => times(lower(p, jaw) * bump(p[0], 0, 1.25, 0, 1.25), [0.1, -0.85, 0.1]),
    mouthUpperUp: (p, jaw) => times(upper(p, jaw) * bump(p[0], 0, 1.25, 0, 1.25), [0.05, 0.75, 0.12]),
    noseSneer: (p, jaw) => times(upper(p, jaw) * bump(p[0], 0, 1.2, 0, 1.1), [0, 0.35, 0.08]),
  }),
  mouthPucker: (p) => times(lips(p), [-0.46 * p[0], -0.1 * toLine(p), 1.0 - 0.12 * Math.abs(p[0])]),
  mouthFunnel: (p, jaw) => sum(times(lips(p), [-0.32 * p[0], 0, 0.85]), [0, 0.5 * upper(p, jaw) - 0.6 * lower(p, jaw), 0]),
  mouthLeft: (p) => times(lips(p), [1.0, 0, -0.12 * p[0]]),
  mouthRight: (p) => times(lips(p), [-1.0, 0, 0.12 * p[0]]),
  mouthRollLower: (p, jaw) => times(lower(p, jaw), [0, 0.45 * toLine(p), -0.6]),
  mouthRollUpper: (p, jaw) => times(upper(p, jaw), [0, 0.45 * toLine(p), -0.6]),
  mouthShrugLower: (p, jaw) => times(lower(p, jaw), [0, 0.5, 0.35]),
  mouthShrugUpper: (p, jaw) => times(upper(p, jaw), [0, 0.45, 0.25]),
  // Brings the lips together again while the jaw is open.
  mouthClose: (p, jaw) => sum(times(-0.94 * lower(p, jaw), opened(p)), times(0.06 * upper(p, jaw), opened(p))),
  cheekPuff: (p) => [0, 0, 0.4 * lips(p)],
};

// The bones of the lips push on the skin: one cm along their axes.
const pushes = (bone, weight, axes) => Object.fromEntries(axes.map((axis) => [`${bone}.${axis}`, (p, jaw) =>
  times(weight(p, jaw), { x: [1, 0, 0], y: [0, 1, 0], z: [0, 0, 1] }[axis])]));
export const lipBones = {
  ...pushes('lip_corner_L', corner, ['x', 'y', 'z']),
  ...pushes('lip_corner_R', (p) => corner(mirror(p)), ['x', 'y', 'z']),
  ...pushes('upper_lip', (p, jaw) => upper(p, jaw) * bump(p[0], 0, 0, 0, 2), ['y', 'z']),
  ...pushes('lower_lip', (p, jaw) => lower(p, jaw) * bump(p[0], 0, 0, 0, 2), ['y', 'z']),
};

// Up over the lower teeth and lip, out between the lips, and its tip down.
export const tongueShapes = {
  tongueOut: ([, , z]) => [0, 1.85 * smooth(-1.5, 2.2, z) - 1.1 * smooth(2.5, 3.6, z), 4 * smooth(-2, 3.6, z)],
};

// The shell of the face gives a little around the nose.
export const faceShapes = bothSides({
  noseSneer: ([x, y]) => times(bump(x, y, 1.25, -1.2, 0.9, 0.9), [0.06, 0.42, 0.12]),
});

// The pads on the cheekbones.
const pad = (offset) => ([x]) => (x > 0 ? offset : [0, 0, 0]);
const puffed = pad([0.4, -0.15, 0.6]);
export const cheekShapes = {
  ...bothSides({ cheekSquint: pad([0, 0.6, 0.25]), mouthSmile: pad([0.12, 0.45, 0.28]) }),
  cheekPuff: (p) => sum(puffed(p), mirror(puffed(mirror(p)))),
};

// A bar over the eye, held at its two ends.
const outer = ([x]) => smooth(1.2, 5.8, x);
const onLeft = (field) => (p) => (p[0] > 0 ? field(p) : [0, 0, 0]);
export const browShapes = {
  ...bothSides({
    browDown: onLeft((p) => mixed(p, [-0.35, -1.05, 0.3], [-0.1, -0.15, 0.1])),
    browOuterUp: onLeft((p) => mixed(p, [0, 0.15, 0], [0, 1.15, -0.25])),
  }),
  browInnerUp: (p) => (p[0] > 0 ? raised(p) : mirror(raised(mirror(p)))),
};
function mixed(p, inner, outward) {
  return inner.map((v, k) => mix(v, outward[k], outer(p)));
}
const raised = (p) => mixed(p, [-0.05, 1.15, 0.05], [0, -0.15, 0]);
const zero = [0, 0, 0];
export const browBones = {
  'brow_inner_L.x': onLeft((p) => mixed(p, [1, 0, 0], zero)),
  'brow_inner_L.y': onLeft((p) => mixed(p, [0, 1, 0], zero)),
  'brow_outer_L.y': onLeft((p) => mixed(p, zero, [0, 1, 0])),
  'brow_inner_R.x': (p) => (p[0] < 0 ? mixed(mirror(p), [1, 0, 0], zero) : zero),
  'brow_inner_R.y': (p) => (p[0] < 0 ? mixed(mirror(p), [0, 1, 0], zero) : zero),
  'brow_outer_R.y': (p) => (p[0] < 0 ? mixed(mirror(p), zero, [0, 1, 0]) : zero),
};

// Of one side; the parts of the eyes are made side by side.
const aroundEye = (angles) => (p) => minus(turned(p, EYE, angles), p);
const left = (name, angles) => ({ [`${name}Left`]: aroundEye(angles) });
export const upperLidShapes = {
  ...left('eyeBlink', { pitch: BLINK }), ...left('eyeWide', { pitch: WIDE }), ...left('eyeLookDown', { pitch: 10 }),
  ...left('eyeLookUp', { pitch: -9 }), ...left('eyeSquint', { pitch: 8 }),
};
export const lowerLidShapes = { ...left('eyeBlink', { pitch: LOWER_BLINK }), ...left('eyeSquint', { pitch: SQUINT }) };
export const eyeShapes = Object.assign({}, ...Object.entries(LOOK).map(([way, angles]) => left(`eyeLook${way}`, angles)));

// The fields of a left part for its mirror image.
export const onTheRight = (fields) => Object.fromEntries(Object.entries(fields).map(([name, field]) =>
  [name.replace(/Left$/, 'Right'), (p, jaw) => mirror(field(mirror(p), jaw))]));
