"""uvc_webcam, spoken to as QEMU speaks to it: over its two sockets."""

import json
import socket
import struct
import subprocess
import sys
import tempfile
import time
import unittest
from pathlib import Path

FOLDER = Path(__file__).resolve().parent
sys.path.insert(0, str(FOLDER))

import descriptors as uvc  # noqa: E402
import usbredir  # noqa: E402

JPEGS = [b"\xff\xd8" + bytes([i]) * size + b"\xff\xd9" for i, size in enumerate((100, 16_382 - 4, 40_000))]
PATIENCE_S = 10


class Machine:
    """QEMU's side of the connection."""

    def __init__(self, path):
        self.socket = socket.socket(socket.AF_UNIX)
        self.socket.settimeout(PATIENCE_S)
        self.socket.connect(str(path))
        self.framing = usbredir.Framing()
        self.packets = []
        self.socket.sendall(usbredir.Framing.hello("a test"))
        self.last = 0

    def packet(self, kind):
        """The body of the next packet of that type; others are passed over."""
        return self.numbered(kind)[1]

    def numbered(self, kind):
        while True:
            while self.packets:
                found, ident, body = self.packets.pop(0)
                if found == kind:
                    return ident, body
            data = self.socket.recv(1 << 16)
            if not data:
                raise EOFError
            self.packets += self.framing.feed(data)

    def send(self, kind, body=b""):
        self.last += 1
        self.socket.sendall(self.framing.packet(kind, body, self.last))
        return self.last

    def control(self, kind, request, value, index, length=0, data=b""):
        """(status, data)"""
        body = usbredir.CONTROL.pack(kind & 0x80, request, kind, 0, value, index, length or len(data))
        self.send(usbredir.CONTROL_PACKET, body + data)
        answer = self.packet(usbredir.CONTROL_PACKET)
        return answer[3], answer[usbredir.CONTROL.size :]

    def descriptor(self, kind, index=0):
        return self.control(0x80, 6, kind << 8 | index, 0, 4096)

    def commit(self, form, frame, interval=333_333):
        wanted = uvc.PROBE.pack(0, form, frame, interval, 0, 0, 0, 0, 0, 0, 0)
        for selector in (1, 2):
            assert self.control(0x21, 1, selector << 8, 1, data=wanted)[0] == usbredir.SUCCESS

    def ask(self):
        return self.send(usbredir.BULK_PACKET, usbredir.BULK.pack(uvc.ENDPOINT, 0, uvc.PAYLOAD_BYTES, 0, 0))

    def payload(self):
        self.ask()
        return self.packet(usbredir.BULK_PACKET)[usbredir.BULK.size :]

    def picture(self):
        data = b""
        while True:
            payload = self.payload()
            data += payload[payload[0] :]
            if payload[1] & 0x02:
                return data


