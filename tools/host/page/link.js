import { Decoder } from '../decoder/decoder.js';
import { Encoder } from '../decoder/encoder.js';
import { LandmarkCollector } from '../decoder/landmarks.js';
import { COMMANDS, RESULTS } from '../decoder/message.js';
import { RigCollector, valuesOf } from '../decoder/rig.js';
import { OscSpotter, SPEAKS_OSC } from './other_protocol.js';

export const SILENCE_MS = 500; // without a sound pose the device or the line is gone (core/wire/README.md)
const RETRY_MS = [500, 1000, 2000, 4000];
const EVERY_MS = 1000; // asks for what is missing, and pings

const median = (values) => (values.length ? [...values].sort((a, b) => a - b)[values.length >> 1] : null);

// A host's side of the line: opens its source, asks for the rig until it is complete, follows poses, notices silence and
// loss, opens again by itself. `clock` tells ms; tick() wants to be called some times a second.
//
//   state   'off' | 'opening' | 'waiting' (open, no rig or no pose yet) | 'live' | 'silent' | 'lost' (opens again by itself)
//   rig, values, pose, status   the latest of each, or null
export class Link {
  state = 'off';
  rig = null;
  values = null;
  pose = null;
  status = null;
  problem = ''; // why it could not be opened
  onRig = () => {};
  onPose = () => {};
  onAcknowledgement = () => {};
  onLandmarks = () => {}; // a picture of LandmarkCollector
  landmarkRate = 0; // of how many pictures a second they are wanted
  landmarksRefused = ''; // 'unknown' or 'refused' when the device will send none

  #source = null;
  #generation = 0; // of the source's callbacks: those of an earlier opening are deaf
  #decoder = new Decoder();
  #encoder = new Encoder();
  #osc = new OscSpotter();
  #collector = new RigCollector();
  #picture = new LandmarkCollector();
  #earlier = { damaged: 0, lost: 0 }; // of decoders before this one
  #clock;
  #lastPose = -Infinity;
  #lastAsked = -Infinity;
  #openings = 0;
  #retries = 0;
  #retryAt = Infinity;
  #id = 0;
  #pings = new Map(); // id -> when it was sent
  #landmarksAsked = 0;
  #best = null; // { roundTrip, offset }: the device's clock minus ours, ms
  #arrivals = []; // [{ at, captured }], each on its own clock, ms
  #delays = [];

