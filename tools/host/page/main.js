import { Character } from '../character/character.js';
import { Driver } from '../character/driver.js';
import { Studio } from '../character/studio.js';
import { COMMANDS, RESULTS, STATES, succeeded } from '../decoder/message.js';
import { Cast } from './cast.js';
import franck from './franck.bin';
import { Performer } from './landmarks.js';
import { Link } from './link.js';
import { Pace } from './pace.js';
import { Plot } from './plot.js';
import { Recording, Serial, Socket } from './sources.js';
import { ServiceStatus } from './status.js';
import { Takes } from './takes.js';
import { Values } from './values.js';

// The page: one link, one character, and what is to be seen of both.

const options = new URLSearchParams(location.hash.slice(1)); // #line=ws://...&pixels=all
const $ = (id) => document.getElementById(id);
const view = $('view');
const studio = new Studio(view);
const otto = new Character();
const link = new Link();
const values = new Values($('values'));
const plot = new Plot($('plot'), $('legend'));
const performer = new Performer($('landmarks'), $('performer-note'));
const service = new ServiceStatus($('service'));
const recording = new Recording(franck);

let character = null;
let driver = null;
let shown = null; // the values that the character stands at
let stale = true; // the picture does not show what it should

// --- who moves

// From now on `next` moves in the other's place, from neutral.
function show(next) {
  if (character) studio.scene.remove(character.root);
  character?.dispose?.();
  character = next;
  studio.scene.add(character.root);
  drive();
}
function drive() {
  character.neutral();
  driver = link.rig ? new Driver(character, link.rig) : null;
  shown = link.rig ? Float32Array.from(link.rig.channels, (c) => c.neutral) : null;
  if (driver) values.show(link.rig);
  cast.tell(character, driver);
  stale = true;
}
const cast = new Cast(otto, show);
show(otto);

// --- what comes over the line

link.onRig = () => {
  drive();
  plot.clear();
  choosePlotted();
};
const takes = new Takes(() => link.rig, () => ({ character, driver }), () => {
  driver.apply(shown);
  stale = true;
});
link.onPose = (pose, now) => {
  plot.add(performance.now(), now);
  takes.add(pose, values.gained(now), performance.now());
};
link.onLandmarks = (picture) => performer.show(picture);
function choosePlotted() {
  if (link.rig) plot.choose(link.rig.channels, values.plotted);
}
values.onPlotted = choosePlotted;

// Motion between two pictures of the camera, and the failsafe of every host: without poses hold, then ease to neutral.
const FOLLOW_MS = 22, HOLD_MS = 1000, EASE_MS = 700;
let silentSince = null, before = performance.now();
function move(now) {
  const passed = Math.min(100, now - before);
  before = now;
  if (!driver) return;
  const live = link.state === 'live' && link.values;
  silentSince = live ? null : silentSince ?? now;
  let target = null, within = FOLLOW_MS;
  if (live) target = values.gained(link.values);
  else if (now - silentSince > HOLD_MS) {
    target = link.rig ? link.rig.channels.map((c) => c.neutral) : null;
    within = EASE_MS;
  }
  if (!target || target.length !== shown.length) return;
  const part = 1 - Math.exp(-passed / within);
  let most = 0;
  shown.forEach((value, i) => {
    const step = part * (target[i] - value);
    most = Math.max(most, Math.abs(step));
    shown[i] = value + step;
  });
  if (most > 1e-5) {
    driver.apply(shown);
    stale = true;
  }
}

// --- what is to be seen

const LINE_TEXT = {
  off: 'no line', opening: 'opening', waiting: 'waiting for the device', silent: 'nothing comes', lost: 'line lost, trying again',
};
const MOODS = { tracking: 'good', searching: 'wait', holding: 'wait', easing: 'wait', resting: 'wait', starting: 'wait' };
function put(id, text) {
  if ($(id).textContent !== text) $(id).textContent = text;
}
function tell() {
  const live = link.state === 'live';
  const device = live ? STATES[link.pose.state] : null;
  // One attempt after the other is one state to who looks or listens.
  const lost = link.state === 'lost' || (link.state === 'opening' && link.problem !== '');
  const text = live ? (link.source === recording ? `recording: ${device}` : device) : LINE_TEXT[lost ? 'lost' : link.state];
  const paused = link.source === recording && recording.paused;
  put('state-text', paused ? 'recording paused' : text);
  $('state').dataset.mood = paused ? 'wait' : live ? MOODS[device] ?? 'bad' : !lost && ['opening', 'waiting'].includes(link.state) ? 'wait' : 'bad';
  put('rate', live ? link.rate.toFixed(0) : '–');
  put('latency', live && link.latency !== null ? Math.max(0, link.latency).toFixed(0) : '–');
  $('latency-title').title = link.latencyIsWhole ? 'from the picture to this page' : 'from the picture to the line';
  put('lost', String(link.lost));
  put('damaged', String(link.damaged));
  const problem = live ? '' : link.problem.replace(/\.$/, ''); // browsers' own are whole sentences
  $('notice').hidden = !problem;
  put('notice', problem && `${problem[0].toUpperCase()}${problem.slice(1)}.${lost ? ' Trying again.' : ''}`);
  const commands = link.source && link.source !== recording && ['waiting', 'live', 'silent'].includes(link.state);
  for (const button of document.querySelectorAll('[data-command]')) button.disabled = !commands;
  for (const [id, Kind] of [['play', Recording], ['serial', Serial], ['socket', Socket]]) {
    $(id).setAttribute('aria-pressed', String(link.source instanceof Kind));
  }
  link.landmarkRate = $('performer').open ? Performer.PICTURES : 0;
  const pose = ['live', 'silent'].includes(link.state) ? link.pose : null;
  performer.say(pose, !live, link.landmarksRefused && 'this device sends no landmarks');
  service.tell(link.status, pose);
  takes.tell();
  $('hint').hidden = link.source !== recording;
  if (document.hidden) return;
  if (link.values) values.update(link.values);
  plot.draw(performance.now());
}

