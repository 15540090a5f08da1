# SPDX-License-Identifier: MIT
"""This project's own frame for a serial bridge: kind, number, device time, body, CRC-32, in COBS.

========  =======  =====================================================
offset    type     what
========  =======  =====================================================
0         uint8    kind of packet, `Kind`
1         uint32   sequence number, from 0, wraps
5         uint32   device time [µs], wraps after 71.6 min
9         ...      body, as the kind has it
-4        uint32   CRC-32 (zlib's) of all before it
========  =======  =====================================================

Little-endian; the whole is stuffed by COBS and ended by a zero byte.
"""

import struct
import zlib
from enum import IntEnum
from typing import Final, NamedTuple

from cobs import cobs

from rig.errors import ProtocolError

DELIMITER: Final = b"\0"


class CobsFramer:
    """Frames of consistent overhead byte stuffing (COBS), each ended by a zero byte.

    COBS removes zeros from a frame, so that a zero always marks its end: the frame after a damaged
    one is read correctly. The bytes before the first zero may be the tail of a frame that was sent
    while the port was opened, and are not counted as damaged.

    Args:
        longest: Longest encoded frame of the protocol, without its zero; longer ones are damaged
            [bytes].

    Attributes:
        damaged: Number of damaged frames so far.
        resynchronised: Number of times that a good frame followed damaged ones.
    """

    def __init__(self, *, longest: int) -> None:
        self.damaged = 0
        self.resynchronised = 0
        self._longest = longest
        self._tail = b""
        self._joined = False  # whether a zero has arrived, after which whole frames follow
        self._out_of_sync = False

    def feed(self, data: bytes) -> list[bytes]:
        """Add received bytes and return the decoded content of the frames that are now complete.

        Damaged frames are counted and left out. The caller calls `accept` or `refuse` for each
        content.
        """
        *pieces, tail = (self._tail + data).split(DELIMITER)
        self._tail = tail
        if len(tail) > self._longest:  # bounds the memory for noise without an end
            self._tail = tail[-self._longest - 1 :]
        return [payload for piece in pieces if (payload := self._decode(piece)) is not None]

    def reset(self) -> None:
        """Discard an incomplete frame, as after a reconnection.

        The bytes before the next zero are then not counted as damaged.
        """
        self._tail = b""
        self._joined = False

    def refuse(self) -> None:
        """Count a frame as damaged, for example one with valid stuffing and invalid content."""
        self.damaged += 1
        self._out_of_sync = True

    def accept(self) -> None:
        """Register a good frame: a resynchronisation where the frame before was damaged."""
        self.resynchronised += self._out_of_sync
        self._out_of_sync = False

    def _decode(self, piece: bytes) -> bytes | None:
        """Decode the bytes between two zeros; None where they are damaged or empty.

        Damaged ones are counted, but not those before the first zero.
        """
        joined, self._joined = self._joined, True
        if not piece:  # two ends in a row: a sender may begin with one to end noise
            return None
        try:
            if len(piece) <= self._longest:
                return cobs.decode(piece)
        except cobs.DecodeError:
            pass
        if joined:
            self.refuse()
        return None


