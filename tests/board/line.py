"""The host's end of the board's serial line: everything is recorded, and decoded as it comes."""
import dataclasses
import importlib.util
import pathlib
import socket
import threading
import time

_PATH = pathlib.Path(__file__).parent.parent / "core" / "wire" / "read_vectors.py"
_spec = importlib.util.spec_from_file_location("read_vectors", _PATH)
wire = importlib.util.module_from_spec(_spec)
_spec.loader.exec_module(wire)

STATES = ["starting", "searching", "tracking", "holding", "easing", "resting", "stopped", "fault"]


@dataclasses.dataclass
class Pose:
    sequence: int      # of the line's frames
    frame_seq: int     # of the camera's pictures
    sent_s: float      # on the board's clock
    heard: float       # time.monotonic() here
    state: str
    rig_id: int
    steps: list        # of each channel, 0..65535

    def __str__(self):
        return f"{self.state} at {self.sent_s:.3f} s"


class Line:
    """Reads until closed. Poses are kept from the first to the last."""

    def __init__(self, path, record):
        self.poses = []
        self._channels = {}  # rig_id -> {index: description}
        self._counts = {}  # rig_id -> channels
        self.record = record
        self._news = threading.Condition(threading.RLock())
        self._socket = socket.socket(socket.AF_UNIX)
        self._socket.connect(str(path))
        self._thread = threading.Thread(target=self._read, daemon=True)
        self._thread.start()

    def _read(self):
        rest = b""
        with open(self.record, "wb") as record:
            while True:
                try:
                    data = self._socket.recv(65536)
                except OSError:
                    return
                if not data:
                    return
                record.write(data)
                record.flush()
                # Whole frames are decoded; a cut one waits for its end.
                whole, zero, rest = (rest + data).rpartition(b"\0")
                if zero:
                    self._take(wire.decode(whole + zero)[0])

    def _take(self, messages):
        with self._news:
            for message in messages:
                if message["type"] == "rig_header":
                    self._counts[message["rig_id"]] = message["channels"]
                elif message["type"] == "channel":
                    self._channels.setdefault(message["rig_id"], {})[message["index"]] = message
                elif message["type"] == "pose":
                    self.poses.append(Pose(
                        message["sequence"], message["frame_seq"],
                        (message["captured_us"] + message["age_us"]) / 1e6, time.monotonic(),
                        STATES[message["state"]], message["rig_id"], message["steps"]))
            self._news.notify_all()

    def mark(self):
        """A place in the stream; what follows it is new."""
        with self._news:
            return len(self.poses)

    def since(self, mark):
        with self._news:
            return self.poses[mark:]

    def wait_for(self, what, wanted, timeout, since=None):
        """The first pose after `since` (without it: from now on) for which `wanted` is true."""
        at = self.mark() if since is None else since
        deadline = time.monotonic() + timeout
        with self._news:
            while True:
                while at < len(self.poses):
                    if wanted(self.poses[at]):
                        return self.poses[at]
                    at += 1
                left = deadline - time.monotonic()
                if left <= 0 or not self._news.wait(left):
                    last = self.poses[-1] if self.poses else "nothing at all"
                    raise TimeoutError(f"waited {timeout} s for {what}; the line said last: {last}")

    def wait_for_state(self, *states, timeout, since=None):
        return self.wait_for(" or ".join(states), lambda pose: pose.state in states, timeout, since)

    def rig(self, rig_id, timeout=180):
        """{index: channel}, once the board has described them all; that rides along with the poses, a few at a time."""
        deadline = time.monotonic() + timeout
        with self._news:
            while len(self._channels.get(rig_id, {})) != self._counts.get(rig_id):
                if not self._news.wait(deadline - time.monotonic()):
                    raise TimeoutError(f"waited {timeout} s for the rig's description")
            return self._channels[rig_id]

    def value(self, pose, name):
        """Of a channel, in its unit."""
        channel = next(channel for channel in self.rig(pose.rig_id).values() if channel["name"] == name)
        span = channel["max"] - channel["min"]
        return channel["min"] + pose.steps[channel["index"]] / 65535 * span

    def off_neutral(self, pose):
        """How far the farthest channel is from its neutral, as a part of its range."""
        far = 0.0
        for channel in self.rig(pose.rig_id).values():
            span = channel["max"] - channel["min"]
            if span > 0:
                neutral = (channel["neutral"] - channel["min"]) / span
                far = max(far, abs(pose.steps[channel["index"]] / 65535 - neutral))
        return far

    def close(self):
        try:
            self._socket.shutdown(socket.SHUT_RDWR)
        except OSError:
            pass
        self._socket.close()
        self._thread.join(5)
