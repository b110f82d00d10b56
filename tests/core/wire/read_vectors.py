#!/usr/bin/env python3
"""Reads the wire vectors with nothing but Python's library, and compares with what they mean.

    read_vectors.py DIR        checks every DIR/*.bin against its .json; exit code 1 when one differs
    read_vectors.py FILE.bin   prints the messages of a stream, one JSON object a line

A second implementation of core/wire/README.md, independent of the C++ one and short enough to copy
into a host.
"""
import json
import math
import pathlib
import struct
import sys
import zlib

MAX_INSIDE = 1024  # header, payload and CRC
MAX_BONES, MAX_CHANNELS, MAX_NAME, MAX_TEXT, MAX_SERVOS = 80, 240, 31, 480, 64
MAX_LANDMARKS, MAX_LANDMARKS_IN_PART = 478, 32
MIN_PULSE, MAX_PULSE = 2000, 10000  # quarters of a microsecond
KINDS = ["parameter", "position_x", "position_y", "position_z", "pitch", "yaw", "roll"]
FAULT = 7
LAST_RECEIVER_STATE = 7
CODES_WITH_VALUE = {7, 10, 11}
CODES_WITH_ITEM = {10}
RESULTS_WITH_MEASURE = range(5, 10)


class Malformed(Exception):
    pass


class Payload:
    def __init__(self, data):
        self.data = data

    def take(self, layout):
        size = struct.calcsize("<" + layout)
        if size > len(self.data):
            raise Malformed
        values = struct.unpack("<" + layout, self.data[:size])
        self.data = self.data[size:]
        if any(isinstance(v, float) and not math.isfinite(v) for v in values):
            raise Malformed
        return values if len(values) > 1 else values[0]

    def name(self):
        size = self.take("B")
        text, self.data = self.data[:size], self.data[size:]
        if len(text) < size or size > MAX_NAME or any(not 0x21 <= c <= 0x7E for c in text):
            raise Malformed
        return text.decode("ascii")


def require(condition):
    if not condition:
        raise Malformed


def read_rig_header(p):
    rig_id, bones, channels = p.take("IBB")
    require(bones <= MAX_BONES and channels <= MAX_CHANNELS)
    return {"type": "rig_header", "rig_id": rig_id, "bones": bones, "channels": channels,
            "name": p.name()}


def read_bone(p):
    rig_id, index, x, y, z = p.take("IBfff")
    require(index < MAX_BONES)
    return {"type": "bone", "rig_id": rig_id, "index": index, "rest_cm": [x, y, z],
            "name": p.name()}


def read_channel(p):
    rig_id, index, kind, bone, neutral, low, high = p.take("IBBBfff")
    require(index < MAX_CHANNELS and (bone < MAX_BONES or bone == 255))
    require(low <= neutral <= high)
    return {"type": "channel", "rig_id": rig_id, "index": index,
            "kind": KINDS[kind] if kind < len(KINDS) else "parameter",
            "bone": -1 if bone == 255 else bone,
            "neutral": neutral, "min": low, "max": high, "name": p.name()}


def read_pose(p):
    rig_id, frame_seq, captured, age, state, count = p.take("IIqIBB")
    require(count <= MAX_CHANNELS)
    return {"type": "pose", "rig_id": rig_id, "frame_seq": frame_seq, "captured_us": captured,
            "age_us": age, "state": min(state, FAULT), "steps": [p.take("H") for _ in range(count)]}


def read_status(p):
    names = ["rig_id", "state", "now_us", "uptime_s", "centi_fps", "frames", "dropped", "losses",
             "link_errors", "latency_p50_us", "latency_p99_us"]
    message = dict(zip(names, p.take("IBqIHIIIIII")))
    message["state"] = min(message["state"], FAULT)
    return {"type": "status", **message}


def read_acknowledgement(p):
    message = dict(zip(["id", "code", "result", "now_us"], p.take("HBBq")))
    if message["result"] in RESULTS_WITH_MEASURE:
        message["measure"] = p.take("f")
    return {"type": "acknowledgement", **message}


def read_command(p):
    message = dict(zip(["id", "code"], p.take("HB")))
    if message["code"] in CODES_WITH_VALUE:
        message["value"] = p.take("f")
    if message["code"] in CODES_WITH_ITEM:
        message["item"] = p.take("B")
    return {"type": "command", **message}


def read_text(p):
    ident, size = p.take("HH")
    require(size <= MAX_TEXT and size <= len(p.data))
    text, p.data = p.data[:size], p.data[size:]
    return {"type": "text", "id": ident, "text": text.decode("utf-8")}


def read_servo_setup(p):
    setup_id, hold, ease, release, count = p.take("IIIIB")
    require(setup_id != 0 and count <= MAX_SERVOS)
    names = ["min", "neutral", "max", "speed", "ramp_speed", "ramp_acceleration"]
    servos = [dict(zip(names, p.take("HHHHHH"))) for _ in range(count)]
    for s in servos:
        require(MIN_PULSE <= s["min"] <= s["neutral"] <= s["max"] <= MAX_PULSE)
        require(s["speed"] and s["ramp_speed"] and s["ramp_acceleration"])
    return {"type": "servo_setup", "setup_id": setup_id, "hold_ms": hold, "ease_ms": ease,
            "release_ms": release, "servos": servos}


def read_widths(p):
    count = p.take("B")
    require(count <= MAX_SERVOS)
    widths = [p.take("H") for _ in range(count)]
    require(all(w == 0 or MIN_PULSE <= w <= MAX_PULSE for w in widths))
    return widths


