// What Blender's tests read, into FOLDER: characters, and a recording whose values are known: make.mjs FOLDER
import { writeFileSync } from 'node:fs';
import { join } from 'node:path';

import { ARKIT } from '../../tools/host/character/shapes.js';
import { arkitCharacter, bonesCharacter } from '../tools/host/made_character.mjs';

const [folder] = process.argv.slice(2);
const put = (name, content) => writeFileSync(join(folder, name), content);
put('arkit.glb', arkitCharacter(ARKIT).glb());
put('spelled.glb', arkitCharacter(ARKIT.map((n) => `Face.${n.replace(/Left$/, '_L').replace(/Right$/, '_R')}`)).glb());
put('bones.glb', bonesCharacter().glb());
// Its mesh bound with a straight neck, and resting with a bent one and an open mouth.
const posed = bonesCharacter(), { nodes } = posed.json, rest = (name) => nodes.find((node) => node.name === name);
rest('Neck').rotation = [Math.sin(Math.PI / 18), 0, 0, Math.cos(Math.PI / 18)]; // 20 degrees of pitch
rest('Jaw').translation[1] -= 0.01;
put('posed.glb', posed.glb());

const header = ['frame', 't_us', 'age_us', 'state', 'jawOpen', 'eyeBlinkLeft', 'mouthSmileRight', 'unheard_of', 'neck.pitch', 'neck.yaw', 'neck.roll',
  'jaw.pitch', 'jaw.y'];
const frame = (i) => [i, 1000 + Math.round((1e6 * i) / 24), 0, 'tracking', i / 20, (i % 5) / 4, 1 - i / 20, 1, i, 2 * i, -i, i / 2, -i / 20];
put('take.csv', `${[header, ...Array.from({ length: 21 }, (_, i) => frame(i))].join('\n')}\n`);
// A second and more without a face: rows without values, as facewire retarget writes them.
const lost = (i) => [i, 1000 + Math.round((1e6 * i) / 24), 0, 'searching', ...header.slice(4).map(() => '')];
put('gap.csv', `${[header, frame(0), frame(1), ...Array.from({ length: 40 }, (_, i) => lost(i + 2)), frame(42)].join('\n')}\n`);
put('no_face.csv', `${[header, [0, 0, 0, 'searching', ...header.slice(4).map(() => '')]].join('\n')}\n`);
put('short.csv', `${[header, frame(0), '1,2'].join('\n')}\n`);
