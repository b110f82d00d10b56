import assert from 'node:assert/strict';
import { after, before, test } from 'node:test';

import { Browser, FILE, SMALL } from './harness.mjs';

// The page as it comes, opened as a file: for everybody's eyes, hands and screens. One page for all, because each takes seconds to
// begin; from where its recording is paused, nothing is drawn that nobody looks at.

let browser, page;
before(async () => {
  browser = await Browser.start();
  page = await browser.open(FILE, { reducedMotion: 'reduce' }); // no colour is on its way to another
});
after(() => browser?.close());

test('it plays its recording, asks nobody for anything, and says nothing to a screen reader that nobody can follow', async () => {
  await page.shows('state-text', /^recording: tracking$/);
  await page.shows('rate', /^2\d$/);
  assert.ok(page.requests.every((url) => url.startsWith('file://')), page.requests.join(' '));
  const said = await page.page.evaluate(spoken, 1500);
  assert.ok(said.length <= 2, said.join(' | '));
});

test('a button pauses the recording', async () => {
  await page.press('play');
  await page.shows('state-text', /^recording paused$/);
});

// A small phone, a phone, a tablet, a laptop and its twofold zoom.
for (const [width, height] of [[360, 740], [390, 844], [768, 1024], [1440, 900], [720, 450]]) {
  test(`in a window of ${width} x ${height} all of it fits, and is large enough to be hit`, async () => {
    await page.page.setViewportSize({ width, height });
    await page.settled();
    if (process.env.FACEWIRE_SHOTS) await page.shot(`${width}x${height}`, null);
    assert.deepEqual(await page.page.evaluate(misfits), []);
  });
}

for (const theme of ['dark', 'light']) {
  test(`texts and the plot's lines stand out from ${theme} paper`, async () => {
    await page.page.emulateMedia({ colorScheme: theme });
    await page.page.waitForFunction((t) => document.documentElement.dataset.theme === t, theme);
    if (process.env.FACEWIRE_SHOTS) await page.shot(theme, null);
    assert.deepEqual(await page.page.evaluate(faint), []);
  });
}

test('every control is reached by the keyboard, from the top down, has a name, and shows that it has the focus', async () => {
  const wanted = await page.page.evaluate(() => {
    const shown = (e) => e.checkVisibility() && !e.disabled;
    const all = [...document.querySelectorAll('button, input, summary, [tabindex="0"]')].filter(shown);
    all.forEach((e, i) => { e.dataset.stop = i; });
    return all.length;
  });
  const reached = [], plain = [], nameless = [];
  for (let i = 0; i < wanted + 5 && reached.length < wanted; ++i) {
    await page.page.keyboard.press('Tab');
    const at = await page.page.evaluate(() => {
      const e = document.activeElement;
      const label = e.getAttribute('aria-label') || e.labels?.[0]?.textContent || e.textContent || e.title;
      return { stop: Number(e.dataset.stop ?? -1), label: label.trim(), outline: getComputedStyle(e).outlineStyle, what: e.outerHTML.slice(0, 80) };
    });
    if (at.stop < 0) continue;
    reached.push(at.stop);
    if (at.outline === 'none') plain.push(at.what);
    if (!at.label) nameless.push(at.what);
  }
  const first = reached.indexOf(0), order = [...reached.slice(first), ...reached.slice(0, first)]; // Tab goes on from what was clicked
  assert.deepEqual({ order, plain, nameless }, { order: Array.from({ length: wanted }, (_, i) => i), plain: [], nameless: [] });
});

test('each value is a meter that tells its unit', async () => {
  const texts = await page.page.locator('[role=meter]')
    .evaluateAll((all) => all.map((e) => `${e.getAttribute('aria-label')} ${e.getAttribute('aria-valuetext')}`));
  assert.ok(texts.length > 60);
  for (const text of texts) assert.match(text, /^\S+ (-?\d+\.\d°|-?\d+\.\d\d( cm)?)$/);
});

test('arrow keys turn the view', async () => {
  await page.page.setViewportSize(SMALL.viewport);
  await page.settled();
  const before = await page.shot('before');
  await page.page.locator('#view').focus();
  for (let i = 0; i < 4; ++i) await page.page.keyboard.press('ArrowRight');
  await page.settled();
  const { all } = await page.differences(before, await page.shot('after'), { all: [0, 0, 1, 1] });
  assert.ok(all > 0.04, String(all)); // most of it is not the head
});

