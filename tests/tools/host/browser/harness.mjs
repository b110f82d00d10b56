import { spawn } from 'node:child_process';
import { once } from 'node:events';
import { mkdtempSync, readFileSync, rmSync, writeFileSync } from 'node:fs';
import { createRequire } from 'node:module';
import { tmpdir } from 'node:os';
import { join } from 'node:path';
import { pathToFileURL } from 'node:url';

// A real browser (Debian's Chromium) with the built page, and the real service behind it. From the environment:
//   FACEWIRE_PAGE, FACEWIRE_BOARD   the built page's folder, and board.js as one script
//   FACEWIRE_ASSETS                 has playwright-core and the footage
//   FACEWIRE_PROGRAMS, FACEWIRE_SOURCE   the build's folder, the sources
//   FACEWIRE_SHOTS                  a folder that every screenshot is kept in, too, for people to look at

export const PATIENCE_MS = 120_000; // a busy machine that renders in software
const env = (name) => process.env[name] ?? (() => { throw new Error(`${name} is not set: run this by ctest`); })();
const { chromium } = createRequire(`${env('FACEWIRE_ASSETS')}/playwright-core/`)('./index.js');

export const PAGE = env('FACEWIRE_PAGE');
export const FILE = pathToFileURL(join(PAGE, 'index.html')).href;
export const ALL_PIXELS = '#pixels=all'; // else a slow computer gets a coarser picture, and pictures cannot be compared
const VIEWPORT = { width: 704, height: 320 }; // the character gets 320 x 320
export const SMALL = { viewport: { width: 704, height: 160 } }; // where nobody looks at it, and a picture costs the more the larger it is

// A browser that is closed, with all that it wrote, when the test file ends: `after(() => browser.close())`.
export class Browser {
  static async start() {
    const home = mkdtempSync(join(tmpdir(), 'facewire-browser-'));
    const browser = new Browser();
    browser.home = home;
    browser.chromium = await chromium.launch({
      executablePath: '/usr/bin/chromium',
      chromiumSandbox: process.getuid() !== 0,
      args: ['--use-angle=swiftshader', '--enable-unsafe-swiftshader', '--ignore-gpu-blocklist'],
      env: { ...process.env, HOME: home, XDG_CONFIG_HOME: home, XDG_CACHE_HOME: home },
      timeout: PATIENCE_MS,
    });
    return browser;
  }
  async close() {
    await this.chromium.close();
    rmSync(this.home, { recursive: true, force: true });
  }

  // The page, opened; `board`: with a stand-in at its serial port. What it asked for and complained of is in `requests` and
  // `complaints`.
  async open(url = FILE + ALL_PIXELS, { board = false, viewport = VIEWPORT, theme = 'dark', ...more } = {}) {
    const context = await this.chromium.newContext({ viewport, colorScheme: theme, acceptDownloads: true, ...more });
    if (board) await context.addInitScript({ path: env('FACEWIRE_BOARD') });
    const page = await context.newPage();
    page.setDefaultTimeout(PATIENCE_MS);
    const requests = [], complaints = [];
    page.on('request', (request) => { if (!/^(data|blob):/.test(request.url())) requests.push(request.url()); });
    page.on('console', (message) => { if (['error', 'warning'].includes(message.type())) complaints.push(message.text()); });
    page.on('pageerror', (error) => complaints.push(error.message));
    await page.goto(url);
    return new Page(page, requests, complaints);
  }
}

let shots = 0;
export class Page {
  constructor(page, requests, complaints) { Object.assign(this, { page, requests, complaints }); }

