import assert from 'node:assert/strict';
import { readFileSync, readdirSync } from 'node:fs';
import { test } from 'node:test';
import { gzipSync } from 'node:zlib';

const folder = process.env.FACEWIRE_PAGE;
const read = (name) => readFileSync(`${folder}/${name}`);

test('the page weighs less than 1.5 MB compressed', () => {
  const bytes = readdirSync(folder).reduce((sum, name) => sum + gzipSync(read(name)).length, 0);
  assert.ok(bytes < 1_500_000, `${bytes} bytes`);
});

test('the page asks no other host for anything', () => {
  const html = read('index.html').toString();
  const wanted = [...html.matchAll(/(?:src|href)="([^"]*)"/g)].map(([, at]) => at);
  assert.deepEqual(wanted, ['data:,', 'page.css', 'page.js']);
  assert.doesNotMatch(read('page.css').toString(), /url\(|@import/);
});

test('the page runs as a file: a classic script, no modules to load', () => {
  assert.match(read('index.html').toString(), /<script src="page.js"><\/script>/);
  assert.doesNotMatch(read('page.js').toString().slice(0, 2000), /^\s*(import|export)\b/m);
});

test('the licences of what is built in are in it', () => {
  const script = read('page.js').toString();
  assert.match(script, /@license[\s\S]{0,80}Three\.js Authors[\s\S]{0,60}MIT/);
  assert.match(script, /@pixiv\/three-vrm[\s\S]{0,120}pixiv Inc\.[\s\S]{0,80}MIT License/);
  assert.match(script, /meshoptimizer[\s\S]{0,60}Arseny Kapoulkine[\s\S]{0,20}MIT License/);
});
