/*! The meshopt decoder, of meshoptimizer: Copyright (C) 2016-2026, by Arseny Kapoulkine, MIT License */
import { LoadingManager, Object3D } from 'three';
import { VRMHumanoidLoaderPlugin, VRMLoaderPlugin } from '@pixiv/three-vrm';
import { MeshoptDecoder } from 'three/examples/jsm/libs/meshopt_decoder.module.js';
import { GLTFLoader } from 'three/examples/jsm/loaders/GLTFLoader.js';

import { LoadedCharacter } from './loaded.js';

// What a person can do about a file that is no character; the message is one sentence that begins with the file's name.
export class BadCharacter extends Error {}

const RIGHT = '.glb, .gltf and .vrm are right';
const COMPRESSED = new Map([
  ['KHR_draco_mesh_compression', 'its meshes are compressed by Draco, which this page does not read: export it without compression, or with meshopt'],
  ['KHR_texture_basisu', 'its textures are KTX2 (Basis Universal), which this page does not read: export it with PNG, JPEG or WebP'],
]);
const isModel = ({ name }) => /\.(glb|gltf|vrm)$/i.test(name);
const baseName = (uri) => decodeURIComponent(uri).replace(/[?#].*$/, '').replace(/^.*[/\\]/, '').toLowerCase();
const listed = (names) => names.join(', ').replace(/, ([^,]*)$/, ' and $1');

// A face needs no legs: VRM asks for a whole body, and three-vrm refuses a file without. It looks from a head, so there is a
// stand-in for one, which is not of the file.
class AnyBones extends VRMHumanoidLoaderPlugin {
  _ensureRequiredBonesExist(bones) {
    bones.head ??= { node: new Object3D() };
    return bones;
  }
}

// The JSON of a .glb, .vrm or .gltf; throws BadCharacter where the container or the JSON is wrong.
function jsonOf(bytes, name) {
  const bad = (what) => new BadCharacter(`${name} ${what}`);
  const view = new DataView(bytes);
  let text = new Uint8Array(bytes);
  if (bytes.byteLength >= 4 && view.getUint32(0, true) === 0x46546c67) { // "glTF"
    if (bytes.byteLength < 20) throw bad(`is cut off after ${bytes.byteLength} bytes`);
    const version = view.getUint32(4, true), length = view.getUint32(8, true), chunk = view.getUint32(12, true);
    if (version !== 2) throw bad(`is a .glb of version ${version}; version 2 would be right`);
    if (length > bytes.byteLength) throw bad(`is cut off: ${bytes.byteLength} of ${length} bytes are there`);
    if (view.getUint32(16, true) !== 0x4e4f534a || chunk > length - 20) throw bad('is damaged: its first chunk is not the JSON that has to be there');
    text = text.subarray(20, 20 + chunk);
  }
  let json;
  try {
    json = JSON.parse(new TextDecoder('utf-8', { fatal: true }).decode(text));
  } catch {
    throw bad(text.byteOffset > 0 ? 'is damaged: its JSON cannot be read' : `is no glTF; ${RIGHT}`);
  }
  if (!/^2\./.test(json?.asset?.version)) throw bad('does not say that it is glTF 2 (asset.version)');
  return json;
}

function check(json, name, beside) {
  for (const [extension, what] of COMPRESSED) {
    const list = extension.startsWith('KHR_draco') ? json.extensionsUsed : json.extensionsRequired;
    if (list?.includes(extension)) throw new BadCharacter(`${name} cannot be shown: ${what}`);
  }
  const uris = [...(json.buffers ?? []), ...(json.images ?? [])].map(({ uri }) => uri).filter((uri) => uri && !uri.startsWith('data:'));
  const missing = [...new Set(uris.filter((uri) => !beside.has(baseName(uri))).map((uri) => decodeURIComponent(uri)))];
  if (missing.length > 0) throw new BadCharacter(`${name} needs ${listed(missing)} beside it: drop them together, or the folder that they are in`);
  if (!json.meshes?.length) throw new BadCharacter(`${name} has no mesh: there is nothing to show`);
}

// The character in files that were dropped together (File, or anything with `name` and `arrayBuffer()`): a .glb or .vrm alone, or a
// .gltf with what it refers to. Throws BadCharacter; nothing is left of what did not load.
export async function loadCharacter(files) {
  const models = files.filter(isModel);
  if (models.length === 0) throw new BadCharacter(`${files[0]?.name ?? 'That'} is no character: ${RIGHT}`);
  if (models.length > 1) throw new BadCharacter(`${listed(models.map((m) => m.name))} are ${models.length} characters: one at a time`);
  const [{ name }] = models, bytes = await models[0].arrayBuffer();
  const beside = new Map(files.map((file) => [file.name.toLowerCase(), file])), urls = new Map();
  const manager = new LoadingManager();
  manager.setURLModifier((url) => {
    const file = /^(data|blob):/.test(url) ? null : beside.get(baseName(url));
    if (!file) return url;
    if (!urls.has(file)) urls.set(file, URL.createObjectURL(file));
    return urls.get(file);
  });
  const loader = new GLTFLoader(manager).setMeshoptDecoder(MeshoptDecoder);
  const bones = { autoUpdateHumanBones: false };
  loader.register((parser) => new VRMLoaderPlugin(parser, { ...bones, humanoidPlugin: new AnyBones(parser, bones) }));
  try {
    check(jsonOf(bytes, name), name, beside);
    return new LoadedCharacter(await loader.parseAsync(bytes, ''), name);
  } catch (error) {
    if (error instanceof BadCharacter) throw error;
    throw new BadCharacter(`${name} ${/^has /.test(error.message) ? error.message : `is damaged: ${error.message}`}`);
  } finally {
    for (const url of urls.values()) URL.revokeObjectURL(url);
  }
}