test('nothing went wrong on the way', () => assert.deepEqual(page.complaints, []));

// --- in the browser

// What its live regions say in so many ms.
function spoken(ms) {
  const said = [], watch = new MutationObserver((all) => said.push(...all.map(({ target }) => (target.closest ? target : target.parentElement).textContent)));
  const live = document.querySelectorAll('output, [role=status], [role=alert], [role=log], [role=timer], [aria-live]:not([aria-live=off])');
  for (const region of live) watch.observe(region, { subtree: true, childList: true, characterData: true });
  return new Promise((resolve) => { setTimeout(() => resolve(said), ms); });
}

// What is cut off, out of the window, beside the stage or in two lines where one is meant; and targets below 24 px, WCAG 2.5.8.
function misfits() {
  const wrong = [], is = (e) => (e.id ? `#${e.id}` : e.outerHTML.slice(0, 60));
  const { scrollWidth, clientWidth } = document.documentElement;
  if (scrollWidth > clientWidth) wrong.push(`${scrollWidth} px wide in ${clientWidth}`);
  const stage = document.querySelector('.stage').getBoundingClientRect();
  for (const e of document.querySelectorAll('header > *')) {
    const { left, right, bottom, height } = e.getBoundingClientRect();
    if (left < stage.left || right > stage.right || bottom > stage.bottom) wrong.push(`${is(e)} leaves the stage`);
    if (height > 44) wrong.push(`${is(e)} is ${height} px high`);
  }
  for (const e of document.querySelectorAll('button, input, summary')) {
    if (!e.checkVisibility()) continue;
    const { left, right, width, height } = (e.closest('.value label') ?? e).getBoundingClientRect();
    if (left < 0 || right > clientWidth) wrong.push(`${is(e)} from ${left} to ${right} in ${clientWidth}`);
    if (width < 24 || height < 24) wrong.push(`${is(e)} is ${width} x ${height}`);
  }
  return wrong;
}

// Texts whose contrast with what they stand on is below 4.5, and lines below 3, WCAG's AA; of disabled controls nothing is asked.
function faint() {
  const g = new OffscreenCanvas(1, 1).getContext('2d', { willReadFrequently: true }), known = new Map();
  const parse = (colour) => {
    if (!known.has(colour)) {
      g.clearRect(0, 0, 1, 1);
      g.fillStyle = colour;
      g.fillRect(0, 0, 1, 1);
      const [r, gr, b, a] = g.getImageData(0, 0, 1, 1).data;
      known.set(colour, [r, gr, b, a / 255]);
    }
    return known.get(colour);
  };
  const light = ([r, gr, b]) => [r, gr, b].map((c) => c / 255).map((c) => (c <= 0.04045 ? c / 12.92 : ((c + 0.055) / 1.055) ** 2.4))
    .reduce((sum, c, i) => sum + c * [0.2126, 0.7152, 0.0722][i], 0);
  const contrast = (a, b) => {
    const [one, other] = [light(parse(a)), light(parse(b))].sort((x, y) => y - x);
    return (one + 0.05) / (other + 0.05);
  };
  const root = getComputedStyle(document.documentElement), named = (name) => root.getPropertyValue(name).trim();
  const grounds = (e) => {
    for (let at = e; at; at = at.parentElement) {
      if (at.classList.contains('stage')) return [named('--glow'), named('--far')]; // from one to the other
      const colour = getComputedStyle(at).backgroundColor;
      if (parse(colour)[3] > 0.7) return [colour];
    }
    return [named('--paper')];
  };
  const texts = [...document.querySelectorAll('body *')].filter((e) => e.checkVisibility() && !e.closest(':disabled')
    && [...e.childNodes].some((n) => n.nodeType === Node.TEXT_NODE && n.textContent.trim()));
  return [
    ...texts.map((e) => [`"${e.textContent.trim().slice(0, 20)}"`, Math.min(...grounds(e).map((ground) => contrast(getComputedStyle(e).color, ground))), 4.5]),
    ...Array.from({ length: 8 }, (_, i) => [`line ${i}`, contrast(named(`--line-${i}`), named('--paper')), 3]),
  ].filter(([, ratio, least]) => ratio < least).map(([what, ratio]) => `${what}: ${ratio.toFixed(2)}`);
}