  close() { return this.page.context().close(); }
  text(id) { return this.page.locator(`#${id}`).textContent(); }
  // A figure of the page, as a number; NaN while there is none.
  async figure(id) { return Number.parseFloat(await this.text(id)); }
  // Until the element's text fits.
  async shows(id, pattern) {
    const { source, flags } = new RegExp(pattern);
    await this.page.waitForFunction(([at, s, f]) => new RegExp(s, f).test(document.getElementById(at).textContent), [id, source, flags])
      .catch(async (error) => { throw new Error(`#${id} shows "${await this.text(id)}" and not ${pattern}: ${error.message}`); });
  }
  press(id) { return this.page.locator(`#${id}`).click(); }
  // What the list of values shows, in the channels' units, by their names.
  async values() {
    const meters = this.page.locator('[role=meter]');
    return new Map(await meters.evaluateAll((all) => all.map((bar) => [bar.getAttribute('aria-label'), Number(bar.getAttribute('aria-valuenow'))])));
  }
  // Files [name, bytes] over the page, then let go, as a hand does it.
  drop(...files) {
    return this.page.evaluate(async (all) => {
      const dataTransfer = new DataTransfer();
      for (const [name, base64] of all) dataTransfer.items.add(new File([Uint8Array.from(atob(base64), (c) => c.charCodeAt(0))], name));
      for (const type of ['dragenter', 'dragover', 'drop']) {
        document.getElementById('view').dispatchEvent(new DragEvent(type, { dataTransfer, bubbles: true, cancelable: true }));
      }
    }, files.map(([name, bytes]) => [name, bytes.toString('base64')]));
  }
  // Until the character has come to rest at what it was told: a pose comes within 40 ms, a step towards it is drawn in each
  // frame, however long that takes, and five are more than it needs.
  settled() {
    return this.page.evaluate(() => new Promise((resolve) => {
      const from = performance.now();
      let frames = 0;
      const look = () => (++frames > 5 && performance.now() - from > 600 ? resolve() : requestAnimationFrame(look));
      look();
    }));
  }
  // The picture of an element, or with null of all that the window shows, as bytes of a PNG.
  async shot(name, selector = '#view') {
    const png = await (selector ? this.page.locator(selector) : this.page).screenshot({ timeout: PATIENCE_MS, animations: 'disabled' });
    if (process.env.FACEWIRE_SHOTS) writeFileSync(join(process.env.FACEWIRE_SHOTS, `${String(++shots).padStart(2, '0')}-${name}.png`), png);
    return png;
  }
  // Where two pictures of the same size differ: the part of pixels, 0 to 1, that changed by more than `by` of 255, in each
  // of the regions { name: [left, top, right, bottom] }, which are parts of the picture.
  differences(before, after, regions, by = 24) {
    return this.page.evaluate(async ([a, b, where, limit]) => {
      const pixels = async (base64) => {
        const bitmap = await createImageBitmap(new Blob([Uint8Array.from(atob(base64), (c) => c.charCodeAt(0))]));
        const canvas = new OffscreenCanvas(bitmap.width, bitmap.height), g = canvas.getContext('2d');
        g.drawImage(bitmap, 0, 0);
        return g.getImageData(0, 0, bitmap.width, bitmap.height);
      };
      const one = await pixels(a), other = await pixels(b);
      return Object.fromEntries(Object.entries(where).map(([name, [left, top, right, bottom]]) => {
        let changed = 0, all = 0;
        for (let y = Math.round(top * one.height); y < bottom * one.height; ++y) {
          for (let x = Math.round(left * one.width); x < right * one.width; ++x, ++all) {
            const at = 4 * (y * one.width + x);
            const most = Math.max(...[0, 1, 2].map((k) => Math.abs(one.data[at + k] - other.data[at + k])));
            if (most > limit) ++changed;
          }
        }
        return [name, changed / all];
      }));
    }, [before.toString('base64'), after.toString('base64'), regions, by]);
  }
}

// A program in the background: `said(pattern)` waits for a line of its output or errors.
class Program {
  #output = '';
  #waiting = [];
  constructor(path, args) {
    this.process = spawn(path, args, { stdio: ['ignore', 'pipe', 'pipe'] });
    for (const stream of [this.process.stdout, this.process.stderr]) {
      stream.setEncoding('utf8').on('data', (text) => {
        this.#output += text;
        this.#waiting.forEach((look) => look());
      });
    }
    this.ended = once(this.process, 'exit');
    this.ended.then(() => this.#waiting.forEach((look) => look()));
  }
  said(pattern) {
    return new Promise((resolve, reject) => {
      const look = () => {
        const found = this.#output.match(pattern);
        if (found) resolve(found);
        else if (this.process.exitCode !== null) reject(new Error(`it ended with ${this.process.exitCode}: ${this.#output}`));
      };
      this.#waiting.push(look);
      look();
    });
  }
  async stop(signal = 'SIGTERM') {
    if (this.process.exitCode === null && this.process.signalCode === null) this.process.kill(signal);
    await this.ended;
  }
}

// The real service on the mock HAL, with the test footage before its camera, and `facewire serve` at its line. In a folder of
// its own; stop() ends both.
export class Service {
  constructor() {
    this.folder = mkdtempSync(join(tmpdir(), 'facewire-service-'));
    const source = env('FACEWIRE_SOURCE'), assets = env('FACEWIRE_ASSETS');
    writeFileSync(join(this.folder, 'facewire.toml'), `
[camera]
device = "replay"
[camera.replay]
file = "${assets}/footage/franck.mp4"
memory_mib = 150
loop = "ping-pong"
[tracker]
networks = "${assets}/networks"
[character]
rig = "${source}/app/share/otto.toml"
profile = "${source}/app/share/average.profile"
[neutral]
folder = "${this.folder}"
[host]
line = "pty:line"
[control]
socket = "control"
`);
  }
  async start() {
    this.service = new Program(join(env('FACEWIRE_PROGRAMS'), 'app/facewired'), ['--config', join(this.folder, 'facewire.toml'), '--fake']);
    await this.service.said(/ready/);
  }
  // A port of 0 is any that is free; the address is returned.
  async serve(port = 0) {
    this.server = new Program(join(env('FACEWIRE_PROGRAMS'), 'tools/facewire/facewire'),
      ['serve', join(this.folder, 'line'), '--web-port', String(port), '--page', PAGE]);
    const [address, found] = await this.server.said(/http:\/\/\S+:(\d+)\//);
    this.port = Number(found);
    return address;
  }
  async stop() {
    await this.server?.stop();
    await this.service?.stop();
    rmSync(this.folder, { recursive: true, force: true });
  }
}

export const recording = () => readFileSync(join(env('FACEWIRE_SOURCE'), 'tools/host/page/franck.bin'));
