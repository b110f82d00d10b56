"""A UVC camera without the USB: answers control requests, cuts pictures into payloads when their time comes."""

import re
import struct

import descriptors as uvc

IN = 0x80
# Standard requests (device or endpoint), then those of the class.
CLEAR_FEATURE, GET_STATUS, SET_FEATURE, GET_DESCRIPTOR = 1, 0, 3, 6
SET_CUR, GET_CUR, GET_MIN, GET_MAX, GET_RES, GET_LEN, GET_INFO, GET_DEF = 0x01, 0x81, 0x82, 0x83, 0x84, 0x85, 0x86, 0x87
PROBE, COMMIT = 1, 2
CAN_GET_AND_SET = 3
END_OF_FRAME, END_OF_HEADER = 0x02, 0x80


class Stalled(Exception):
    """The device's way to say that it knows no such request."""


def load_pictures(folder):
    """{mode: [bytes, ...]} of the folders mjpeg-WxH and yuyv-WxH, in the order of their file names. ValueError says what is wrong."""
    pictures = {}
    for sub in sorted(folder.iterdir()):
        name = re.fullmatch(r"(mjpeg|yuyv)-([1-9]\d{0,3})x([1-9]\d{0,3})", sub.name)
        if not name:
            continue
        mode = uvc.Mode(name[1], int(name[2]), int(name[3]))
        files = sorted(path for path in sub.iterdir() if path.is_file())
        if not files:
            raise ValueError(f"{sub} is empty")
        pictures[mode] = [path.read_bytes() for path in files]
        for path, data in zip(files, pictures[mode]):
            if mode.kind == "yuyv" and len(data) != mode.most_bytes:
                raise ValueError(f"{path} has {len(data)} bytes; {sub.name} takes {mode.most_bytes}")
            if mode.kind == "mjpeg" and (data[:2] != b"\xff\xd8" or len(data) > mode.most_bytes):
                raise ValueError(f"{path} is no JPEG file of at most {mode.most_bytes} bytes")
    if not pictures:
        raise ValueError(f"{folder} holds no folder mjpeg-WxH or yuyv-WxH")
    return pictures


