// The messages of the native protocol, version 1 (core/wire/README.md), from payload to plain object. A message's fields
// have the names that the vectors' .json gives them; what is 64 bits wide is a BigInt.

export const VERSION = 1;
export const MAX_INSIDE = 1024; // bytes of header, payload and CRC
const MAX_BONES = 80, MAX_CHANNELS = 240, MAX_NAME = 31, MAX_TEXT = 480, MAX_SERVOS = 64;
const MAX_LANDMARKS = 478, MAX_LANDMARKS_IN_PART = 32;
const MIN_PULSE = 2000, MAX_PULSE = 10000; // quarters of a microsecond

export const KINDS = ['parameter', 'position_x', 'position_y', 'position_z', 'pitch', 'yaw', 'roll'];
export const STATES = ['starting', 'searching', 'tracking', 'holding', 'easing', 'resting', 'stopped', 'fault'];
const FAULT = STATES.indexOf('fault');
const LAST_RECEIVER_STATE = 7;

export const COMMANDS = {
  ping: 1, describe_rig: 2, calibrate_neutral: 3, rest: 4, stop: 5, release: 6, blend_profile: 7, report: 8, reload: 9,
  move_servo: 10, landmarks: 11,
};
export const takesItem = (code) => code === COMMANDS.move_servo;
export const takesValue = (code) => code === COMMANDS.blend_profile || code === COMMANDS.landmarks || takesItem(code);

export const RESULTS = ['ok', 'unknown', 'refused', 'no_face', 'failed', 'head_turned', 'head_moved', 'face_moved',
  'eyes_closed', 'mouth_open', 'not_kept'];
const hasMeasure = (result) => result >= 5 && result <= 9;
export const succeeded = (result) => RESULTS[result] === 'ok' || RESULTS[result] === 'not_kept';

// Reads a payload from the front; past its end everything is zero and `ok` is false. What is left at the end belongs to
// a later protocol and is ignored.
class Reader {
  constructor(bytes) {
    this.view = new DataView(bytes.buffer, bytes.byteOffset, bytes.byteLength);
    this.at = 0;
    this.ok = true;
  }
  take(size, get, nothing = 0) {
    if (this.at + size > this.view.byteLength) {
      this.ok = false;
      this.at = this.view.byteLength;
      return nothing;
    }
    const value = this.view[get](this.at, true);
    this.at += size;
    return value;
  }
  u8() { return this.take(1, 'getUint8'); }
  u16() { return this.take(2, 'getUint16'); }
  i16() { return this.take(2, 'getInt16'); }
  u32() { return this.take(4, 'getUint32'); }
  i64() { return this.take(8, 'getBigInt64', 0n); }
  f32() {
    const value = this.take(4, 'getFloat32');
    this.require(Number.isFinite(value));
    return value;
  }
  state() { return Math.min(this.u8(), FAULT); }
  characters(size) {
    const left = this.view.byteLength - this.at;
    this.require(size <= left);
    const bytes = new Uint8Array(this.view.buffer, this.view.byteOffset + this.at, Math.min(size, left));
    this.at += bytes.length;
    return bytes;
  }
  name() {
    const bytes = this.characters(this.u8());
    this.require(bytes.length <= MAX_NAME && bytes.every((c) => c >= 0x21 && c <= 0x7e));
    return String.fromCharCode(...bytes);
  }
  // `count` values, none of them when there is no room for so many.
  list(count, limit, read) {
    this.require(count <= limit);
    return this.ok ? Array.from({ length: count }, read) : [];
  }
  require(condition) { this.ok = this.ok && condition; }
}

function readRigHeader(r) {
  const m = { type: 'rig_header', rig_id: r.u32(), bones: r.u8(), channels: r.u8(), name: r.name() };
  r.require(m.bones <= MAX_BONES && m.channels <= MAX_CHANNELS);
  return m;
}

function readBone(r) {
  const m = { type: 'bone', rig_id: r.u32(), index: r.u8(), rest_cm: [r.f32(), r.f32(), r.f32()], name: r.name() };
  r.require(m.index < MAX_BONES);
  return m;
}

function readChannel(r) {
  const m = { type: 'channel', rig_id: r.u32(), index: r.u8(), kind: KINDS[r.u8()] ?? KINDS[0], bone: r.u8() };
  if (m.bone === 255) m.bone = -1;
  Object.assign(m, { neutral: r.f32(), min: r.f32(), max: r.f32(), name: r.name() });
  r.require(m.index < MAX_CHANNELS && m.bone < MAX_BONES);
  r.require(m.min <= m.neutral && m.neutral <= m.max);
  return m;
}

