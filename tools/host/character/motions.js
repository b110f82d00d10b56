// What a shape of ARKit's does to a bone of app/share/otto.toml at weight 1: degrees, or cm. The ranges are that rig's.
const bothSides = (rows) => rows.flatMap(([shape, part, kind, amount]) => [
  { shape: `${shape}Left`, part: `${part}_L`, kind, amount },
  { shape: `${shape}Right`, part: `${part}_R`, kind, amount: kind === 'yaw' ? -amount : amount },
]);

export const MOTIONS = [
  { shape: 'jawOpen', part: 'jaw', kind: 'pitch', amount: 22 },
  { shape: 'jawForward', part: 'jaw', kind: 'position_z', amount: 0.9 },
  { shape: 'jawLeft', part: 'jaw', kind: 'position_x', amount: 0.9 },
  { shape: 'jawRight', part: 'jaw', kind: 'position_x', amount: -0.9 },
  { shape: 'browInnerUp', part: 'brow_inner_L', kind: 'position_y', amount: 1 },
  { shape: 'browInnerUp', part: 'brow_inner_R', kind: 'position_y', amount: 1 },
  ...bothSides([
    ['eyeBlink', 'upper_lid', 'pitch', 45],
    ['eyeWide', 'upper_lid', 'pitch', -12],
    ['eyeSquint', 'lower_lid', 'pitch', -16],
    ['eyeLookUp', 'eye', 'pitch', -22],
    ['eyeLookDown', 'eye', 'pitch', 25],
    ['eyeLookOut', 'eye', 'yaw', 28],
    ['eyeLookIn', 'eye', 'yaw', -28],
    ['browDown', 'brow_inner', 'position_y', -0.8],
    ['browOuterUp', 'brow_outer', 'position_y', 1],
  ]),
];
