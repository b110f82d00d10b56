import { Character } from '../../../../tools/host/character/character.js';
import { Studio } from '../../../../tools/host/character/studio.js';
import { EXPRESSIONS } from './expressions.js';

// One picture of many expressions, and what a frame costs. Asked for by sheet.html#only=smile,frown&views=0,40&cell=240.

const wanted = new URLSearchParams(location.hash.slice(1));
const names = wanted.get('only')?.split(',') ?? Object.keys(EXPRESSIONS);
const views = (wanted.get('views') ?? '0,38').split(',').map(Number);
const cell = Number(wanted.get('cell') ?? 200);
const across = Math.max(1, Math.floor(innerWidth / cell / views.length)) * views.length;

const studio = new Studio(document.createElement('canvas'));
const otto = new Character();
studio.scene.add(otto.root);
studio.resize(cell, cell, 1);

const sheet = document.getElementById('sheet');
sheet.width = across * cell;
sheet.height = Math.ceil((names.length * views.length) / across) * cell;
const g = sheet.getContext('2d');
g.font = '12px system-ui, sans-serif';
g.fillStyle = '#e8e6e1';

const pose = ({ neck = {}, ...shapes }) => {
  otto.neutral();
  for (const [name, weight] of Object.entries(shapes)) otto.setShape(name, weight);
  for (const [axis, degrees] of Object.entries(neck)) otto.setBone('neck', axis, degrees);
};
names.flatMap((name) => views.map((azimuth) => [name, azimuth])).forEach(([name, azimuth], i) => {
  pose(EXPRESSIONS[name]);
  studio.look(azimuth, 3, Number(wanted.get('distance') ?? 66));
  studio.render();
  const x = (i % across) * cell, y = Math.floor(i / across) * cell;
  g.drawImage(studio.renderer.domElement, x, y, cell, cell);
  g.fillText(name, x + 6, y + 16);
});

// A frame's cost: triangles and calls, and its time at 640 x 480, waited for by reading a pixel.
if (wanted.has('time')) {
  studio.resize(640, 480, 1);
  studio.look(12, 3);
  const gl = studio.renderer.getContext(), pixel = new Uint8Array(4);
  const once = (weight) => {
    otto.setShape('mouthSmileLeft', weight);
    studio.render();
    gl.readPixels(0, 0, 1, 1, gl.RGBA, gl.UNSIGNED_BYTE, pixel);
  };
  once(0);
  const began = performance.now(), count = 12;
  for (let i = 0; i < count; ++i) once(i / count);
  const { calls, triangles } = studio.renderer.info.render;
  document.getElementById('figures').textContent =
    `${((performance.now() - began) / count).toFixed(0)} ms a frame, ${triangles} triangles, ${calls} calls`;
}
