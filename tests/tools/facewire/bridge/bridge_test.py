#!/usr/bin/env python3
"""`facewire bridge` as a person runs it: a device on a pseudo-terminal, receivers on UDP sockets.

    bridge_test.py FACEWIRE SHARE ASSETS [Program | Performance]

Exit code 77 (skipped) where Debian's python3-liblo is not installed.
"""
import csv
import math
import os
import pathlib
import random
import signal
import socket
import subprocess
import sys
import tempfile
import time
import unittest

try:
    import receivers
except ModuleNotFoundError as missing:
    print(f"skipped: {missing}")
    sys.exit(77)
from native_line import Device, Encoder, Rig

FACEWIRE, SHARE, ASSETS = sys.argv[1:4]

SHAPES = [s[0].lower() + s[1:] for s in receivers.LiveLinkReceiver.SHAPES]
TURNS = [("head", 45), ("neck", 60), ("eye_L", 30), ("eye_R", 30)]


def full_rig(rig_id=7):
    """Everything that a receiver can be told, with ranges of different widths."""
    channels = [(f"{bone}.{axis}", kind, i, -limit, limit) for i, (bone, limit) in enumerate(TURNS)
                for axis, kind in (("pitch", 4), ("yaw", 5), ("roll", 6))]
    return Rig("puppet", [bone for bone, _ in TURNS], channels + [(s, 0, 255, 0, 1) for s in SHAPES], rig_id)


def matrix(pitch, yaw, roll):
    """R = Ry(yaw) Rx(pitch) Rz(roll), as core/wire/README.md has it."""
    def times(a, b):
        return [[sum(a[i][k] * b[k][j] for k in range(3)) for j in range(3)] for i in range(3)]
    (sp, cp), (sy, cy), (sr, cr) = [(math.sin(math.radians(a)), math.cos(math.radians(a))) for a in (pitch, yaw, roll)]
    return times(times([[cy, 0, sy], [0, 1, 0], [-sy, 0, cy]], [[1, 0, 0], [0, cp, -sp], [0, sp, cp]]),
                 [[cr, -sr, 0], [sr, cr, 0], [0, 0, 1]])


def product(a, b):
    return [[sum(a[i][k] * b[k][j] for k in range(3)) for j in range(3)] for i in range(3)]


def of_unity(q):
    """Where Unity's quaternion takes our axes: its matrix, with x mirrored before and behind."""
    x, y, z, w = q
    m = [[1 - 2 * (y * y + z * z), 2 * (x * y - w * z), 2 * (x * z + w * y)],
         [2 * (x * y + w * z), 1 - 2 * (x * x + z * z), 2 * (y * z - w * x)],
         [2 * (x * z - w * y), 2 * (y * z + w * x), 1 - 2 * (x * x + y * y)]]
    sign = (-1, 1, 1)
    return [[sign[i] * m[i][j] * sign[j] for j in range(3)] for i in range(3)]


def of_unreal(yaw, pitch, roll):
    """The same for Live Link's radians: Unreal's rotation matrix, which has vectors as rows, and
    Epic's axes (-z, x, y)."""
    sp, cp, sy, cy = math.sin(pitch), math.cos(pitch), math.sin(yaw), math.cos(yaw)
    sr, cr = math.sin(roll), math.cos(roll)
    rows = [[cp * cy, cp * sy, sp],
            [sr * sp * cy - cr * sy, sr * sp * sy + cr * cy, -sr * cp],
            [-(cr * sp * cy + sr * sy), cy * sr - cr * sp * sy, cr * cp]]
    axes = [[0, 0, -1], [1, 0, 0], [0, 1, 0]]  # of Unreal, in ours
    back = [list(column) for column in zip(*axes)]
    return product(product(back, [list(column) for column in zip(*rows)]), axes)


