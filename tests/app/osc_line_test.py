#!/usr/bin/env python3
"""The service's line in OSC, read by Debian's liblo, against the same line in the native protocol.

    osc_line_test.py FACEWIRED SHARE ASSETS

Two runs of the real service on mock hardware over a whole clip, as fast as it goes, which is more than
the line carries in OSC: so a pose has the values that changed the most. Every value that liblo saw must
be that of the native pose with the same number, and none may be old. Exit code 77 (skipped) where Debian's
python3-liblo or the footage is not there.
"""
import os
import pathlib
import socket
import subprocess
import sys
import tempfile
import time
import tty

FACEWIRED, SHARE, ASSETS = sys.argv[1:4]
sys.path.insert(0, str(pathlib.Path(__file__).resolve().parents[1] / "core" / "wire"))
import read_vectors  # noqa: E402

try:
    import liblo
except ModuleNotFoundError as missing:
    print(f"skipped: {missing}")
    sys.exit(77)
CLIP = pathlib.Path(ASSETS) / "footage" / "franck.mp4"
if not CLIP.exists():
    print("skipped: the footage is not there: tools/setup")
    sys.exit(77)

CONFIG = """
[camera.replay]
file = "{clip}"
pace = "fast"
[tracker]
networks = "{assets}/networks"
[character]
rig = "{share}/otto.toml"
profile = "{share}/average.profile"
[neutral]
folder = "state"
[control]
socket = ""
[host]
line = "pty:line"
protocol = "{protocol}"
baud = 4000000
write_budget_ms = 20  # nothing may be lost, so wait for the host if need be
"""


def run(protocol, take, say=b""):
    """One clip; take(bytes) gets what the line says, and the line is told `say` once it runs."""
    with tempfile.TemporaryDirectory(prefix="osc_line_test.") as folder:
        config = pathlib.Path(folder) / "facewire.toml"
        config.write_text(CONFIG.format(clip=CLIP, assets=ASSETS, share=SHARE, protocol=protocol))
        service = subprocess.Popen([FACEWIRED, "--config", config, "--fake"],
                                   stdout=subprocess.PIPE, stderr=subprocess.STDOUT, text=True)
        try:
            line = os.path.join(folder, "line")
            end = time.monotonic() + 60
            while not os.path.exists(line) and service.poll() is None and time.monotonic() < end:
                time.sleep(0.001)
            terminal = os.open(line, os.O_RDWR | os.O_NOCTTY)
            tty.setraw(terminal)
            os.set_blocking(terminal, True)
            while True:
                try:
                    data = os.read(terminal, 65536)
                except OSError:  # the service has closed its end
                    break
                if not data:
                    break
                take(data)
                if say:
                    os.write(terminal, say)
                    say = b""
            os.close(terminal)
            text = service.communicate(timeout=60)[0]
            assert service.returncode == 0, text
            return text
        finally:
            if service.poll() is None:
                service.kill()
                service.communicate()


def native_poses():
    """The poses by the number of their picture, of which those after the last picture have the same."""
    data = bytearray()
    run("native", data.extend)
    messages, _ = read_vectors.decode(bytes(data))
    channels = {m["index"]: m for m in messages if m["type"] == "channel"}
    poses = {}
    for m in messages:
        if m["type"] != "pose":
            continue
        values = {}
        for index, step in enumerate(m["steps"]):
            c = channels[index]
            name = c["name"] if c["kind"] == "parameter" else "/".join(c["name"].rsplit(".", 1))
            values[f"/face/{name}"] = (c["min"] + step / 65535 * (c["max"] - c["min"]), c)
        poses.setdefault(m["frame_seq"], []).append((m["state"], values))
    return poses


def matches(value, path, poses):
    """Whether one of the poses has it: a float has 24 bits."""
    return any(abs(value - values[path][0]) <= 1e-6 * max(1, abs(values[path][1]["min"]), abs(values[path][1]["max"]))
               for _, values in poses)


