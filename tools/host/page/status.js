// How the device's service fares, from its status message: in words and figures.

const STATE_WORDS = ['starting', 'looking for a face', 'following a face', 'holding: the face was just lost', 'easing to neutral',
  'resting at neutral', 'stopped: an emergency stop holds', 'fault: camera or line is gone'];
const SILENCE_US = 3_500_000n; // by the device's clock; it comes once a second

// 75 -> '1 min 15 s': two units at most.
export function duration(seconds) {
  const units = [['d', 86400], ['h', 3600], ['min', 60], ['s', 1]];
  const from = units.findIndex(([, size]) => seconds >= size);
  let left = seconds;
  return units.slice(from < 0 ? -1 : from, from < 0 ? undefined : from + 2).map(([unit, size]) => {
    const count = Math.floor(left / size);
    left -= count * size;
    return `${count} ${unit}`;
  }).join(' ');
}

// The texts of one status, by the ids that they have on the page without 'service-'.
export function describe(status) {
  const ms = (us) => (us / 1000).toFixed(us < 10_000 ? 1 : 0);
  return {
    state: STATE_WORDS[status.state],
    uptime: duration(status.uptime_s),
    fps: (status.centi_fps / 100).toFixed(1),
    frames: String(status.frames),
    dropped: String(status.dropped),
    losses: String(status.losses),
    errors: String(status.link_errors),
    p50: ms(status.latency_p50_us),
    p99: ms(status.latency_p99_us),
  };
}

// Fills the elements of `root` whose ids begin with 'service-'.
export class ServiceStatus {
  #elements;

  constructor(root) { this.#elements = [...root.querySelectorAll('[id^="service-"]')]; }

  // The newest of each, or null. What is old beside the poses is not shown.
  tell(status, pose) {
    const fresh = status && pose && pose.captured_us - status.now_us <= SILENCE_US;
    const texts = fresh ? describe(status) : {};
    for (const element of this.#elements) {
      const text = texts[element.id.slice('service-'.length)] ?? '–';
      if (element.textContent !== text) element.textContent = text;
    }
  }
}
