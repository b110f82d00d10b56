"""Receivers of the three protocols, made from their publishers' pages and not from facewire.

Each has a UDP socket of its own. VMC is read by Debian's liblo.
"""
import math
import re
import socket
import struct

import liblo

SECONDS = 10  # a datagram on the loopback that takes longer is lost


class VmcReceiver:
    """One frame: every message up to /VMC/Ext/Blend/Apply."""

    TYPES = {"/VMC/Ext/OK": "iiii", "/VMC/Ext/T": "f", "/VMC/Ext/Bone/Pos": "sfffffff",
             "/VMC/Ext/Blend/Val": "sf", "/VMC/Ext/Blend/Apply": ""}

    def __init__(self):
        self.server = liblo.Server()
        self.port = self.server.port
        self.server.add_method(None, None, self._take)
        self.problems = []
        self._clear()

    def _clear(self):
        self.ok, self.time, self.bones, self.blends, self.applied = None, None, {}, {}, False

    def _take(self, path, arguments, types):
        if self.TYPES.get(path) != types:
            self.problems.append(f"{path} {types}")
        elif path == "/VMC/Ext/OK":
            self.ok = tuple(arguments)
        elif path == "/VMC/Ext/T":
            self.time = arguments[0]
        elif path == "/VMC/Ext/Bone/Pos":
            self.bones[arguments[0]] = (arguments[1:4], arguments[4:8])
        elif path == "/VMC/Ext/Blend/Val":
            self.blends[arguments[0]] = arguments[1]
        else:
            self.applied = True

    def frame(self):
        self._clear()
        while not self.applied:
            assert self.server.recv(SECONDS * 1000), "no VMC datagram came"
        assert not self.problems, self.problems
        return self


def udp_socket(family, address):
    s = socket.socket(family, socket.SOCK_DGRAM)
    s.bind((address, 0))
    s.settimeout(SECONDS)
    return s


class LiveLinkReceiver:
    SHAPES = ("EyeBlinkLeft EyeLookDownLeft EyeLookInLeft EyeLookOutLeft EyeLookUpLeft EyeSquintLeft EyeWideLeft "
              "EyeBlinkRight EyeLookDownRight EyeLookInRight EyeLookOutRight EyeLookUpRight EyeSquintRight EyeWideRight "
              "JawForward JawLeft JawRight JawOpen MouthClose MouthFunnel MouthPucker MouthLeft MouthRight "
              "MouthSmileLeft MouthSmileRight MouthFrownLeft MouthFrownRight MouthDimpleLeft MouthDimpleRight "
              "MouthStretchLeft MouthStretchRight MouthRollLower MouthRollUpper MouthShrugLower MouthShrugUpper "
              "MouthPressLeft MouthPressRight MouthLowerDownLeft MouthLowerDownRight MouthUpperUpLeft MouthUpperUpRight "
              "BrowDownLeft BrowDownRight BrowInnerUp BrowOuterUpLeft BrowOuterUpRight CheekPuff CheekSquintLeft "
              "CheekSquintRight NoseSneerLeft NoseSneerRight TongueOut").split()
    TURNS = [f"{what}{axis}" for what in ("Head", "LeftEye", "RightEye") for axis in ("Yaw", "Pitch", "Roll")]

    def __init__(self, family=socket.AF_INET, address="127.0.0.1"):
        self.socket = udp_socket(family, address)
        self.port = self.socket.getsockname()[1]

    def frame(self):
        data = self.socket.recv(2048)
        at = 0

        def take(layout):
            nonlocal at
            values = struct.unpack_from(">" + layout, data, at)
            at += struct.calcsize(">" + layout)
            return values[0]

        assert take("B") == 6
        device_id = take(f"{take('i')}s").decode()
        name = take(f"{take('i')}s").decode()
        frame, subframe, rate, denominator = take("i"), take("f"), take("i"), take("i")
        assert 0 <= subframe < 1
        values = None
        if at < len(data):
            assert take("B") == 61
            values = {key: take("f") for key in self.SHAPES + self.TURNS}
            assert all(math.isfinite(v) for v in values.values())
        assert at == len(data), "bytes are left over"
        return {"id": device_id, "name": name, "seconds": (frame + subframe) * denominator / rate,
                "values": values}


class IFacialMocapReceiver:
    def __init__(self):
        self.socket = udp_socket(socket.AF_INET, "127.0.0.1")
        self.port = self.socket.getsockname()[1]

    def frame(self, separator="-"):
        text = self.socket.recv(4096).decode("ascii")
        shapes, turns = text.split("|=")
        result = {}
        for item in shapes.split("|"):
            name, value = item.split(separator)
            assert re.fullmatch(r"[0-9]+", value) and 0 <= int(value) <= 100, item
            assert name not in result, name
            result[name] = int(value)
        items = turns.split("|")
        assert items.pop() == "", "the line ends with |"
        for item in items:
            what, numbers = item.split("#")
            result[what] = [float(n) for n in numbers.split(",")]
        assert len(result["head"]) == 6 and len(result["leftEye"]) == len(result["rightEye"]) == 3
        return result
