"""What a UVC 1.0 camera tells about itself: USB descriptors and streaming parameters.

After "Universal Serial Bus Device Class Definition for Video Devices" 1.0a; section numbers below are of that document, and of
"Payload Motion-JPEG" and "Payload Uncompressed".
"""

import struct
from dataclasses import dataclass

VENDOR = 0x1D6B  # Linux Foundation
PRODUCT = 0x0102  # its webcam gadget
VERSION = 0x0100
MANUFACTURER = "facewire"
NAME = "Played Webcam"

CONTROL_INTERFACE = 0
STREAMING_INTERFACE = 1
CAMERA_TERMINAL = 1
OUTPUT_TERMINAL = 2
ENDPOINT = 0x81
PACKET_BYTES = 512  # of a high-speed bulk endpoint
# One answer of the device. 32 packets is the most that Linux asks for at once, so a payload is a transfer.
PAYLOAD_BYTES = 32 * PACKET_BYTES
PAYLOAD_HEADER_BYTES = 2

UNITS_PER_SECOND = 10_000_000  # frame intervals count 100 ns
RATES = (30, 15, 10)
YUYV_GUID = bytes.fromhex("5955593200001000800000aa00389b71")
INTERFACE_VIDEO, CONTROL_SUBCLASS, STREAMING_SUBCLASS, COLLECTION_SUBCLASS = 0x0E, 1, 2, 3
CLASS_SPECIFIC = 0x24

# Camera terminal controls (A.9.4): selector -> bytes, minimum, maximum, step, value at power-on. The exposure's priority is on
# at power-on, as in real cameras.
AUTO_EXPOSURE_MODE, AUTO_EXPOSURE_PRIORITY, EXPOSURE_TIME = 2, 3, 4
CONTROLS = {
    AUTO_EXPOSURE_MODE: (1, 1, 8, 9, 8),  # step: the modes there are, as bits (manual, aperture priority)
    AUTO_EXPOSURE_PRIORITY: (1, 0, 1, 1, 1),
    EXPOSURE_TIME: (4, 1, 5000, 1, 156),  # units of 100 us
}
CONTROL_BITS = 1 << 1 | 1 << 2 | 1 << 3  # bmControls of those three


@dataclass(frozen=True)
class Mode:
    """One format and size."""

    kind: str  # "mjpeg" or "yuyv"
    width: int
    height: int

    @property
    def most_bytes(self):
        return self.width * self.height * 2


def device():
    return struct.pack("<BBHBBBBHHHBBBB", 18, 1, 0x0200, 0xEF, 2, 1, 64, VENDOR, PRODUCT, VERSION, 1, 2, 3, 1)


def string(index, serial):
    """None for one that there is not."""
    if index == 0:
        return struct.pack("<BBH", 4, 3, 0x0409)
    texts = (MANUFACTURER, NAME, serial)
    if index > len(texts):
        return None
    text = texts[index - 1].encode("utf-16-le")
    return struct.pack("<BB", 2 + len(text), 3) + text


def _specific(subtype, body):
    return struct.pack("<BBB", 3 + len(body), CLASS_SPECIFIC, subtype) + body


def _interface(number, endpoints, subclass):
    return struct.pack("<BBBBBBBBB", 9, 4, number, 0, endpoints, INTERFACE_VIDEO, subclass, 0, 0)


def _frame(subtype, index, mode):
    intervals = [UNITS_PER_SECOND // rate for rate in RATES]
    bits = [8 * mode.most_bytes * rate for rate in (RATES[-1], RATES[0])]
    body = struct.pack("<BBHHIIIIB", index, 0, mode.width, mode.height, *bits, mode.most_bytes, intervals[0], len(intervals))
    return _specific(subtype, body + struct.pack(f"<{len(intervals)}I", *intervals))


def _format(index, modes):
    """3.9.2.3: a format's descriptor, its frames', its colours'."""
    if modes[0].kind == "mjpeg":
        text = _specific(6, struct.pack("<BBBBBBBB", index, len(modes), 0, 1, 0, 0, 0, 0))
        frame = 7
    else:
        text = _specific(4, struct.pack("<BB16sBBBBBB", index, len(modes), YUYV_GUID, 16, 1, 0, 0, 0, 0))
        frame = 5
    text += b"".join(_frame(frame, i + 1, mode) for i, mode in enumerate(modes))
    return text + _specific(13, bytes((1, 1, 4)))  # sRGB, BT.709, SMPTE 170M


def configuration(formats):
    """`formats`: one list of modes a format."""
    terminals = _specific(2, struct.pack("<BHBBHHHB", CAMERA_TERMINAL, 0x0201, 0, 0, 0, 0, 0, 3) + CONTROL_BITS.to_bytes(3, "little"))
    terminals += _specific(3, struct.pack("<BHBBB", OUTPUT_TERMINAL, 0x0101, 0, CAMERA_TERMINAL, 0))
    header_bytes = 13
    control = _specific(1, struct.pack("<HHIBB", 0x0100, header_bytes + len(terminals), 48_000_000, 1, STREAMING_INTERFACE))
    described = b"".join(_format(i + 1, modes) for i, modes in enumerate(formats))
    total = 13 + len(formats) + len(described)
    stream = _specific(
        1, struct.pack("<BHBBBBBBB", len(formats), total, ENDPOINT, 0, OUTPUT_TERMINAL, 0, 0, 0, 1) + bytes(len(formats))
    )
    body = struct.pack("<BBBBBBBB", 8, 11, CONTROL_INTERFACE, 2, INTERFACE_VIDEO, COLLECTION_SUBCLASS, 0, 0)
    body += _interface(CONTROL_INTERFACE, 0, CONTROL_SUBCLASS) + control + terminals
    body += _interface(STREAMING_INTERFACE, 1, STREAMING_SUBCLASS) + stream + described
    body += struct.pack("<BBBBHB", 7, 5, ENDPOINT, 2, PACKET_BYTES, 0)
    return struct.pack("<BBHBBBBB", 9, 2, 9 + len(body), 2, 1, 0, 0x80, 250) + body


PROBE = struct.Struct("<HBBIHHHHHII")  # 4.3.1.1, version 1.0


def parameters(format_index, frame_index, interval, mode):
    return PROBE.pack(0, format_index, frame_index, interval, 0, 0, 0, 0, 0, mode.most_bytes, PAYLOAD_BYTES)