class Bridge:
    """The program, a device on its line, and a receiver of each kind."""

    def __init__(self, test, rig, extra=(), host="127.0.0.1"):
        self.test, self.rig = test, rig
        self.folder = tempfile.TemporaryDirectory(prefix="bridge_test.")
        test.addCleanup(self.folder.cleanup)
        self.vmc = receivers.VmcReceiver()
        self.livelink = receivers.LiveLinkReceiver()
        self.ifacialmocap = receivers.IFacialMocapReceiver()
        test.addCleanup(self.livelink.socket.close)
        test.addCleanup(self.ifacialmocap.socket.close)
        self.device = Device(os.path.join(self.folder.name, "line"))
        self.log = open(os.path.join(self.folder.name, "log"), "w+")
        test.addCleanup(self.log.close)
        self.process = subprocess.Popen(
            [FACEWIRE, "bridge", self.device.link, "--vmc", f"{host}:{self.vmc.port}",
             "--livelink", f"{host}:{self.livelink.port}",
             "--ifacialmocap", f"{host}:{self.ifacialmocap.port}", *extra],
            stdout=self.log, stderr=subprocess.STDOUT)
        test.addCleanup(self.kill)
        self.number = 0
        self.describe()

    def kill(self):
        if self.process.poll() is None:
            self.process.kill()
        self.process.wait()

    def describe(self):
        self.device.wait_for_question()
        self.device.send(self.device.encoder.description(self.rig))

    def pose(self, values, state="tracking", captured_us=None):
        """Sends one, and returns the values that crossed the line and what each receiver got."""
        self.number += 1
        steps = self.rig.steps(values)
        at = self.number * 16_667 if captured_us is None else captured_us
        self.device.send(self.device.encoder.pose(self.rig, steps, self.number, at, state))
        return self.rig.values(steps), self.vmc.frame(), self.livelink.frame(), at

    def end(self):
        self.process.send_signal(signal.SIGINT)
        self.test.assertEqual(self.process.wait(20), 0, self.text())
        return self.text()

    def text(self):
        self.log.seek(0)
        return self.log.read()

    def wait_for(self, text):
        for _ in range(2000):
            if text in self.text():
                return
            self.test.assertIsNone(self.process.poll(), self.text())
            time.sleep(0.01)
        self.test.fail(f"never said '{text}': {self.text()}")


class Checks(unittest.TestCase):
    def near(self, is_, should, tolerance, what=""):
        self.assertLessEqual(abs(is_ - should), tolerance, f"{what}: {is_} should be {should}")

    def same_rotation(self, is_, should, what, tolerance=2e-5):
        for i in range(3):
            for j in range(3):
                self.near(is_[i][j], should[i][j], tolerance, what)

    def check(self, sent, vmc, live, text, captured_us):
        """Every value that any receiver got, against what crossed the line."""
        turn = {bone: [sent.get(f"{bone}.{axis}", 0) for axis in ("pitch", "yaw", "roll")]
                for bone, _ in TURNS}
        head = product(matrix(*turn["neck"]), matrix(*turn["head"]))
        for i, shape in enumerate(SHAPES):
            value = sent.get(shape, 0)
            self.near(live["values"][receivers.LiveLinkReceiver.SHAPES[i]], value, 1e-6, shape)
            side = shape
            if not shape.startswith("jaw") and shape not in ("mouthLeft", "mouthRight"):
                side = shape.replace("Left", "_L").replace("Right", "_R")
            self.near(text[side], value * 100, 0.501, side)
        v = live["values"]
        self.same_rotation(of_unreal(v["HeadYaw"], v["HeadPitch"], v["HeadRoll"]), head, "Live Link head")
        self.same_rotation(matrix(*text["head"][:3]), head, "iFacialMocap head")
        self.same_rotation(of_unity(vmc.bones["Neck"][1]), matrix(*turn["neck"]), "VMC neck")
        self.same_rotation(of_unity(vmc.bones["Head"][1]), matrix(*turn["head"]), "VMC head")
        for bone, unity, name in (("eye_L", "LeftEye", "leftEye"), ("eye_R", "RightEye", "rightEye")):
            should = matrix(*turn[bone])
            self.same_rotation(of_unity(vmc.bones[unity][1]), should, unity)
            self.same_rotation(matrix(*text[name]), should, name)
            self.same_rotation(of_unreal(*[v[f"{unity}{axis}"] for axis in ("Yaw", "Pitch", "Roll")]), should, unity)
        # A float of a sixtieth of a second, and of the seconds since the first pose.
        self.near(live["seconds"], captured_us * 1e-6, 2e-6 + captured_us * 1e-12, "timecode")