function readPose(r) {
  const m = { type: 'pose', rig_id: r.u32(), frame_seq: r.u32(), captured_us: r.i64(), age_us: r.u32(), state: r.state() };
  return { ...m, steps: r.list(r.u8(), MAX_CHANNELS, () => r.u16()) };
}

function readStatus(r) {
  return {
    type: 'status', rig_id: r.u32(), state: r.state(), now_us: r.i64(), uptime_s: r.u32(), centi_fps: r.u16(),
    frames: r.u32(), dropped: r.u32(), losses: r.u32(), link_errors: r.u32(), latency_p50_us: r.u32(),
    latency_p99_us: r.u32(),
  };
}

function readAcknowledgement(r) {
  const m = { type: 'acknowledgement', id: r.u16(), code: r.u8(), result: r.u8(), now_us: r.i64() };
  return hasMeasure(m.result) ? { ...m, measure: r.f32() } : m;
}

function readText(r) {
  const id = r.u16();
  const size = r.u16();
  r.require(size <= MAX_TEXT);
  return { type: 'text', id, text: new TextDecoder().decode(r.characters(size)) };
}

function readServo(r) {
  const s = { min: r.u16(), neutral: r.u16(), max: r.u16(), speed: r.u16(), ramp_speed: r.u16(), ramp_acceleration: r.u16() };
  r.require(MIN_PULSE <= s.min && s.min <= s.neutral && s.neutral <= s.max && s.max <= MAX_PULSE);
  r.require(s.speed > 0 && s.ramp_speed > 0 && s.ramp_acceleration > 0);
  return s;
}

function readServoSetup(r) {
  const m = { type: 'servo_setup', setup_id: r.u32(), hold_ms: r.u32(), ease_ms: r.u32(), release_ms: r.u32() };
  r.require(m.setup_id !== 0);
  return { ...m, servos: r.list(r.u8(), MAX_SERVOS, () => readServo(r)) };
}

function readPulses(r) {
  const widths = r.list(r.u8(), MAX_SERVOS, () => r.u16());
  r.require(widths.every((w) => w === 0 || (w >= MIN_PULSE && w <= MAX_PULSE)));
  return widths;
}

function readServoPulses(r) {
  return { type: 'servo_pulses', setup_id: r.u32(), stop: r.u8() & 1, quarter_us: readPulses(r) };
}

// `eighth_px` is flat, as drawing likes it: x and y of landmark `first`, then of the next.
function readLandmarks(r) {
  const m = {
    type: 'landmarks', frame_seq: r.u32(), captured_us: r.i64(), width_px: r.u16(), height_px: r.u16(), total: r.u16(),
    first: r.u16(),
  };
  const count = r.u8();
  r.require(m.first + count <= m.total && m.total <= MAX_LANDMARKS);
  return { ...m, eighth_px: r.list(2 * count, 2 * MAX_LANDMARKS_IN_PART, () => r.i16()) };
}

function readReceiverStatus(r) {
  const m = {
    type: 'receiver_status', setup_id: r.u32(), state: r.u8(), capacity: r.u8(), version_major: r.u8(),
    version_minor: r.u8(), reset_causes: r.u8(), supply_mv: r.u16(), uptime_ms: r.u32(), frames: r.u32(),
    damaged: r.u32(), lost: r.u32(), refused: r.u32(), quarter_us: readPulses(r),
  };
  if (m.state > LAST_RECEIVER_STATE) m.state = 0;
  r.require(m.capacity <= MAX_SERVOS);
  return m;
}

function readCommand(r) {
  const m = { type: 'command', id: r.u16(), code: r.u8() };
  if (takesValue(m.code)) m.value = r.f32();
  if (takesItem(m.code)) m.item = r.u8();
  return m;
}

export const COMMAND = 0x80; // the type that a host sends
const READERS = new Map([
  [0x01, readRigHeader], [0x02, readBone], [0x03, readChannel], [0x10, readPose], [0x11, readStatus],
  [0x12, readAcknowledgement], [0x13, readText], [0x14, readServoSetup], [0x15, readServoPulses], [0x16, readLandmarks],
  [COMMAND, readCommand], [0x81, readReceiverStatus],
]);

// The message in a payload; 'unknown' for a type of a later protocol, 'malformed' for one that breaks a rule.
export function readPayload(type, payload) {
  const read = READERS.get(type);
  if (!read) return 'unknown';
  const reader = new Reader(payload);
  const message = read(reader);
  return reader.ok ? message : 'malformed';
}
