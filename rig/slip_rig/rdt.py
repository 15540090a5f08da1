# SPDX-License-Identifier: MIT
"""Raw data transfer of a Net F/T load cell: requests, records, status bits, all big-endian."""

import struct
from enum import IntEnum
from typing import Final

import numpy as np

REQUEST: Final = struct.Struct(">HHI")
"""`MAGIC`, `Request`, number of records (0 for no end)."""
RECORD: Final = struct.Struct(">III6i")
"""Number of the record, number of the reading inside the cell, status, Fx Fy Fz Tx Ty Tz."""
COLUMNS: Final = np.dtype(
    [("number", ">u4"), ("reading", ">u4"), ("status", ">u4"), ("counts", ">i4", 6)]
)
"""Fields of a record as a structured array, to decode many records at once."""
MAGIC: Final = 0x1234
WRAP: Final = 1 << 32
SATURATED: Final = 1 << 17
"""Status bit of a saturated transducer."""
MOST_IN_ONE: Final = 40
"""Largest number of records in a datagram of a buffered stream."""

STATUS_BITS: Final[dict[int, str]] = {
    1 << 30: "processor or memory error",
    1 << 29: "digital board error",
    1 << 28: "analog board error",
    1 << 27: "serial link error",
    1 << 26: "program memory error",
    1 << 25: "halted by configuration errors",
    1 << 24: "settings invalid",
    1 << 23: "settings do not fit the transducer",
    1 << 22: "network error",
    1 << 21: "CAN error",
    1 << 20: "RDT error",
    SATURATED: "transducer saturated",
    1 << 16: "monitor condition latched",
    1 << 14: "watchdog timeout",
}
"""Meaning of the status bits; bit 31 is set with any of them."""


class Request(IntEnum):
    """Requests to a cell, the second field of `REQUEST`.

    START sends each record as soon as it is read. START_BUFFERED sends as many in a datagram as the
    cell is set to (`comrdtbsiz`, 1 to 40), as soon as the last of them is read.
    """

    STOP = 0x0000
    START = 0x0002
    START_BUFFERED = 0x0003


def encode_request(request: Request) -> bytes:
    """Encode a request as a datagram; after a start request, records come until `STOP`.

    Args:
        request: Kind of request.

    >>> encode_request(Request.START).hex()
    '1234000200000000'
    """
    return REQUEST.pack(MAGIC, request, 0)


def describe_status(status: int) -> str:
    """Describe the set bits of a status word as text, joined by commas; empty without a fault.

    Bit 31, which any fault sets, is left out; unknown bits add the whole word in hexadecimal.

    >>> describe_status(0x80020000)
    'transducer saturated'
    """
    names = [name for bit, name in STATUS_BITS.items() if status & bit]
    known = (1 << 31) | sum(STATUS_BITS)
    return ", ".join(names + ([f"status {status:#010x}"] if status & ~known else []))