  constructor(clock = () => performance.now()) { this.#clock = clock; }

  open(source) {
    this.close();
    this.#source = source;
    this.#openings = this.#retries = 0;
    this.problem = '';
    this.#earlier = { damaged: 0, lost: 0 };
    this.#forget();
    this.#start();
  }

  close() {
    ++this.#generation;
    this.#source?.close();
    this.#source = null;
    this.state = 'off';
  }

  get #now() { return this.#clock(); }
  // How often this source was there.
  get openings() { return this.#openings; }
  get source() { return this.#source; }
  get damaged() { return this.#earlier.damaged + this.#decoder.damaged; }
  get lost() { return this.#earlier.lost + this.#decoder.stats.lost; }

  // Poses a second by the camera's clock, because a busy browser takes several at once; of the last two seconds.
  get rate() {
    const recent = this.#arrivals.filter(({ at }) => this.#now - at <= 2000);
    const span = recent.length > 1 ? recent.at(-1).captured - recent[0].captured : 0;
    return span > 0 ? (1000 * (recent.length - 1)) / span : 0;
  }
  // From the picture to the values here, in ms, median of a second: measured where pings told the device's clock, else
  // up to the sending of the pose.
  get latency() { return median(this.#delays); }
  get latencyIsWhole() { return this.#best !== null; }

  // The id that its acknowledgement will have.
  command(code, value) {
    this.#id = (this.#id + 1) & 0xffff;
    this.#source?.send(this.#encoder.command(this.#id, code, value));
    return this.#id;
  }

  tick() {
    const now = this.#now;
    if (this.state === 'lost' && now >= this.#retryAt) this.#start();
    if (this.state === 'live' && now - this.#lastPose > SILENCE_MS) this.state = 'silent';
    const open = ['waiting', 'live', 'silent'].includes(this.state);
    if (open && now - this.#lastAsked >= EVERY_MS) {
      this.#lastAsked = now;
      if (!this.#collector.complete) this.command(COMMANDS.describe_rig);
      this.#pings.clear();
      this.#pings.set(this.command(COMMANDS.ping), now);
      this.#askLandmarks();
    }
  }

  // Asked for anew before five seconds have passed; a device that answers no is not asked again on this line.
  #askLandmarks() {
    if (this.landmarksRefused || (this.landmarkRate === 0 && this.#landmarksAsked === 0)) return;
    this.#landmarksAsked = this.landmarkRate;
    this.command(COMMANDS.landmarks, this.landmarkRate);
  }

  async #start() {
    const generation = ++this.#generation;
    const mine = () => generation === this.#generation;
    this.state = 'opening';
    this.#retryAt = Infinity;
    this.#newStream();
    try {
      await this.#source.open({
        bytes: (bytes) => { if (mine()) this.#take(bytes); },
        again: () => { if (mine()) this.#newStream(); },
        closed: () => { if (mine()) this.#lose('the line was closed'); },
      });
    } catch (error) {
      if (mine()) this.#lose(error.message);
      return;
    }
    if (!mine() || this.state !== 'opening') return;
    this.state = 'waiting';
    this.problem = '';
    ++this.#openings;
    this.#retries = 0;
    this.#lastAsked = -Infinity;
  }

  #lose(problem) {
    this.problem = problem;
    if (!this.#source.retry) {
      this.state = 'off';
      return;
    }
    this.state = 'lost';
    this.#retryAt = this.#now + RETRY_MS[Math.min(this.#retries++, RETRY_MS.length - 1)];
  }

  #newStream() {
    this.#osc = new OscSpotter();
    this.#earlier.damaged += this.#decoder.damaged;
    this.#earlier.lost += this.#decoder.stats.lost;
    this.#decoder = new Decoder();
    this.#encoder = new Encoder();
    this.#picture = new LandmarkCollector();
    this.#landmarksAsked = 0;
    this.landmarksRefused = '';
    this.#best = null;
  }

  #forget() {
    this.#decoder = new Decoder();
    this.#collector = new RigCollector();
    this.rig = this.values = this.pose = this.status = null;
    this.#arrivals = [];
    this.#delays = [];
  }

  #take(bytes) {
    if (this.state === 'waiting' && !this.rig && this.#osc.notices(bytes)) this.problem = SPEAKS_OSC;
    for (const message of this.#decoder.push(bytes)) {
      if (message.type === 'pose') this.#takePose(message);
      else if (message.type === 'status') this.status = message;
      else if (message.type === 'acknowledgement') this.#takeAcknowledgement(message);
      else if (message.type === 'landmarks') this.#takeLandmarks(message);
      else if (this.#collector.add(message)) this.#takeRig();
    }
  }

  #takeRig() {
    if (!this.#collector.complete || this.rig?.rig_id === this.#collector.rigId) return;
    this.rig = this.#collector.rig;
    this.problem = '';
    this.values = null;
    this.onRig(this.rig);
  }

  #takePose(pose) {
    if (!this.rig) return;
    const values = valuesOf(pose, this.rig);
    if (!values) {
      // The rig has changed: no motion on values that mean something else. Parts of the new one that have come stay.
      if (this.#collector.rigId === this.rig.rig_id) this.#collector = new RigCollector();
      return;
    }
    this.state = 'live';
    this.pose = pose;
    this.values = values;
    this.#lastPose = this.#now;
    const captured = Number(pose.captured_us) / 1000;
    this.#arrivals = [...this.#arrivals.filter(({ at }) => this.#now - at <= 2000), { at: this.#now, captured }];
    const whole = this.#best && this.#now + this.#best.offset - captured;
    this.#delays = [...this.#delays.slice(-29), whole ?? pose.age_us / 1000];
    this.onPose(pose, values);
  }

  #takeLandmarks(part) {
    const picture = this.#picture.add(part);
    if (picture) this.onLandmarks(picture);
  }

  #takeAcknowledgement(message) {
    const sent = this.#pings.get(message.id);
    if (message.code === COMMANDS.ping && sent !== undefined) {
      const roundTrip = this.#now - sent;
      const offset = Number(message.now_us) / 1000 - (sent + roundTrip / 2);
      if (!this.#best) this.#delays = [];
      if (!this.#best || roundTrip <= this.#best.roundTrip) this.#best = { roundTrip, offset };
    }
    if (message.code === COMMANDS.landmarks && message.result !== 0) this.landmarksRefused = RESULTS[message.result] ?? 'refused';
    this.onAcknowledgement(message);
  }
}
