// The three decoders beside each other: C++ (core/wire), JavaScript (tools/host) and C on an AVR
// (tools/firmware). Each makes lines of a stream, one a message and one for its counts, in one
// canonical form: compact JSON, floats as strings of their 32 bits.
import assert from 'node:assert/strict';
import { execFileSync } from 'node:child_process';
import { readFileSync, readdirSync } from 'node:fs';
import { test } from 'node:test';
import { fileURLToPath } from 'node:url';

import { Decoder } from '../../../tools/host/decoder/decoder.js';

const { FACEWIRE_WIRE_VECTORS, FACEWIRE_SIM_READER, FACEWIRE_READER, FACEWIRE_SMALL_READER } = process.env;
const folder = fileURLToPath(new URL('../../core/wire/vectors/', import.meta.url));
const vectors = readdirSync(folder).filter((f) => f.endsWith('.bin')).map((f) => f.slice(0, -4));
const path = (name) => `${folder}${name}.bin`;
const run = (program, ...args) => execFileSync(program, args, { encoding: 'utf8' });

function bitsOf(number) {
  const view = new DataView(new ArrayBuffer(4));
  view.setFloat32(0, number);
  return `"${view.getUint32(0).toString(16).padStart(8, '0')}"`;
}

// Of a vector's .json, whose floats alone have a point or an exponent.
function linesOfJson(text) {
  const lines = text.split('\n').filter((line) => /^ {4}\{|^ {2}"stats"/.test(line));
  return lines.map((line) => line.trim().replace(/^"stats": |,$/g, '')
    .replace(/"(?:[^"\\]|\\.)*"|[^"\s]+|\s+/g, (token) => {
      if (token.startsWith('"')) return token;
      return token.trim().replace(/-?\d+(\.\d+)?(e[-+]?\d+)?/g, (n) => (/[.e]/.test(n) ? bitsOf(Number(n)) : n));
    }));
}

const cplusplus = (name) => linesOfJson(run(FACEWIRE_WIRE_VECTORS, path(name)));

// Numbers of JavaScript do not say which of them were floats.
const FLOATS = {
  bone: ['rest_cm'], channel: ['neutral', 'min', 'max'], acknowledgement: ['measure'], command: ['value'],
};

function canonical(value, float) {
  if (typeof value === 'number') return float ? bitsOf(value) : String(value);
  if (typeof value === 'bigint') return String(value);
  if (typeof value === 'string') return `"${value.replace(/["\\]/g, '\\$&')}"`;
  if (Array.isArray(value)) return `[${value.map((v) => canonical(v, float)).join()}]`;
  const floats = FLOATS[value.type] ?? [];
  return `{${Object.entries(value).map(([k, v]) => `"${k}":${canonical(v, floats.includes(k))}`).join()}}`;
}

function javascript(name) {
  const decoder = new Decoder();
  const messages = decoder.push(new Uint8Array(readFileSync(path(name))));
  return [...messages, decoder.stats].map((m) => canonical(m));
}

const avr = (name, program = FACEWIRE_READER) =>
  run(FACEWIRE_SIM_READER, program, path(name)).trimEnd().split('\n');

test('every vector gives the lines of its .json in C++, JavaScript and on an AVR', () => {
  assert.ok(vectors.length > 80);
  for (const name of vectors) {
    const expected = linesOfJson(readFileSync(`${folder}${name}.json`, 'utf8'));
    assert.deepEqual(cplusplus(name), expected, `${name}, C++`);
    assert.deepEqual(javascript(name), expected, `${name}, JavaScript`);
    assert.deepEqual(avr(name), expected, `${name}, AVR`);
  }
});

test('one corrupted stream gives the same text in all three', () => {
  const expected = readFileSync(new URL('bad_line.txt', import.meta.url), 'utf8');
  for (const decoder of [cplusplus, javascript, avr]) {
    assert.equal(`${decoder('bad_line').join('\n')}\n`, expected, decoder.name);
  }
});

// Such a decoder knows that a frame was sound, its number, its type and how long it was, whatever it kept of it.
test('with the memory of the receiver, an AVR leaves out what is too long for it and nothing else', () => {
  let unread = 0;
  for (const name of vectors) {
    const [all, small] = [avr(name), avr(name, FACEWIRE_SMALL_READER)];
    const [counts, few] = [all.pop(), small.pop()].map((line) => JSON.parse(line));
    const left = small.filter((line) => /"type":\d/.test(line)).map((line) => JSON.parse(line));
    unread += left.length;

    // What was read is the same, in the same order, and what was not is longer or has more servos.
    const read = small.filter((line) => !/"type":\d/.test(line));
    const numbers = new Set(left.map((frame) => frame.sequence));
    assert.deepEqual(read, all.filter((line) => !numbers.has(JSON.parse(line).sequence)), name);
    for (const { type, bytes } of left) assert.ok(bytes > 161 || type === 0x15, `${name}: ${type}, ${bytes} bytes`);

    const sound = ({ frames, unknown, malformed, unread: not = 0 }) => frames + unknown + malformed + not;
    assert.equal(sound(few), sound(counts), name);
    for (const key of ['versions', 'crc_errors', 'cobs_errors', 'truncated', 'overflows', 'lost', 'restarts', 'resyncs']) {
      assert.equal(few[key], counts[key], `${name}: ${key}`);
    }
  }
  assert.ok(unread > 5);
});
