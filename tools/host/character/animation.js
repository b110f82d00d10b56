import { AnimationClip, Group, NumberKeyframeTrack, QuaternionKeyframeTrack, VectorKeyframeTrack } from 'three';
import { GLTFExporter } from 'three/addons/exporters/GLTFExporter.js';
import { clone } from 'three/addons/utils/SkeletonUtils.js';

const METRES = 0.01; // characters are in centimetres, glTF in metres
const STILL = 1e-6;
const GAP_US = 200e3, EASE_US = 40e3; // so long a pose stays, and so long the way to the next takes then

const PARTS = [
  ['position', VectorKeyframeTrack, (node) => node.position.toArray()],
  ['quaternion', QuaternionKeyframeTrack, (node) => node.quaternion.toArray()],
  ['scale', VectorKeyframeTrack, (node) => node.scale.toArray()],
  ['morphTargetInfluences', NumberKeyframeTrack, (node) => node.morphTargetInfluences],
];

// A lost line, or a performer who was gone, leaves the character where it was until the next pose.
function held(frames) {
  return frames.flatMap((frame, i) => {
    const next = frames[i + 1];
    return next && next.t_us - frame.t_us > GAP_US ? [frame, { ...frame, t_us: next.t_us - EASE_US }] : [frame];
  });
}

// A recording as an animation of a character, whatever it is driven by: the character is moved through all frames, and what of
// its nodes moved becomes tracks. recorded: [{ t_us, values }]. Leaves the character at neutral.
//
//   model   a copy of the character at neutral, in metres
//   clip    its AnimationClip, named as asked; times in seconds
export function animate(character, driver, recorded, name) {
  const frames = held(recorded);
  character.neutral();
  character.update?.(0);
  const nodes = [];
  character.root.traverse((node) => nodes.push(node));
  const copy = clone(character.root), copies = [];
  copy.traverse((node) => copies.push(node));
  // The loader makes names simpler than they are in the file.
  for (const node of copies) node.name = node.userData.name ?? node.name;
  const model = new Group();
  model.name = name;
  model.scale.setScalar(METRES);
  model.add(copy);

  const kept = nodes.flatMap((node, i) => PARTS.flatMap(([part, Track, read]) => (node[part]?.length === 0 || !node[part] ? []
    : [{ path: `${copies[i].uuid}.${part}`, Track, read: () => read(node), rest: [...read(node)], keys: null }])));
  frames.forEach(({ values }, n) => {
    driver.apply(values);
    character.update?.(0);
    for (const track of kept) {
      const now = track.read(), { rest } = track;
      if (!track.keys) {
        if (rest.every((v, k) => Math.abs(now[k] - v) <= STILL)) continue;
        track.keys = new Float32Array(frames.length * rest.length);
        for (let before = 0; before < n; ++before) track.keys.set(rest, before * rest.length);
      }
      track.keys.set(now, n * rest.length);
    }
  });
  character.neutral();
  character.update?.(0);

  const times = frames.map(({ t_us }) => t_us / 1e6);
  const tracks = kept.filter(({ keys }) => keys).map(({ path, Track, keys }) => new Track(path, times, keys));
  return { model, clip: new AnimationClip(name, -1, tracks) };
}

// Such an animation as the bytes of a .glb (glTF 2.0): morph targets and nodes under the character's own names. In a browser.
export function glb({ model, clip }) {
  // A skin need not name its skeleton, and three names one bone of it, which may not be above all others.
  const withoutSkeletons = (writer) => ({ afterParse() { for (const skin of writer.json.skins ?? []) delete skin.skeleton; } });
  return new GLTFExporter().register(withoutSkeletons).parseAsync(model, { binary: true, animations: [clip], onlyVisible: false });
}
