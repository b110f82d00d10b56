"""The two JSON lines into the emulated board: QEMU's monitor (the hardware) and the guest agent (a shell)."""
import base64
import dataclasses
import json
import shlex
import socket
import time


class JsonLines:
    """JSON objects, one a line, over a unix socket that QEMU listens at."""

    def __init__(self, path):
        self._socket = socket.socket(socket.AF_UNIX)
        self._socket.connect(str(path))
        self._received = b""

    def send(self, message):
        self._socket.settimeout(60)
        self._socket.sendall(json.dumps(message).encode() + b"\n")

    def receive(self, timeout):
        """The next object. Raises TimeoutError when none comes in `timeout` seconds."""
        deadline = time.monotonic() + timeout
        while b"\n" not in self._received:
            self._socket.settimeout(max(0.01, deadline - time.monotonic()))
            data = self._socket.recv(65536)
            if not data:
                raise ConnectionError("QEMU closed the line")
            self._received += data
        line, self._received = self._received.split(b"\n", 1)
        # The agent answers a synchronisation with this byte in front: what came before was another's.
        return json.loads(line.lstrip(b"\xff"))

    def close(self):
        self._socket.close()


class Monitor:
    """QEMU's own monitor protocol: plugs, unplugs, pauses."""

    def __init__(self, path):
        self._lines = JsonLines(path)
        self._lines.receive(30)  # the greeting
        self.events = []
        self.command("qmp_capabilities")

    def command(self, name, **arguments):
        self._lines.send({"execute": name, "arguments": arguments})
        while True:
            answer = self._lines.receive(30)
            if "event" in answer:
                self.events.append(answer)
            elif "error" in answer:
                raise RuntimeError(f"QEMU refuses {name}: {answer['error']['desc']}")
            else:
                return answer["return"]

    def wait_for_event(self, name, timeout):
        """What comes with it, whether it has come already or comes within `timeout` seconds."""
        deadline = time.monotonic() + timeout
        while not any(event["event"] == name for event in self.events):
            self.events.append(self._lines.receive(deadline - time.monotonic()))
        return next(event for event in self.events if event["event"] == name).get("data")

    def close(self):
        self._lines.close()


@dataclasses.dataclass
class Answer:
    code: int
    out: str  # standard output and error


class Agent:
    """Runs commands on the board as root, as a technician at its console would."""

    def __init__(self, path):
        self._lines = JsonLines(path)

    def greet(self, timeout):
        """Throws away what was meant for another; the first thing to do."""
        self._lines.send({"execute": "guest-sync", "arguments": {"id": 1}})
        while self._lines.receive(timeout).get("return") != 1:
            pass

    def shut_down(self):
        """Asks the board to; there is no answer."""
        self._lines.send({"execute": "guest-shutdown"})

    def _call(self, name, **arguments):
        self._lines.send({"execute": name, "arguments": arguments})
        answer = self._lines.receive(60)
        if "error" in answer:
            raise RuntimeError(f"the guest agent refuses {name}: {answer['error']['desc']}")
        return answer["return"]

    def start(self, command):
        """A line of shell that goes on by itself; for `ended`."""
        return self._call("guest-exec", path="/bin/sh", arg=["-c", f"exec 2>&1; {command}"],
                          **{"capture-output": True})["pid"]

    def ended(self, process):
        """Its answer, once; None while it goes on."""
        status = self._call("guest-exec-status", pid=process)
        if not status["exited"]:
            return None
        out = base64.b64decode(status.get("out-data", "")).decode(errors="replace")
        return Answer(status.get("exitcode", -status.get("signal", 0)), out)

    def run(self, command, timeout=60):
        """A line of shell; every failure but its own exit code raises."""
        process = self.start(command)
        deadline = time.monotonic() + timeout
        while time.monotonic() < deadline:
            answer = self.ended(process)
            if answer:
                return answer
            time.sleep(0.1)
        raise TimeoutError(f"the board took longer than {timeout} s for: {command}")

    def read(self, command, timeout=60):
        """What a line of shell prints; it must succeed."""
        answer = self.run(command, timeout)
        if answer.code != 0:
            raise RuntimeError(f"on the board, `{command}` ended with {answer.code}: {answer.out.strip()}")
        return answer.out.strip()

    def write(self, path, text):
        """A file of the board, whole."""
        self.read(f"printf %s {shlex.quote(text)} > {shlex.quote(path)}")

    def close(self):
        self._lines.close()
