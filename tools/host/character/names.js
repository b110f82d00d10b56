import bones from '../../names/bones.json';
import shapes from '../../names/shapes.json';

// What names of shapes and bones mean: the rules of `facewire rig import`, with the same tables (tools/names), for
// characters that others made.

export const ARKIT = shapes.arkit;

// How sure a match is, the surest first: ARKit's own name; written otherwise; another name of the same motion; one shape for
// several of ARKit's, or the other way round; a whole expression.
export const MATCHES = ['exact', 'spelling', 'synonym', 'combined', 'emotion'];

const SIDES = { l: 'left', left: 'left', r: 'right', right: 'right' };

function wordsOf(name) {
  // "eyeBlink" and "FCLEye" both have a second word.
  return name.replace(/(?<=[a-z])(?=[A-Z])|(?<=[A-Z])(?=[A-Z][a-z])/g, ' ')
    .replace(/[A-Z]/g, (c) => c.toLowerCase()).split(/[_\-. ]/).filter(Boolean);
}

function withoutNamespace(name) {
  const bare = name.slice(Math.max(name.lastIndexOf(':'), name.lastIndexOf('|')) + 1);
  const dot = bare.lastIndexOf('.');
  if (dot < 1) return bare;
  const behind = bare.slice(dot + 1), words = wordsOf(behind);
  // "eye.L" and Blender's "eye.001" keep what is before the dot, "Face.eye_L" what is behind it.
  return /^[0-9]*$/.test(behind) || (words.length === 1 && Object.hasOwn(SIDES, words[0])) ? bare : behind;
}

// "mixamorig:LeftEye", "eye.L" and "J_Adj_L_FaceEye" as small words and a side: 'left', 'right' or null.
export function takeApart(name) {
  const words = wordsOf(withoutNamespace(name));
  // The last side counts: "eyeLookInLeft". A name that is nothing but a side stays a name.
  for (let i = words.length; words.length > 1 && i-- > 0;) {
    if (Object.hasOwn(SIDES, words[i])) return { side: SIDES[words.splice(i, 1)[0]], words };
  }
  const ending = words.at(-1)?.match(/^(.+)(left|right)$/);
  if (ending) words[words.length - 1] = ending[1];
  return { words, side: ending?.[2] ?? null };
}

const TAKEN_APART = ARKIT.map((name) => {
  const { words, side } = takeApart(name);
  return { name, joined: words.join(''), side };
});

// The shape of this name and side; or both sides of it; or one side of a shape that has none.
function findArkit(joined, side, match) {
  const shape = TAKEN_APART.find((a) => a.joined === joined && a.side === side);
  if (shape) return { match, signals: [{ signal: shape.name, gain: 1, half: null }] };
  // jawLeft and jawRight are opposites, no halves of a jaw.
  const opposites = ['jaw', 'mouth'].includes(joined);
  const signals = TAKEN_APART.filter((a) => a.joined === joined).flatMap((a) => {
    if (side === null) return opposites ? [] : [{ signal: a.name, gain: 0.5, half: null }];
    return a.side === null ? [{ signal: a.name, gain: 1, half: side }] : [];
  });
  return signals.length > 0 ? { match: 'combined', signals } : null;
}

const own = (table, key) => (Object.hasOwn(table, key) ? table[key] : null);

function find({ words, side }) {
  const joined = words.join('');
  const spelled = findArkit(joined, side, 'spelling');
  if (spelled) return spelled;
  const synonym = own(shapes.synonyms, joined);
  if (synonym) return findArkit(synonym, side, 'synonym');
  const name = own(shapes.presetSynonyms, joined) ?? joined;
  const preset = shapes.presets.find((p) => p.name === name && (p.side ?? null) === side);
  if (!preset) return null;
  return { match: preset.match, signals: Object.entries(preset.signals).map(([signal, gain]) => ({ signal, gain, half: null })) };
}

// By the name of a morph target or VRM expression: { match, signals: [{ signal, gain, half }] }, what moves it and how far;
// `half` is the side that it is of a shape without sides. Null when the name says nothing.
export function matchShape(name) {
  if (ARKIT.includes(name)) return { match: 'exact', signals: [{ signal: name, gain: 1, half: null }] };
  // VRoid's names begin with the model's: M_F00_000_00_Fcl_EYE_Close_L.
  for (const part = takeApart(name); part.words.length > 0; part.words.shift()) {
    const found = find(part);
    if (found) return found;
    if (!shapes.fillers.includes(part.words[0])) return null;
  }
  return null;
}

const fits = (rule, words, joined) => Boolean(rule.words?.some((w) => words.includes(w)) || rule.parts?.some((p) => joined.includes(p))
  || rule.names?.includes(joined) || rule.last?.includes(words.at(-1)));

// By a bone's own name: { kind, side, landmark }, kind as in bones.json; null when the name does not say.
export function matchBone(name) {
  const { words, side } = takeApart(name);
  const joined = words.join('');
  if (fits(bones.helpers, words, joined)) return null;
  const height = Object.keys(bones.heights).find((h) => fits(bones.heights[h], words, joined)) ?? 'unknown';
  const rule = bones.rules.find((r) => fits(r, words, joined) && (!r.and || fits(r.and, words, joined))
    && (r.sided ?? (side !== null)) === (side !== null) && (r.heights ?? [height]).includes(height) && words.length <= (r.most_words ?? Infinity));
  if (!rule?.kind) return null;
  return { kind: rule.kind, side, landmark: rule.landmark ? (side ? `${side}_` : '') + rule.landmark : null };
}

// By VRM's name of a humanoid's bone; null for those outside the face.
export function matchHumanoid(name) {
  const role = own(bones.humanoid, name);
  return role && { kind: role.kind, side: role.side ?? null, landmark: null };
}

// The names that such bones have in app/share/otto.toml, and so in a driver: "eye_L", "lip_corner_R", "upper_lip".
export function partName({ kind, side, landmark }) {
  const place = kind === 'skin' ? landmark.replace(/^(left|right)_/, '').replace(/^mouth_corner$/, 'lip_corner') : kind;
  return side ? `${place}_${side === 'left' ? 'L' : 'R'}` : place;
}

// What `facewire rig import` makes of a name that a rig cannot have: no blanks and quotes, and `longest` characters.
export function rigName(name, longest) {
  return name.replace(/[^!-~ ]|["\\]/g, '').replace(/^ +/, '').replace(/_* +/g, '_').slice(0, longest);
}
