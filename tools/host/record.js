// Records a line's bytes, for the page to play back: node record.js LINE FILE SECONDS
// LINE is a serial port or what `facewired --fake` made; another program must not read it at the same time.
import { closeSync, constants, createWriteStream, openSync, createReadStream, writeSync } from 'node:fs';

import { Encoder } from './decoder/encoder.js';
import { COMMANDS } from './decoder/message.js';

const [line, file, seconds] = process.argv.slice(2);
if (!(Number(seconds) > 0)) {
  console.error('usage: node record.js LINE FILE SECONDS');
  process.exit(2);
}
const port = openSync(line, constants.O_RDWR | constants.O_NOCTTY);
const out = createWriteStream(file);
createReadStream(null, { fd: port, autoClose: false }).pipe(out);
writeSync(port, new Encoder().command(1, COMMANDS.describe_rig));
setTimeout(() => {
  out.end(() => process.exit(0));
  closeSync(port);
}, 1000 * seconds);