class Performance(Checks):
    def test_a_whole_performance_arrives(self):
        clip = pathlib.Path(ASSETS) / "footage" / "franck.mp4"
        if not clip.exists():
            self.skipTest("the footage is not there: tools/setup")
        rig = Rig.of_file(pathlib.Path(SHARE) / "otto.toml")
        with tempfile.TemporaryDirectory(prefix="bridge_test.") as folder:
            out = os.path.join(folder, "poses.csv")
            subprocess.run([FACEWIRE, "retarget", str(clip), "--rig", os.path.join(SHARE, "otto.toml"), "--out", out],
                           check=True, stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL)
            with open(out, newline="") as file:
                rows = list(csv.DictReader(file))
        self.assertGreater(len(rows), 100)
        bridge = Bridge(self, rig)
        for row in rows:
            values = {name: float(row[name]) for name, *_ in rig.channels}
            sent, vmc, live, at = bridge.pose(values, row["state"], int(row["t_us"]) + 1_000_000)
            text = bridge.ifacialmocap.frame()
            if live["values"] is not None:
                self.check(sent, vmc, live, text, at)
            self.near(vmc.blends["Blink_L"], sent["eyeBlinkLeft"], 1e-6, "Blink_L")
            self.near(vmc.blends["Blink_R"], sent["eyeBlinkRight"], 1e-6, "Blink_R")
            self.assertEqual(len(vmc.blends), 7)
            self.assertLessEqual(sum(vmc.blends[v] for v in "AIUEO"), 1.00001)
        said = bridge.end()
        self.assertIn(f"{len(rows)} poses; ", said)
        # What Otto has none of, once.
        self.assertEqual(said.count("tongueOut"), 1, said)
        print(f"{len(rows)} poses of {clip.name}, {3 * len(rows)} datagrams read and compared")


