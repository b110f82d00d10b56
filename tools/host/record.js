// Records a line's bytes, for the page to play back: node record.js LINE FILE SECONDS [LANDMARKS]
// LINE is a serial port or what `facewired --fake` made; another program must not read it at the same time. SECONDS are
// the camera's, LANDMARKS how many pictures a second (8) show the performer, too.
import { closeSync, constants, createReadStream, createWriteStream, openSync, writeSync } from 'node:fs';

import { Decoder } from './decoder/decoder.js';
import { Encoder } from './decoder/encoder.js';
import { COMMANDS } from './decoder/message.js';

const [line, file, seconds, landmarks = 8] = process.argv.slice(2);
if (!(Number(seconds) > 0) || !(Number(landmarks) >= 0)) {
  console.error('usage: node record.js LINE FILE SECONDS [LANDMARKS]');
  process.exit(2);
}
const port = openSync(line, constants.O_RDWR | constants.O_NOCTTY);
const out = createWriteStream(file);
const encoder = new Encoder(), decoder = new Decoder();
let id = 0;
const ask = (code, value) => writeSync(port, encoder.command(++id, code, value));
const askLandmarks = () => ask(COMMANDS.landmarks, Number(landmarks));
ask(COMMANDS.describe_rig);
askLandmarks();
const asking = setInterval(askLandmarks, 1000);

let first = null;
const input = createReadStream(null, { fd: port, autoClose: false });
input.on('data', (bytes) => {
  out.write(bytes);
  const captured = decoder.push(bytes).findLast((m) => m.type === 'pose')?.captured_us;
  first ??= captured ?? null;
  if (captured === undefined || Number(captured - first) < 1e6 * seconds) return;
  clearInterval(asking);
  input.removeAllListeners('data');
  out.end(() => process.exit(0));
  closeSync(port);
});
