"""A device at the far end of a pseudo-terminal: describes its rig when asked, and sends poses.

Frames are made from core/wire/README.md alone, with the COBS of the Python reader of the vectors.
"""
import os
import pathlib
import select
import struct
import sys
import termios
import time
import tomllib
import tty
import zlib

sys.path.insert(0, str(pathlib.Path(__file__).resolve().parents[3] / "core" / "wire"))
import read_vectors  # noqa: E402

KINDS = {"x": 1, "y": 2, "z": 3, "pitch": 4, "yaw": 5, "roll": 6}
STATES = ["starting", "searching", "tracking", "holding", "easing", "resting", "stopped", "fault"]


def name_bytes(text):
    return bytes([len(text)]) + text.encode("ascii")


class Rig:
    """Bones by name, and channels as (name, kind, index of the bone or 255, min, max)."""

    def __init__(self, name, bones, channels, rig_id=0x1234):
        self.name, self.bones, self.channels, self.rig_id = name, bones, channels, rig_id

    @classmethod
    def of_file(cls, path):
        rig = tomllib.loads(pathlib.Path(path).read_text())
        bones, channels = [], []
        for bone in rig.get("bone", []):
            bones.append(bone["name"])
            for axis, kind in KINDS.items():
                if axis in bone:
                    channels.append((f"{bone['name']}.{axis}", kind, len(bones) - 1,
                                     bone[axis]["min"], bone[axis]["max"]))
        channels += [(p["name"], 0, 255, p.get("min", 0), p.get("max", 1)) for p in rig["parameter"]]
        return cls(rig["name"], bones, channels)

    def steps(self, values):
        """Quantised as the wire does it."""
        return [round((min(max(values.get(name, 0), low), high) - low) / (high - low) * 65535)
                for name, _, _, low, high in self.channels]

    def values(self, steps):
        return {name: low + q / 65535 * (high - low)
                for (name, _, _, low, high), q in zip(self.channels, steps)}


class Encoder:
    def __init__(self):
        self.sequence = 0

    def frame(self, kind, payload):
        inside = struct.pack("<BBH", 1, kind, self.sequence) + payload
        self.sequence = 1 if self.sequence == 65535 else self.sequence + 1
        inside += struct.pack("<I", zlib.crc32(inside))
        return b"\0" + read_vectors.cobs_encode(inside) + b"\0"

    def description(self, rig):
        parts = [self.frame(1, struct.pack("<IBB", rig.rig_id, len(rig.bones), len(rig.channels))
                            + name_bytes(rig.name))]
        for i, bone in enumerate(rig.bones):
            parts.append(self.frame(2, struct.pack("<IBfff", rig.rig_id, i, 0, 0, 0) + name_bytes(bone)))
        for i, (name, kind, bone, low, high) in enumerate(rig.channels):
            parts.append(self.frame(3, struct.pack("<IBBBfff", rig.rig_id, i, kind, bone,
                                                   min(max(0, low), high), low, high) + name_bytes(name)))
        return b"".join(parts)

    def pose(self, rig, steps, number, captured_us, state="tracking"):
        return self.frame(0x10, struct.pack("<IIqIBB", rig.rig_id, number, captured_us, 20000,
                                            STATES.index(state), len(steps))
                          + struct.pack(f"<{len(steps)}H", *steps))


class Device:
    """`link` is a path that leads to the terminal's other end."""

    def __init__(self, link):
        self.link = link
        self.encoder = Encoder()
        self.master, self.slave = None, None
        self.plug()

    def plug(self):
        self.master, self.slave = os.openpty()
        tty.setraw(self.slave, termios.TCSANOW)
        new = self.link + ".new"
        os.symlink(os.ttyname(self.slave), new)
        os.replace(new, self.link)
        os.close(self.slave)

    def unplug(self):
        os.unlink(self.link)
        os.close(self.master)
        self.master = None

    def send(self, data):
        while data:
            data = data[os.write(self.master, data):]

    def wait_for_question(self, seconds=30):
        """The next command "describe the rig"."""
        end, received = time.monotonic() + seconds, b""
        while time.monotonic() < end:
            if not select.select([self.master], [], [], 0.1)[0]:
                continue
            try:
                received += os.read(self.master, 4096)
            except OSError:  # nobody has the other end open yet
                time.sleep(0.01)
                continue
            if any(m["type"] == "command" and m["code"] == 2 for m in read_vectors.decode(received)[0]):
                return
        raise AssertionError("nobody asked for the rig")