def read_servo_pulses(p):
    setup_id, flags = p.take("IB")
    return {"type": "servo_pulses", "setup_id": setup_id, "stop": flags & 1,
            "quarter_us": read_widths(p)}


def read_landmarks(p):
    names = ["frame_seq", "captured_us", "width_px", "height_px", "total", "first"]
    *fields, count = p.take("IqHHHHB")
    message = dict(zip(names, fields))
    require(count <= MAX_LANDMARKS_IN_PART)
    require(message["first"] + count <= message["total"] <= MAX_LANDMARKS)
    return {"type": "landmarks", **message, "eighth_px": [p.take("h") for _ in range(2 * count)]}


def read_receiver_status(p):
    names = ["setup_id", "state", "capacity", "version_major", "version_minor", "reset_causes",
             "supply_mv", "uptime_ms", "frames", "damaged", "lost", "refused"]
    message = dict(zip(names, p.take("IBBBBBHIIIII")))
    require(message["capacity"] <= MAX_SERVOS)
    if message["state"] > LAST_RECEIVER_STATE:
        message["state"] = 0
    return {"type": "receiver_status", **message, "quarter_us": read_widths(p)}


READERS = {0x01: read_rig_header, 0x02: read_bone, 0x03: read_channel, 0x10: read_pose,
           0x11: read_status, 0x12: read_acknowledgement, 0x13: read_text,
           0x14: read_servo_setup, 0x15: read_servo_pulses, 0x16: read_landmarks,
           0x80: read_command, 0x81: read_receiver_status}


def cobs_decode(piece):
    """The plain bytes, and whether the last block was all there."""
    out, at = bytearray(), 0
    while at < len(piece):
        code = piece[at]
        block = piece[at + 1:at + code]
        out += block
        if len(block) < code - 1:
            return bytes(out), False
        at += code
        if code < 255 and at < len(piece):
            out.append(0)
    return bytes(out), True


def cobs_encode(plain):
    out = bytearray()
    while True:
        run = plain[:254].split(b"\0", 1)[0]
        out += bytes([len(run) + 1]) + run
        if len(run) == len(plain):
            return bytes(out)
        plain = plain[len(run) + (len(run) < 254):]


def decode(stream):
    messages = []
    stats = dict.fromkeys(["frames", "unknown", "versions", "malformed", "crc_errors",
                           "cobs_errors", "truncated", "overflows", "lost", "restarts",
                           "resyncs"], 0)
    last = None
    damaged = False

    def damage(kind, first):
        nonlocal damaged
        if not first:  # the tail of a frame that began before this stream is not damage
            stats[kind] += 1
            damaged = True

    pieces = stream.split(b"\0")[:-1]
    for number, piece in enumerate(pieces):
        if not piece:
            continue
        inside, whole = cobs_decode(piece)
        if len(inside) > MAX_INSIDE:
            damage("overflows", number == 0)
            continue
        if not whole:
            damage("cobs_errors", number == 0)
            continue
        if len(inside) < 8:
            damage("truncated", number == 0)
            continue
        if zlib.crc32(inside[:-4]) != int.from_bytes(inside[-4:], "little"):
            damage("crc_errors", number == 0)
            continue
        stats["resyncs"] += damaged
        damaged = False
        version, kind, sequence = struct.unpack("<BBH", inside[:4])
        if version != 1:
            stats["versions"] += 1
            continue
        if last is not None:
            gap = (sequence - (1 if last == 65535 else last + 1)) % 65535
            if sequence == 0 or gap > 32767:
                stats["restarts"] += 1
            else:
                stats["lost"] += gap
        last = sequence
        if kind not in READERS:
            stats["unknown"] += 1
            continue
        try:
            messages.append({"sequence": sequence, **READERS[kind](Payload(inside[4:-4]))})
            stats["frames"] += 1
        except Malformed:
            stats["malformed"] += 1
    return messages, stats


def single(value):
    """Numbers as the 32-bit floats they are on the wire, to compare what two languages print."""
    if isinstance(value, dict):
        return {k: single(v) for k, v in value.items()}
    if isinstance(value, list):
        return [single(v) for v in value]
    return struct.pack("<f", value) if isinstance(value, float) else value


def check(folder):
    failures = 0
    streams = sorted(folder.glob("*.bin"))
    for path in streams:
        stream = path.read_bytes()
        expected = json.loads(path.with_suffix(".json").read_text())
        messages, stats = decode(stream)
        if single(messages) != single(expected["messages"]) or stats != expected["stats"]:
            failures += 1
            print(f"{path.name}: this decoder says {messages} {stats}, "
                  f"the vector {expected['messages']} {expected['stats']}", file=sys.stderr)
        for piece in stream.split(b"\0")[:-1]:
            inside, whole = cobs_decode(piece)
            sound = whole and len(inside) >= 8 and zlib.crc32(inside[:-4]) == int.from_bytes(inside[-4:], "little")
            if sound and path.stem != "run_254_redundant" and cobs_encode(inside) != piece:
                failures += 1
                print(f"{path.name}: a frame is not in its shortest encoding", file=sys.stderr)
    if not streams:
        print(f"no vectors in {folder}", file=sys.stderr)
        return 1
    print(f"{len(streams)} vectors, {failures} failures")
    return 1 if failures else 0


def main():
    if len(sys.argv) != 2:
        print(__doc__, file=sys.stderr)
        return 2
    path = pathlib.Path(sys.argv[1])
    if path.is_dir():
        return check(path)
    for message in decode(path.read_bytes())[0]:
        print(json.dumps(message))
    return 0


if __name__ == "__main__":
    sys.exit(main())