class Program(Checks):
    def test_every_value_of_every_pose_arrives_in_each_protocol(self):
        rig = full_rig()
        bridge = Bridge(self, rig, ["--vmc-names", "arkit"])
        dice = random.Random(1)
        for number in range(150):
            values = {name: dice.uniform(low, high) for name, _, _, low, high in rig.channels}
            if number < 2:  # both ends of every range, but not the pole of pitch
                values = {name: (high if number else low) / (1 if kind == 0 else 2)
                          for name, kind, _, low, high in rig.channels}
            sent, vmc, live, at = bridge.pose(values)
            text = bridge.ifacialmocap.frame()
            self.check(sent, vmc, live, text, at)
            self.assertEqual(vmc.ok, (1, 3, 0, 1))
            self.near(vmc.time, number * 0.016667, 1e-5, "T")
            self.assertEqual(sorted(vmc.blends), sorted(receivers.LiveLinkReceiver.SHAPES))
            for name, value in vmc.blends.items():
                self.near(value, sent[name[0].lower() + name[1:]], 1e-6, name)
            self.assertEqual(text["trackingStatus"], 1)
            self.assertEqual((live["name"], len(live["id"])), ("puppet", 36))
        said = bridge.end()
        self.assertIn("the rig is puppet\n", said)
        self.assertIn("150 poses; 450 datagrams to ", said)
        self.assertNotIn("refused", said)

    def test_each_protocol_says_in_its_own_way_that_there_is_no_face(self):
        bridge = Bridge(self, full_rig(), ["--ifacialmocap-version", "2", "--name", "stage"])
        values = {"jawOpen": 0.5}
        for state, tracking, has_values in (
                ("searching", 0, False), ("tracking", 1, True), ("holding", 0, True), ("easing", 0, True),
                ("resting", 0, True), ("resting", 0, False), ("stopped", 0, False), ("tracking", 1, True)):
            _, vmc, live, _ = bridge.pose(values, state)
            text = bridge.ifacialmocap.frame("&")
            self.assertEqual(vmc.ok, (1, 3, 0, tracking), state)
            self.assertEqual(text["trackingStatus"], tracking, state)
            self.assertEqual(live["values"] is not None, has_values, state)
            self.assertEqual(live["name"], "stage")
            self.near(vmc.blends["A"], 0.5, 1e-4, "A")

    def test_a_lost_line_is_opened_again_and_a_new_rig_is_asked_for(self):
        bridge = Bridge(self, full_rig())
        bridge.pose({"jawOpen": 1})
        bridge.ifacialmocap.frame()
        bridge.device.unplug()
        bridge.wait_for("the line is gone")
        bridge.device.plug()
        bridge.wait_for("the line is back")
        # The same rig goes on at once; poses of another one wait for its description.
        sent, vmc, live, at = bridge.pose({"jawOpen": 0.25})
        self.check(sent, vmc, live, bridge.ifacialmocap.frame(), at)
        other = Rig("other", ["neck"], [("neck.yaw", 5, 0, -90, 90), ("jawOpen", 0, 255, 0, 1)], 8)
        bridge.device.send(bridge.device.encoder.pose(other, other.steps({}), 1, 0))
        bridge.rig = other
        bridge.describe()
        sent, vmc, live, at = bridge.pose({"neck.yaw": 45, "jawOpen": 0.75})
        self.check(sent, vmc, live, bridge.ifacialmocap.frame(), at)
        self.assertEqual(live["name"], "other")
        said = bridge.end()
        self.assertIn("the rig is other; it lacks, and the receivers get as 0: eyeBlinkLeft, ", said)
        self.assertIn("turns of a bone 'eye_R'", said)
        self.assertIn("3 poses; ", said)

    def test_a_recording_goes_out_at_its_own_pace_and_ends(self):
        rig = full_rig()
        encoder = Encoder()
        stream = encoder.description(rig)
        for number in range(10):
            stream += encoder.pose(rig, rig.steps({"jawOpen": number / 10}), number, number * 20_000)
        receiver = receivers.LiveLinkReceiver(socket.AF_INET6, "::1") if socket.has_ipv6 else None
        if receiver:
            self.addCleanup(receiver.socket.close)
        to = f"[::1]:{receiver.port}" if receiver else "127.0.0.1:9"
        with tempfile.NamedTemporaryFile(prefix="bridge_test.") as file:
            file.write(stream)
            file.flush()
            done = subprocess.run([FACEWIRE, "bridge", file.name, "--livelink", to], capture_output=True, text=True)
        self.assertEqual(done.returncode, 0, done.stderr)
        self.assertIn("10 poses; 10 datagrams to ", done.stdout)
        for number in range(10 if receiver else 0):
            self.near(receiver.frame()["values"]["JawOpen"], number / 10, 1e-4, "jawOpen")

    def test_a_line_that_speaks_osc_is_named_once(self):
        bundle = b"\xc0#bundle\0" + bytes(7) + b"\1" + b"\xc0"
        with tempfile.NamedTemporaryFile(prefix="bridge_test.") as file:
            file.write(b"noise" + bundle * 20)
            file.flush()
            done = subprocess.run([FACEWIRE, "bridge", file.name, "--vmc", "127.0.0.1:9"], capture_output=True, text=True)
        self.assertEqual(done.stdout.count("this line speaks OSC; for this program set [host] protocol = \"native\""), 1)
        self.assertEqual(done.returncode, 2)

    def test_a_receiver_that_is_not_there_yet_is_no_error(self):
        bridge = Bridge(self, full_rig(), host="localhost")
        bridge.livelink.socket.close()
        for _ in range(5):
            bridge.number += 1
            bridge.device.send(bridge.device.encoder.pose(bridge.rig, bridge.rig.steps({}), bridge.number, 0))
            bridge.vmc.frame()
        self.assertIn("refused", bridge.end())

    def test_what_is_wrong_is_said_in_one_line_with_exit_code_2(self):
        for arguments, part in (
                ([], "nowhere to send to"),
                (["--vmc", "nobody.invalid:39539"], "cannot find the host 'nobody.invalid'"),
                (["--vmc", "127.0.0.1:99999"], "a port is a number from 1 to 65535"),
                (["--livelink", "::1:11111"], "in brackets"),
                (["--livelink", "127.0.0.1", "--name", "x" * 65], "--name is longer than 64 bytes"),
                (["--vmc", "127.0.0.1", "--vmc-names", "vrm2"], "vrm2"),
                (["--vmc", "127.0.0.1"], "there is no port /nowhere")):
            done = subprocess.run([FACEWIRE, "bridge", "/nowhere", *arguments], capture_output=True, text=True)
            self.assertEqual(done.returncode, 2, arguments)
            self.assertEqual(done.stderr.count("\n"), 1, done.stderr)
            self.assertIn(part, done.stderr)

    def test_a_file_that_is_no_recording_is_said_in_one_line_alone(self):
        with tempfile.NamedTemporaryFile("w") as file:
            file.write("this is text")
            file.flush()
            done = subprocess.run([FACEWIRE, "bridge", file.name, "--vmc", "127.0.0.1"], capture_output=True, text=True)
        self.assertEqual((done.returncode, done.stdout), (2, ""))
        self.assertEqual(done.stderr, f"facewire: {file.name} holds no pose of a rig that it describes\n")


if __name__ == "__main__":
    unittest.main(argv=[sys.argv[0], *sys.argv[4:]])
