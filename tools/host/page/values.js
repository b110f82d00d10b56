import { numberOf } from './plot.js';

// The list of the rig's channels: a bar and a number each, a tick for the plot, a gain for the character.

const GROUPS = [
  ['Head', /^(neck|head)/], ['Eyes', /^(eye|upper_lid|lower_lid)/], ['Brows', /^brow/], ['Jaw', /^jaw/],
  ['Mouth', /^(mouth|lip_|upper_lip|lower_lip|tongue)/], ['Cheeks and nose', /^(cheek|nose)/], ['Other', /./],
];
const PLOTTED = ['jawOpen', 'mouthSmileLeft', 'eyeBlinkLeft', 'neck.yaw'];

const make = (tag, attributes = {}, ...children) => {
  const element = Object.assign(document.createElement(tag), attributes);
  element.append(...children);
  return element;
};

export class Values {
  gains = new Map(); // channel name -> factor of what it is away from neutral
  plotted = new Set(PLOTTED);
  onPlotted = () => {};
  #element;
  #rows = [];
  #channels = [];

  constructor(element) { this.#element = element; }

  show(rig) {
    this.#channels = rig.channels;
    this.#rows = [];
    const groups = new Map(GROUPS.map(([title]) => [title, []]));
    rig.channels.forEach((channel, i) => {
      const [title] = GROUPS.find(([, pattern]) => pattern.test(channel.name));
      groups.get(title).push(this.#row(channel, i));
    });
    const filled = [...groups].filter(([, rows]) => rows.length > 0);
    this.#element.replaceChildren(...filled.map(([title, rows], i) =>
      make('details', { open: i < 2 }, make('summary', { textContent: `${title} (${rows.length})` }), ...rows)));
  }

  #row(channel, i) {
    const { name, min, max, neutral } = channel;
    const tick = make('input', { type: 'checkbox', checked: this.plotted.has(name), title: `Plot ${name}` });
    tick.setAttribute('aria-label', `Plot ${name}`);
    tick.onchange = () => {
      this.plotted[tick.checked ? 'add' : 'delete'](name);
      this.onPlotted();
    };
    const fill = make('i');
    const bar = make('div', { className: 'bar' }, fill);
    for (const [key, value] of [['role', 'meter'], ['aria-label', name], ['aria-valuemin', min], ['aria-valuemax', max]]) bar.setAttribute(key, value);
    const number = make('b'); // no <output>: screen readers would read out each of its changes
    const gain = make('input', { type: 'range', min: 0, max: 3, step: 0.1, value: this.gains.get(name) ?? 1 });
    gain.setAttribute('aria-label', `Gain of ${name}`);
    gain.oninput = () => {
      gain.title = `Gain ${gain.value}; double-click for 1`;
      this.gains.set(name, Number(gain.value));
    };
    gain.ondblclick = () => {
      gain.value = 1;
      gain.oninput();
    };
    gain.oninput();
    const span = max - min || 1;
    this.#rows[i] = { fill, bar, number, from: (neutral - min) / span, span, kind: channel.kind };
    const label = make('span', { textContent: name.replaceAll('_', ' ').replace('.', ' · '), title: name });
    return make('div', { className: 'value' }, make('label', {}, tick), label, bar, number, gain);
  }

  // What the character gets: each value's distance from neutral times its gain, within its range.
  gained(values) {
    return values.map((value, i) => {
      const { name, neutral, min, max } = this.#channels[i];
      return Math.min(max, Math.max(min, neutral + (this.gains.get(name) ?? 1) * (value - neutral)));
    });
  }

  update(values) {
    values.forEach((value, i) => {
      const row = this.#rows[i];
      if (row.shown === value) return;
      row.shown = value;
      const at = (value - this.#channels[i].min) / row.span;
      const low = Math.min(at, row.from);
      row.fill.style.transform = `translateX(${100 * low}%) scaleX(${Math.abs(at - row.from)})`;
      row.number.textContent = numberOf(value, row.kind);
      row.bar.setAttribute('aria-valuenow', value.toFixed(2));
      row.bar.setAttribute('aria-valuetext', row.number.textContent);
    });
  }
}
