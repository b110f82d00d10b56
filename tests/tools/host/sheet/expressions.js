// Faces to judge the character by: shapes of ARKit at weights, `neck` in degrees. `both('eyeBlink')` is its two sides.

const both = (name, weight = 1) => ({ [`${name}Left`]: weight, [`${name}Right`]: weight });
const look = (way, weight = 1) => (way === 'Left' ? { eyeLookOutLeft: weight, eyeLookInRight: weight }
  : way === 'Right' ? { eyeLookInLeft: weight, eyeLookOutRight: weight } : both(`eyeLook${way}`, weight));

export const EXPRESSIONS = {
  neutral: {},
  blink: both('eyeBlink'),
  wink: { eyeBlinkLeft: 1, mouthSmileLeft: 0.6, cheekSquintLeft: 0.7 },
  wide: both('eyeWide'),
  squint: both('eyeSquint'),
  'look left': look('Left'),
  'look right': look('Right'),
  'look up': look('Up'),
  'look down': look('Down'),
  'jaw a little': { jawOpen: 0.3 },
  'jaw wide': { jawOpen: 1 },
  smile: both('mouthSmile'),
  'smile with teeth': { ...both('mouthSmile', 0.9), ...both('mouthUpperUp', 0.5), ...both('mouthLowerDown', 0.4), ...both('cheekSquint', 0.7) },
  pucker: { mouthPucker: 1 },
  funnel: { mouthFunnel: 1, jawOpen: 0.2 },
  frown: both('mouthFrown'),
  sneer: { ...both('noseSneer'), ...both('mouthUpperUp', 0.5) },
  'brows up': { browInnerUp: 1, ...both('browOuterUp') },
  'brows down': both('browDown'),
  'inner brows up': { browInnerUp: 1 },
  puff: { cheekPuff: 1, ...both('mouthPress', 0.5) },
  tongue: { tongueOut: 1, jawOpen: 0.55 },
  'mouth left': { mouthLeft: 1 },
  'mouth right': { mouthRight: 1, jawRight: 0.5 },
  turned: { neck: { yaw: 30 } },
  nodded: { neck: { pitch: 18 } },
  tilted: { neck: { roll: 16 } },
  laughing: { ...both('mouthSmile'), jawOpen: 0.55, ...both('mouthUpperUp', 0.4), ...both('eyeSquint', 0.7), ...both('cheekSquint'), ...both('browOuterUp', 0.3) },
  surprised: { ...both('eyeWide'), browInnerUp: 1, ...both('browOuterUp'), jawOpen: 0.7, mouthFunnel: 0.3 },
  angry: { ...both('browDown'), ...both('eyeSquint', 0.6), ...both('mouthFrown', 0.6), ...both('mouthPress', 0.6), ...both('noseSneer', 0.6) },
  sad: { browInnerUp: 1, ...both('mouthFrown', 0.9), ...look('Down', 0.3), ...both('eyeBlink', 0.25), mouthShrugLower: 0.5 },
  kiss: { mouthPucker: 1, ...both('eyeBlink'), neck: { roll: -8 } },
};