const pace = options.get('pixels') === 'all' ? null : new Pace(); // for pictures, however slow
let frameBefore = performance.now(), drewBefore = false;
function frame(now) {
  move(now);
  if (character.update?.(Math.min(100, now - frameBefore) / 1000)) stale = true;
  if (pace?.frame(now, now - frameBefore, drewBefore && stale)) resize();
  frameBefore = now;
  drewBefore = stale;
  if (stale) {
    studio.render();
    stale = false;
  }
  performer.draw(now);
  requestAnimationFrame(frame);
}
function resize() {
  const header = $('state').getBoundingClientRect().bottom - view.getBoundingClientRect().top;
  studio.resize(view.clientWidth, view.clientHeight, (pace?.scale ?? 1) * Math.min(2, window.devicePixelRatio || 1), header);
  stale = true;
}
new ResizeObserver(resize).observe(view);

// --- the view's own hands

const camera = { azimuth: 12, elevation: 3 };
function turn(azimuth, elevation) {
  camera.azimuth = Math.max(-75, Math.min(75, camera.azimuth + azimuth));
  camera.elevation = Math.max(-20, Math.min(40, camera.elevation + elevation));
  studio.look(camera.azimuth, camera.elevation);
  stale = true;
}
turn(0, 0);
view.onpointerdown = (e) => view.setPointerCapture(e.pointerId);
view.onpointermove = (e) => { if (view.hasPointerCapture(e.pointerId)) turn(-0.3 * e.movementX, 0.2 * e.movementY); };
view.ondblclick = () => turn(-camera.azimuth, 3 - camera.elevation);
view.onkeydown = (e) => {
  const by = { ArrowLeft: [-5, 0], ArrowRight: [5, 0], ArrowUp: [0, 4], ArrowDown: [0, -4] }[e.key];
  if (!by) return;
  turn(...by);
  e.preventDefault();
};

// --- buttons

$('play').onclick = () => {
  if (link.source === recording) recording.paused = !recording.paused;
  else {
    recording.paused = false;
    link.open(recording);
  }
};
$('serial').onclick = async () => {
  try {
    link.open(new Serial(await navigator.serial.requestPort()));
  } catch {
    // Nothing was chosen: what plays goes on.
  }
};
if (!navigator.serial) {
  $('serial').disabled = true;
  $('serial').title = 'This browser has no Web Serial: Chromium, Chrome and Edge have it';
}
$('socket').onclick = () => {
  $('address').hidden = !$('address').hidden;
  if (!$('address').hidden) $('url').focus();
};
$('address').onsubmit = (e) => {
  e.preventDefault();
  try {
    link.open(new Socket(new URL($('url').value).href));
    $('address').hidden = true;
  } catch {
    $('url').setCustomValidity('An address like ws://HOST:PORT/line');
    $('url').reportValidity();
    $('url').setCustomValidity('');
  }
};
const asked = new Map(); // id -> the button's text
for (const button of document.querySelectorAll('[data-command]')) {
  button.onclick = () => {
    asked.set(link.command(COMMANDS[button.dataset.command]), button.textContent);
    put('answer', `${button.textContent} …`);
  };
}
link.onAcknowledgement = ({ id, result }) => {
  if (!asked.has(id)) return;
  put('answer', `${asked.get(id)}: ${succeeded(result) ? 'done' : (RESULTS[result] ?? 'failed').replaceAll('_', ' ')}`);
  asked.delete(id);
};

const themes = window.matchMedia('(prefers-color-scheme: light)');
const theme = (light) => { document.documentElement.dataset.theme = light ? 'light' : 'dark'; };
// What was chosen stays; a page opened as a file may have no memory.
const memory = (use) => { try { return use(localStorage); } catch { return null; } };
const chosen = memory((m) => m.getItem('theme'));
theme(chosen ? chosen === 'light' : themes.matches);
themes.onchange = () => { if (!memory((m) => m.getItem('theme'))) theme(themes.matches); };
$('theme').onclick = () => {
  theme(document.documentElement.dataset.theme !== 'light');
  memory((m) => m.setItem('theme', document.documentElement.dataset.theme));
};

// --- a page that comes from `facewire serve` follows its line; any other begins with the recording

const wanted = options.get('line');
const own = location.protocol.startsWith('http') ? Object.assign(new URL('/line', location), { hash: '' }).href.replace(/^http/, 'ws') : null;
if (wanted ?? own) {
  $('url').value = wanted ?? own;
  link.open(new Socket(wanted ?? own));
} else {
  link.open(recording);
}
setInterval(() => {
  link.tick();
  // A web server that has no line: nobody asked for one.
  if (own && link.source?.url === own && link.state === 'lost' && link.openings === 0) link.open(recording);
  tell();
}, 100);
requestAnimationFrame(frame);
