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

HEADER: Final = struct.Struct("<BII")
CHECKSUM: Final = struct.Struct("<I")
WRAP: Final = 1 << 32
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
