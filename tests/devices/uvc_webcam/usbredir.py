"""The side of the usbredir protocol that owns a USB device, as far as a camera with one bulk endpoint needs it.

The protocol: packets of type, length and id, all little-endian, over any byte stream. The far side (QEMU's usb-redir) says
hello, learns the device's endpoints and interfaces, and then sends the requests that its guest makes.
"""

import struct

# Types of packets.
HELLO = 0
DEVICE_CONNECT = 1
DEVICE_DISCONNECT = 2
RESET = 3
INTERFACE_INFO = 4
EP_INFO = 5
SET_CONFIGURATION = 6
GET_CONFIGURATION = 7
CONFIGURATION_STATUS = 8
SET_ALT_SETTING = 9
GET_ALT_SETTING = 10
ALT_SETTING_STATUS = 11
CANCEL_DATA_PACKET = 21
CONTROL_PACKET = 100
BULK_PACKET = 101

# Statuses of answers.
SUCCESS = 0
CANCELLED = 1
STALL = 4

SPEED_HIGH = 2
TYPE_CONTROL = 0
TYPE_BULK = 2
TYPE_INVALID = 255

# Capabilities, as bits: device_connect with a version, ep_info with packet sizes, 64-bit ids, 32-bit bulk lengths. QEMU's
# XHCI controller takes no device without the last three.
CAPABILITIES = 1 << 1 | 1 << 4 | 1 << 5 | 1 << 6

HELLO_HEADER = struct.Struct("<III")  # ids have 32 bits until both sides have said hello
HEADER = struct.Struct("<IIQ")
CONTROL = struct.Struct("<BBBBHHH")  # endpoint, request, request type, status, value, index, length
BULK = struct.Struct("<BBHIH")  # endpoint, status, length, stream, length's upper half
LONGEST_PACKET = 1 << 20  # nothing that a camera is asked comes near


class ProtocolError(Exception):
    pass


class Framing:
    """Bytes of one connection to packets and back."""

    def __init__(self):
        self._received = bytearray()
        self._greeted = False

    @staticmethod
    def hello(name):
        body = name.encode().ljust(64, b"\0") + struct.pack("<I", CAPABILITIES)
        return HELLO_HEADER.pack(HELLO, len(body), 0) + body

    @staticmethod
    def packet(kind, body=b"", ident=0):
        return HEADER.pack(kind, len(body), ident) + body

    def feed(self, data):
        """Yields (type, id, body) for every packet that is complete. ProtocolError for what no far side would send."""
        self._received += data
        while True:
            header = HEADER if self._greeted else HELLO_HEADER
            if len(self._received) < header.size:
                return
            kind, length, ident = header.unpack_from(self._received)
            if (kind == HELLO) == self._greeted or length > LONGEST_PACKET:
                raise ProtocolError(f"a packet of type {kind} and {length} bytes {'after' if self._greeted else 'before'} hello")
            if len(self._received) < header.size + length:
                return
            body = bytes(self._received[header.size : header.size + length])
            del self._received[: header.size + length]
            if kind == HELLO:
                (capabilities,) = struct.unpack_from("<I", body.ljust(68, b"\0"), 64)
                if capabilities & CAPABILITIES != CAPABILITIES:
                    raise ProtocolError(f"the far side's capabilities {capabilities:#x} lack some of {CAPABILITIES:#x}")
                self._greeted = True
            yield kind, ident, body