class TrailerFramer:
    """Frames of fixed length that all end in the same bytes and have no checksum.

    A frame is accepted where a trailer is both directly before it and at its end. Truncated, merged
    and interrupted frames are thereby discarded. A flipped bit between two trailers is not
    detected, a weakness of the format.

    Args:
        length: Length of a frame with its trailer [bytes].
        trailer: Last bytes of every frame.

    Attributes:
        damaged: Number of times that a frame did not end in the trailer.
        resynchronised: Number of times that a good frame followed damaged ones.
    """

    def __init__(self, *, length: int, trailer: bytes) -> None:
        self.damaged = 0
        self.resynchronised = 0
        self._length = length
        self._trailer = trailer
        self._buffer = b""
        self._aligned = False
        self._out_of_sync = False

    def feed(self, data: bytes) -> list[bytes]:
        """Add received bytes and return the frames that are now complete, without trailers.

        Bytes before the first trailer, and after a damaged frame up to the next, are discarded.
        """
        self._buffer += data
        frames: list[bytes] = []
        while self._aligned or self._align():
            if len(self._buffer) < self._length:
                break
            if not self._buffer[: self._length].endswith(self._trailer):
                self._lose_alignment()
                continue
            frames.append(self._buffer[: self._length - len(self._trailer)])
            self._buffer = self._buffer[self._length :]
            self.resynchronised += self._out_of_sync
            self._out_of_sync = False
        return frames

    def reset(self) -> None:
        """Discard an incomplete frame and search for the next trailer, as after a reconnection."""
        self._buffer = b""
        self._aligned = False

    def _lose_alignment(self) -> None:
        """Count a frame without its trailer as damaged; the next trailer must be found."""
        self.damaged += 1
        self._out_of_sync = True
        self._aligned = False

    def _align(self) -> bool:
        """Discard bytes up to and including the next trailer; return whether there was one."""
        found = self._buffer.find(self._trailer)
        if found < 0:
            self._buffer = self._buffer[-len(self._trailer) + 1 :]
            return False
        self._buffer = self._buffer[found + len(self._trailer) :]
        self._aligned = True
        return True


HEADER: Final = struct.Struct("<BII")
CHECKSUM: Final = struct.Struct("<I")
WRAP: Final = 1 << 32
"""Modulus of the sequence number and of the device time [ticks]."""
TICK: Final = 1e-6
"""One tick of the device time [s]."""
LONGEST_BODY: Final = 200
"""Longest body of a packet [bytes]."""


class Kind(IntEnum):
    """Kind of a packet: below 16 from the device, from 16 to the device."""

    LEGS = 1
    ORIENTATION = 2
    SLIP_RIG = 3
    LEG_SET_POINTS = 16
    DISC_SPEEDS = 17
    STOP = 31


class Packet(NamedTuple):
    """Content of one frame, without checksum.

    Attributes:
        kind: Kind of packet, one of `Kind` or an unknown number, 0 to 255.
        sequence: Number of the packet, modulo 2³².
        ticks: Device time, modulo 2³² [µs].
        body: Content, whose layout depends on the kind.
    """

    kind: int
    sequence: int
    ticks: int
    body: bytes


def encode_packet(packet: Packet) -> bytes:
    """Encode one packet with its checksum, COBS stuffing and end.

    Args:
        packet: Packet; sequence number and ticks are taken modulo 2³².

    Returns:
        Stuffed bytes, ended by a zero byte.

    Raises:
        ProtocolError: The body is longer than a packet can hold.
    """
    if len(packet.body) > LONGEST_BODY:
        raise ProtocolError(
            f"a packet body has {len(packet.body)} bytes; expected at most {LONGEST_BODY}"
        )
    head = HEADER.pack(packet.kind, packet.sequence % WRAP, packet.ticks % WRAP)
    content = head + packet.body
    return cobs.encode(content + CHECKSUM.pack(zlib.crc32(content))) + b"\0"


def decode_packet(content: bytes) -> Packet | None:
    r"""Decode one unstuffed packet; None where it is too short or its checksum is wrong.

    >>> wire = encode_packet(Packet(Kind.LEGS, 7, 20_000, bytes(range(6))))
    >>> decode_packet(cobs.decode(wire[:-1]))
    Packet(kind=1, sequence=7, ticks=20000, body=b'\x00\x01\x02\x03\x04\x05')
    """
    if len(content) < HEADER.size + CHECKSUM.size:
        return None
    (checksum,) = CHECKSUM.unpack_from(content, len(content) - CHECKSUM.size)
    if zlib.crc32(memoryview(content)[: -CHECKSUM.size]) != checksum:
        return None
    kind, sequence, ticks = HEADER.unpack_from(content)
    return Packet(kind, sequence, ticks, content[HEADER.size : -CHECKSUM.size])