class Camera:
    def __init__(self, pictures, serial):
        self.serial = serial
        self.stalled = False  # sends nothing and reports no error
        self.rate = None  # pictures a second whatever was negotiated, or None
        self.damage_left = 0
        self.sent = 0  # pictures since the program began
        self._pictures = pictures
        # The largest picture is not the best to begin with: 640x480 first where there is one.
        kinds = {kind: sorted((m for m in pictures if m.kind == kind), key=lambda m: (m.width != 640, m.width, m.height))
                 for kind in ("mjpeg", "yuyv")}
        self._formats = [modes for modes in kinds.values() if modes]
        self.power_on()

    def power_on(self):
        """As after plugging in, and after a reset of the bus."""
        self.controls = {selector: control[4] for selector, control in uvc.CONTROLS.items()}
        self._probe = self._commit = self._negotiate(b"")
        self.stop()

    @property
    def mode(self):
        _, form, frame, *_ = uvc.PROBE.unpack(self._commit)
        return self._formats[form - 1][frame - 1]

    @property
    def streaming(self):
        return self._due is not None

    # --- control requests

    def control(self, kind, request, value, index, length, data):
        """The answer to a request that reads, b"" to one that writes. Stalled."""
        if kind & 0x60 == 0:
            return self._standard(kind, request, value, index)[:length]
        entity, interface = index >> 8, index & 0xFF
        if interface == uvc.STREAMING_INTERFACE and entity == 0 and value >> 8 in (PROBE, COMMIT):
            return self._stream_control(request, value >> 8, data)[:length]
        if interface == uvc.CONTROL_INTERFACE and entity == uvc.CAMERA_TERMINAL and value >> 8 in uvc.CONTROLS:
            return self._camera_control(request, value >> 8, data)[:length]
        raise Stalled

    def _standard(self, kind, request, value, index):
        if request == GET_DESCRIPTOR and kind == IN:
            answer = {1: uvc.device(), 2: uvc.configuration(self._formats), 3: uvc.string(value & 0xFF, self.serial)}.get(value >> 8)
            if answer is not None:
                return answer
        elif request == GET_STATUS:
            return bytes(2)
        elif request in (CLEAR_FEATURE, SET_FEATURE):
            # Clearing the endpoint's halt is how Linux ends a stream over a bulk endpoint.
            if kind == 2 and index == uvc.ENDPOINT:
                self.stop()
            return b""
        raise Stalled

    def _negotiate(self, wanted):
        """4.3.1.1: what is possible of what is wanted."""
        _, form, frame, interval, *_ = uvc.PROBE.unpack(wanted[: uvc.PROBE.size].ljust(uvc.PROBE.size, b"\0"))
        form = min(max(form, 1), len(self._formats))
        frame = min(max(frame, 1), len(self._formats[form - 1]))
        intervals = [uvc.UNITS_PER_SECOND // rate for rate in uvc.RATES]
        interval = min(intervals, key=lambda i: abs(i - interval)) if interval else intervals[0]
        return uvc.parameters(form, frame, interval, self._formats[form - 1][frame - 1])

    def _stream_control(self, request, selector, data):
        if request == SET_CUR:
            self._probe = self._negotiate(data)
            if selector == COMMIT:
                self._commit = self._probe
                self.stop()
            return b""
        answers = {
            GET_CUR: self._probe if selector == PROBE else self._commit,
            GET_MIN: self._probe,
            GET_MAX: self._probe,
            GET_DEF: self._negotiate(b""),
            GET_LEN: struct.pack("<H", uvc.PROBE.size),
            GET_INFO: bytes((CAN_GET_AND_SET,)),
        }
        if request not in answers:
            raise Stalled
        return answers[request]

    def _camera_control(self, request, selector, data):
        size, low, high, step, default = uvc.CONTROLS[selector]
        if request == SET_CUR:
            value = int.from_bytes(data[:size], "little")
            if not low <= value <= high:
                raise Stalled
            self.controls[selector] = value
            return b""
        if request == GET_LEN:
            return struct.pack("<H", size)
        if request == GET_INFO:
            return bytes((CAN_GET_AND_SET,))
        numbers = {GET_CUR: self.controls[selector], GET_MIN: low, GET_MAX: high, GET_RES: step, GET_DEF: default}
        if request not in numbers:
            raise Stalled
        return numbers[request].to_bytes(size, "little")

    # --- the stream

    def stop(self):
        self._due = None
        self._payloads = []
        self._next = 0
        self._toggle = 0

    def wanted_at(self, now):
        """When the stream, which somebody reads, has something to say; None: not before something changes."""
        if self.stalled:
            return None
        if self._payloads:
            return now
        if self._due is None:
            self._due = now
        return self._due

    def payload(self, now):
        """The next payload. Only when wanted_at() has come."""
        if not self._payloads:
            self._begin_picture(now)
        return self._payloads.pop(0)

    def _begin_picture(self, now):
        interval = uvc.PROBE.unpack(self._commit)[3]
        period = 1 / self.rate if self.rate else interval / uvc.UNITS_PER_SECOND
        # A reader that was slow gets the next picture at once, but not all that it has missed.
        self._due = max(self._due + period, now)
        mode = self.mode
        pictures = self._pictures[mode]
        data = pictures[self._next % len(pictures)]
        self._next += 1
        self.sent += 1
        if self.damage_left:
            self.damage_left -= 1
            data = data[: len(data) // 2]  # what is left when a cable loses packets
        room = uvc.PAYLOAD_BYTES - uvc.PAYLOAD_HEADER_BYTES
        parts = [data[at : at + room] for at in range(0, len(data), room)]
        last = len(parts) - 1
        self._payloads = [
            bytes((uvc.PAYLOAD_HEADER_BYTES, self._toggle | END_OF_HEADER | (END_OF_FRAME if i == last else 0))) + part
            for i, part in enumerate(parts)
        ]
        self._toggle ^= 1