class WebcamTest(unittest.TestCase):
    def setUp(self):
        scratch = tempfile.TemporaryDirectory()
        self.addCleanup(scratch.cleanup)
        self.folder = Path(scratch.name)
        self.pictures = self.folder / "pictures"
        for i, jpeg in enumerate(JPEGS):
            self.write(f"mjpeg-640x480/{i}.jpg", jpeg)
            self.write(f"mjpeg-320x240/{i}.jpg", jpeg)
        self.write("yuyv-4x2/0.yuyv", bytes(range(16)))

    def write(self, name, data):
        path = self.pictures / name
        path.parent.mkdir(parents=True, exist_ok=True)
        path.write_bytes(data)

    def webcam(self, *arguments):
        self.process = subprocess.Popen(
            [sys.executable, "-B", FOLDER / "uvc_webcam", "play", self.pictures, self.folder / "camera",
             "--control", self.folder / "hand", *arguments],
            stderr=subprocess.PIPE, text=True)
        self.addCleanup(self.process.communicate)
        self.addCleanup(self.process.kill)
        end = time.monotonic() + PATIENCE_S
        while not (self.folder / "hand").is_socket() and self.process.poll() is None and time.monotonic() < end:
            time.sleep(0.005)

    def machine(self):
        machine = Machine(self.folder / "camera")
        self.addCleanup(machine.socket.close)
        return machine

    def connected(self):
        self.webcam()
        machine = self.machine()
        machine.packet(usbredir.DEVICE_CONNECT)
        return machine

    def tell(self, line):
        with socket.socket(socket.AF_UNIX) as hand:
            hand.settimeout(PATIENCE_S)
            hand.connect(str(self.folder / "hand"))
            hand.sendall(line.encode() + b"\n")
            return hand.makefile().readline().rstrip("\n")

    def status(self):
        return json.loads(self.tell("status"))

    def test_its_descriptors_are_as_long_as_they_say(self):
        machine = self.connected()
        device = machine.descriptor(1)[1]
        self.assertEqual(len(device), 18)
        self.assertEqual(struct.unpack_from("<HH", device, 8), (0x1D6B, 0x0102))
        configuration = machine.descriptor(2)[1]
        self.assertEqual(struct.unpack_from("<H", configuration, 2)[0], len(configuration))
        totals, at, seen = {}, 0, []
        subclass = None
        while at < len(configuration):
            length, kind, subtype = configuration[at : at + 3]
            self.assertGreater(length, 2)
            if kind == 4:
                subclass = configuration[at + 6]
            if kind == 0x24:
                seen.append((subclass, subtype))
                if subtype == 1:
                    totals[subclass] = [struct.unpack_from("<H", configuration, at + (5 if subclass == 1 else 4))[0], 0]
                totals[subclass][1] += length
            at += length
        self.assertEqual(at, len(configuration))
        for said, counted in totals.values():
            self.assertEqual(said, counted)
        # Header, two terminals; header, MJPEG with two sizes, YUYV with one, and their colours.
        self.assertEqual(seen, [(1, 1), (1, 2), (1, 3), (2, 1), (2, 6), (2, 7), (2, 7), (2, 13), (2, 4), (2, 5), (2, 13)])
        self.assertEqual(machine.descriptor(3, 3)[1][2:].decode("utf-16-le"), "FW0001")

    def test_a_request_that_it_does_not_know_stalls(self):
        machine = self.connected()
        self.assertEqual(machine.descriptor(6), (usbredir.STALL, b""))
        self.assertEqual(machine.descriptor(3, 9)[0], usbredir.STALL)
        self.assertEqual(machine.control(0xA1, 0x81, 0x0900, 0x0100, 2)[0], usbredir.STALL)

    def test_pictures_arrive_byte_for_byte_and_over_and_over(self):
        machine = self.connected()
        machine.commit(1, 1)
        for i in range(4):
            self.assertEqual(machine.picture(), JPEGS[i % 3])
        self.assertEqual(self.status()["sent"], 4)

    def test_a_picture_is_cut_into_payloads_that_tell_where_it_ends(self):
        machine = self.connected()
        machine.commit(1, 1)
        # 104 bytes; 16382, which just fit into one payload with its header; 40004.
        payloads = [machine.payload() for _ in range(5)]
        self.assertEqual([len(p) for p in payloads], [106, 16384, 16384, 16384, 40004 - 2 * 16382 + 2])
        self.assertEqual([p[1] & 0x02 for p in payloads], [2, 2, 0, 0, 2])
        self.assertEqual([p[1] & 0x01 for p in payloads], [0, 1, 0, 0, 0])

    def test_raw_pictures_are_another_format(self):
        machine = self.connected()
        machine.commit(2, 1)
        self.assertEqual(machine.picture(), bytes(range(16)))
        self.assertEqual(self.status()["format"], "yuyv")

    def test_impossible_wishes_get_what_is_there(self):
        machine = self.connected()
        machine.commit(9, 9, 1)
        probe = uvc.PROBE.unpack(machine.control(0xA1, 0x81, 0x0100, 1, 26)[1])
        self.assertEqual(probe[1:4], (2, 1, 333_333))

    def test_pictures_come_at_the_rate(self):
        machine = self.connected()
        machine.commit(1, 1)
        self.tell("rate 20")
        machine.picture()
        began = time.monotonic()
        for _ in range(10):
            machine.picture()
        self.assertGreater(time.monotonic() - began, 0.4)

    def test_a_damaged_picture_is_cut_in_half(self):
        machine = self.connected()
        machine.commit(1, 1)
        self.assertEqual(self.tell("damage 1"), "ok")
        self.assertEqual(machine.picture(), JPEGS[0][: len(JPEGS[0]) // 2])
        self.assertEqual(machine.picture(), JPEGS[1])

    def test_a_stalled_camera_is_silent_until_it_goes_on(self):
        machine = self.connected()
        machine.commit(1, 1)
        machine.picture()
        self.tell("stall")
        machine.ask()
        machine.socket.settimeout(0.2)
        with self.assertRaises(TimeoutError):
            machine.packet(usbredir.BULK_PACKET)
        machine.socket.settimeout(PATIENCE_S)
        self.tell("resume")
        self.assertEqual(machine.packet(usbredir.BULK_PACKET)[usbredir.BULK.size + 2 :], JPEGS[1][:16382])

    def test_a_cancelled_request_is_answered_as_such(self):
        machine = self.connected()
        machine.commit(1, 1)
        self.tell("stall")
        asked = machine.ask()
        machine.socket.sendall(machine.framing.packet(usbredir.CANCEL_DATA_PACKET, b"", asked))
        ident, answer = machine.numbered(usbredir.BULK_PACKET)
        self.assertEqual((ident, answer[1]), (asked, usbredir.CANCELLED))

    def test_it_is_unplugged_in_mid_stream_and_comes_back_as_new(self):
        machine = self.connected()
        machine.commit(1, 1)
        machine.control(0x21, 1, 0x0300, 0x0100, data=b"\0")
        self.assertEqual(self.status()["exposure_priority"], 0)
        machine.picture()
        self.tell("unplug")
        machine.packet(usbredir.DEVICE_DISCONNECT)
        self.assertFalse(self.status()["connected"])
        self.tell("plug")
        machine.packet(usbredir.DEVICE_CONNECT)
        self.assertEqual(self.status()["exposure_priority"], 1)
        machine.commit(1, 1)
        self.assertEqual(machine.picture(), JPEGS[0])

    def test_a_machine_may_come_after_another(self):
        self.connected().socket.close()
        end = time.monotonic() + PATIENCE_S
        while self.status()["connected"] and time.monotonic() < end:
            time.sleep(0.005)
        self.machine().packet(usbredir.DEVICE_CONNECT)

    def test_it_may_begin_unplugged(self):
        self.webcam("--unplugged")
        machine = self.machine()
        machine.packet(usbredir.HELLO)
        self.assertFalse(self.status()["connected"])
        self.tell("plug")
        machine.packet(usbredir.DEVICE_CONNECT)

    def test_a_far_side_that_speaks_nonsense_loses_the_camera_only(self):
        machine = self.connected()
        machine.socket.sendall(b"\xff" * 64)
        with self.assertRaises((EOFError, ConnectionError)):
            machine.packet(usbredir.DEVICE_CONNECT)
        self.machine().packet(usbredir.DEVICE_CONNECT)

    def test_a_command_that_it_does_not_know_is_answered_with_those_it_knows(self):
        self.webcam()
        for line in ("", "explode", "damage", "damage many", "rate 0", "plug in"):
            self.assertRegex(self.tell(line), "^error: ", line)

    def test_pictures_that_are_none_are_named(self):
        for name, data, said in (
            ("mjpeg-2x2/a.jpg", b"not", "a.jpg is no JPEG file"),
            ("yuyv-4x2/1.yuyv", b"short", "has 5 bytes; yuyv-4x2 takes 16"),
        ):
            self.write(name, data)
            self.webcam()
            _, errors = self.process.communicate(timeout=PATIENCE_S)
            self.assertEqual(self.process.returncode, 2)
            self.assertIn(said, errors)
            (self.pictures / name).unlink()
            if not any((self.pictures / name).parent.iterdir()):
                (self.pictures / name).parent.rmdir()


if __name__ == "__main__":
    unittest.main()