class LibloReceiver:
    """A TCP server of liblo; whatever goes into its socket is SLIP."""

    def __init__(self, take):
        probe = socket.socket()
        probe.bind(("127.0.0.1", 0))
        port = probe.getsockname()[1]
        probe.close()
        self.server = liblo.Server(port, liblo.TCP)  # of port 0 it does not say which it took
        self.server.add_method(None, None, lambda path, arguments, types: take(path, types, arguments))
        self.socket = socket.create_connection(("127.0.0.1", port))
        # liblo recognises SLIP by a first packet that is a message, and not by a bundle.
        self.feed(b"\xc0/begin\0\0,\0\0\0\xc0")

    def feed(self, data):
        # In pieces: what a message belongs to must not depend on how the stream is cut.
        for at in range(0, len(data), 1000):
            self.socket.sendall(data[at:at + 1000])
            while self.server.recv(0):
                pass


class Host:
    def __init__(self):
        self.new, self.poses, self.channels, self.count = {}, [], {}, {}
        self.answers, self.rig = [], None

    def take(self, path, types, arguments):
        self.count[path] = self.count.get(path, 0) + 1
        if path.startswith("/face/"):
            assert types == "f", (path, types)
            self.new[path] = arguments[0]
        elif path == "/facewire/pose":
            assert types == "iif", types
            self.poses.append((arguments[0], arguments[1], self.new))
            self.new = {}
        elif path == "/facewire/channel":
            assert types == "isfffs", types
            self.channels[arguments[1]] = arguments
        elif path == "/facewire/rig":
            assert types == "siii", types
            self.rig = arguments
        elif path == "/facewire/answer":
            assert types == "ssf", types
            self.answers.append(arguments[:2])
        elif path == "/facewire/status":
            assert types == "sfiiiiiff", types
        else:
            assert path in ("/begin", "/facewire/bone"), path


def main():
    host = Host()
    problems = []

    def take(*message):
        try:
            host.take(*message)
        except AssertionError as problem:  # liblo's callbacks cannot raise
            problems.append(str(problem))

    receiver = LibloReceiver(take)
    size = 0

    def feed(data):
        nonlocal size
        size += len(data)
        receiver.feed(data)

    ping = b"\xc0/facewire/ping\0\0,\0\0\0\xc0"
    said = run("osc", feed, ping)
    end = time.monotonic() + 10
    while receiver.server.recv(100) and time.monotonic() < end:
        pass
    assert not problems, problems[:5]
    native = native_poses()
    print(said.strip().splitlines()[-1])

    # A pose that the line did not take leaves its first values to the next one.
    now, values, oldest, last = {}, 0, 0, host.poses[0][0]
    age = {}  # in poses, of values that are not those of the present pose
    for number, state, new in host.poses:
        if number not in native:
            continue
        assert state in [s for s, _ in native[number]], (number, state)
        since = [pose for n in range(last, number + 1) for pose in native.get(n, [])]
        for path, value in new.items():
            assert matches(value, path, since), (number, path, value)
        values += len(new)
        now.update(new)
        for path, value in now.items():
            age[path] = 0 if matches(value, path, native[number]) else age.get(path, 0) + 1
        oldest = max(oldest, max(age.values()))
        last = number
    channels = next(iter(native.values()))[0][1]
    assert host.rig[0] == "otto" and host.rig[2] == len(channels), host.rig
    assert set(host.channels) == set(channels), set(channels) ^ set(host.channels)
    for path, (_, c) in channels.items():
        described = host.channels[path][2:5]
        assert all(abs(a - b) < 1e-4 for a, b in zip(described, (c["min"], c["max"], c["neutral"]))), path
    assert ("ping", "ok") in [tuple(a) for a in host.answers], host.answers
    assert host.count["/facewire/status"] >= 3
    assert set(now) == set(channels)
    assert len(host.poses) > 0.95 * sum(map(len, native.values())), (len(host.poses), len(native))
    assert oldest <= len(channels) / 4 + 5, oldest  # four values of each pose come in turn
    print(f"{len(host.poses)} poses of {CLIP.name}, {values} values compared, none older than {oldest} poses; "
          f"{size / len(host.poses):.0f} bytes a pose")


main()
