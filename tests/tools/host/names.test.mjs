import assert from 'node:assert/strict';
import { readFileSync } from 'node:fs';
import { test } from 'node:test';

import { matchBone, matchHumanoid, matchShape } from '../../../tools/host/character/names.js';

// The cases that C++ passes, too.
const cases = JSON.parse(readFileSync(process.env.FACEWIRE_NAME_CASES));

// As the cases have it.
const shape = (found) => found && {
  match: found.match, signals: Object.fromEntries(found.signals.map(({ signal, gain }) => [signal, gain])),
  ...(found.signals[0].half && { half: found.signals[0].half }),
};
const bone = (found) => found && Object.fromEntries(Object.entries(found).filter(([, value]) => value !== null));

for (const [list, match] of [['shapes', (name) => shape(matchShape(name))], ['bones', (name) => bone(matchBone(name))],
  ['humanoid', (name) => bone(matchHumanoid(name))]]) {
  test(`${list} mean what the cases say`, () => {
    assert.ok(cases[list].length > 5);
    for (const { name, is } of cases[list]) assert.deepEqual(match(name), is, name);
  });
}
