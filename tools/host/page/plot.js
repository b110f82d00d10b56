const SECONDS = 10;
const COLOURS = 8; // --line-0 and on, in page.css

// What follows a number of a channel, by its kind.
export const UNITS = { parameter: '', position_x: ' cm', position_y: ' cm', position_z: ' cm', pitch: '°', yaw: '°', roll: '°' };
export const numberOf = (value, kind) => value.toFixed(UNITS[kind] === '°' ? 1 : 2).replace(/^-(0\.0+)$/, '$1') + UNITS[kind];

// The last ten seconds of some channels, each over its own range; gaps where nothing came.
export class Plot {
  #samples = []; // [ms, values]
  #lines = []; // [{ index, name, min, max, colour }]

  constructor(canvas, legend) {
    this.canvas = canvas;
    this.legend = legend;
  }

  choose(channels, names) {
    this.#lines = channels.flatMap((c, index) => (names.has(c.name) ? [{ ...c, index }] : []))
      .map((line, i) => ({ ...line, colour: `--line-${i % COLOURS}` }));
    this.legend.replaceChildren(...this.#lines.map((line) => {
      const [item, mark, name, now, range] = ['li', 'i', 'span', 'b', 'small'].map((tag) => document.createElement(tag));
      mark.style.background = `var(${line.colour})`;
      name.textContent = name.title = line.name;
      range.textContent = `${line.min}…${line.max}${UNITS[line.kind]}`;
      range.title = 'what the plot is high';
      line.now = now;
      item.append(mark, name, now, range);
      return item;
    }));
  }

  clear() { this.#samples = []; }

  add(now, values) {
    this.#samples.push([now, values]);
    while (now - this.#samples[0][0] > 1000 * SECONDS) this.#samples.shift();
  }

  draw(now) {
    const { canvas } = this;
    const ratio = window.devicePixelRatio || 1, width = canvas.clientWidth, height = canvas.clientHeight;
    if (canvas.width !== Math.round(width * ratio)) {
      canvas.width = Math.round(width * ratio);
      canvas.height = Math.round(height * ratio);
    }
    const g = canvas.getContext('2d');
    g.setTransform(ratio, 0, 0, ratio, 0, 0);
    g.clearRect(0, 0, width, height);
    const style = getComputedStyle(canvas);
    g.fillStyle = style.getPropertyValue('--edge');
    for (let s = 1; s < SECONDS; ++s) g.fillRect(Math.round((width * s) / SECONDS), 0, 1, height);
    g.fillStyle = style.getPropertyValue('--faint');
    g.font = '11px system-ui, sans-serif';
    g.textAlign = 'left';
    g.fillText(`${SECONDS} s ago`, 6, height - 5);
    g.textAlign = 'right';
    g.fillText('now', width - 6, height - 5);
    g.lineWidth = 1.6;
    g.lineJoin = 'round';
    const last = this.#samples.at(-1)?.[1];
    for (const { index, min, max, colour, kind, now: number } of this.#lines) {
      if (last) number.textContent = numberOf(last[index], kind);
      g.strokeStyle = style.getPropertyValue(colour);
      g.beginPath();
      let before = -Infinity;
      for (const [at, values] of this.#samples) {
        const x = width * (1 - (now - at) / (1000 * SECONDS));
        const y = 6 + (height - 28) * (1 - (values[index] - min) / (max - min || 1));
        if (at - before > 500) g.moveTo(x, y);
        else g.lineTo(x, y);
        before = at;
      }
      g.stroke();
    }
  }
}
