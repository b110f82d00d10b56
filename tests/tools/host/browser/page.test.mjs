import assert from 'node:assert/strict';
import { after, before, test } from 'node:test';

import { Browser, FILE } from './harness.mjs';

// The page as it comes, opened as a file: for everybody's eyes, hands and screens.

let browser;
before(async () => { browser = await Browser.start(); });
after(() => browser?.close());

const WAYS = [['desktop', 1280, 720], ['phone', 390, 844]].flatMap(([name, width, height]) =>
  ['dark', 'light'].map((theme) => ({ name: `${name}, ${theme}`, viewport: { width, height }, theme })));

for (const { name, viewport, theme } of WAYS) {
  test(`on a ${name}, it plays its recording, asks nobody for anything and fits`, async () => {
    const page = await browser.open(FILE, { viewport, theme });
    await page.shows('state-text', /^recording: tracking$/);
    await page.shows('rate', /^2\d$/);
    await page.shot(name.replace(', ', '-'), null);
    assert.ok(page.requests.every((url) => url.startsWith('file://')), page.requests.join(' '));
    assert.deepEqual(page.complaints, []);
    const [content, window] = await page.page.evaluate(() => [document.documentElement.scrollWidth, document.documentElement.clientWidth]);
    assert.ok(content <= window, `${content} px wide in ${window}`);
    assert.deepEqual(await page.page.evaluate(faintTexts), []);
    await page.close();
  });
}

test('every control is reached by the keyboard, has a name, and shows that it has the focus', async () => {
  const page = await browser.open();
  await page.shows('state-text', /^recording/);
  const wanted = await page.page.evaluate(() => {
    const shown = (e) => e.checkVisibility() && !e.disabled;
    const all = [...document.querySelectorAll('button, input, summary, [tabindex="0"]')].filter(shown);
    all.forEach((e, i) => { e.dataset.stop = i; });
    return all.length;
  });
  const reached = new Set(), plain = [], nameless = [];
  for (let i = 0; i < wanted + 5 && reached.size < wanted; ++i) {
    await page.page.keyboard.press('Tab');
    const at = await page.page.evaluate(() => {
      const e = document.activeElement;
      const label = e.getAttribute('aria-label') || e.labels?.[0]?.textContent || e.textContent || e.title;
      return { stop: e.dataset.stop, label: label.trim(), outline: getComputedStyle(e).outlineStyle, what: e.outerHTML.slice(0, 80) };
    });
    if (at.stop === undefined) continue;
    reached.add(at.stop);
    if (at.outline === 'none') plain.push(at.what);
    if (!at.label) nameless.push(at.what);
  }
  assert.deepEqual({ reached: reached.size, plain, nameless }, { reached: wanted, plain: [], nameless: [] });
  await page.close();
});

test('arrow keys turn the view, and the recording pauses', async () => {
  const page = await browser.open();
  await page.shows('state-text', /^recording: tracking$/);
  await page.press('play');
  await page.shows('state-text', /^recording paused$/);
  await page.settled();
  const before = await page.shot('before');
  await page.page.locator('#view').focus();
  for (let i = 0; i < 4; ++i) await page.page.keyboard.press('ArrowRight');
  await page.settled();
  const { all } = await page.differences(before, await page.shot('after'), { all: [0, 0, 1, 1] });
  assert.ok(all > 0.1, String(all));
  await page.close();
});

// In the browser: texts whose contrast with what they stand on is below 4.5, WCAG's AA; of disabled controls nothing is asked.
function faintTexts() {
  const parse = (colour) => {
    const g = new OffscreenCanvas(1, 1).getContext('2d');
    g.fillStyle = colour;
    g.fillRect(0, 0, 1, 1);
    const [r, gr, b, a] = g.getImageData(0, 0, 1, 1).data;
    return [r, gr, b, a / 255];
  };
  const light = ([r, g, b]) => [r, g, b].map((c) => c / 255).map((c) => (c <= 0.04045 ? c / 12.92 : ((c + 0.055) / 1.055) ** 2.4))
    .reduce((sum, c, i) => sum + c * [0.2126, 0.7152, 0.0722][i], 0);
  const ground = (e) => {
    for (let at = e; at; at = at.parentElement) {
      const colour = parse(getComputedStyle(at).backgroundColor);
      if (colour[3] > 0.7) return colour;
    }
    return parse(getComputedStyle(document.body).backgroundColor);
  };
  return [...document.querySelectorAll('aside *')].filter((e) => e.checkVisibility() && !e.closest(':disabled')
    && [...e.childNodes].some((n) => n.nodeType === Node.TEXT_NODE && n.textContent.trim()))
    .flatMap((e) => {
      const [one, other] = [light(parse(getComputedStyle(e).color)), light(ground(e))].sort((a, b) => b - a);
      const ratio = (one + 0.05) / (other + 0.05);
      return ratio < 4.5 ? [`"${e.textContent.trim().slice(0, 20)}": ${ratio.toFixed(2)}`] : [];
    });
}
