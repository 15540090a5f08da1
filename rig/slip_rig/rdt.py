# SPDX-License-Identifier: MIT
"""Raw data transfer of a Net F/T load cell: requests, records, status bits, all big-endian."""

import re
import struct
from dataclasses import dataclass
from enum import IntEnum
from typing import Final

import numpy as np

from rig.errors import ProtocolError

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

FORCE_UNITS: Final = {"N": 1.0, "kN": 1e3, "lb": 4.4482216152605, "klb": 4448.2216152605,
                      "g": 9.80665e-3, "kg": 9.80665}  # fmt: skip
"""Size of each force unit of the cell's configuration [N]."""


class Request(IntEnum):
    """Requests to a cell, the second field of `REQUEST`; BIAS makes the present reading zero.

    START sends each record as soon as it is read. START_BUFFERED sends as many in a datagram as the
    cell is set to (`comrdtbsiz`, 1 to 40), as soon as the last of them is read.
    """

    STOP = 0x0000
    START = 0x0002
    START_BUFFERED = 0x0003
    BIAS = 0x0042


@dataclass(frozen=True)
class CellConfiguration:
    """Configuration that a cell reports.

    Attributes:
        counts_per_force: Counts per newton [1/N].
        rate: Records per second; None where the page does not give it [Hz].
    """

    counts_per_force: float
    rate: float | None


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


def parse_configuration(page: bytes) -> CellConfiguration:
    """Read a cell's configuration page, `http://CELL/netftapi2.xml`.

    The values are searched for by name, without a parser of XML, which might expand entities
    or follow references in a page from the network.

    Args:
        page: Content of the page.

    Returns:
        Counts per newton, converted from the cell's force unit, and the record rate.

    Raises:
        ProtocolError: Counts or force unit are missing, the unit is unknown, or a number is not
            above 0.
    """
    counts = _number(page, "cfgcpf")
    unit = _text(page, "scfgfu")
    if unit not in FORCE_UNITS:
        raise ProtocolError(
            f"the load cell's force unit is {unit!r}; expected one of {', '.join(FORCE_UNITS)}"
        )
    rate = _number(page, "comrdtrate") if b"<comrdtrate>" in page else None
    return CellConfiguration(counts / FORCE_UNITS[unit], rate)


def _text(page: bytes, tag: str) -> str:
    found = re.search(rf"<{tag}>\s*([^<]{{1,64}}?)\s*</{tag}>".encode(), page)
    if found is None:
        raise ProtocolError(
            f"the load cell's configuration page has no <{tag}>; is it a Net F/T's netftapi2.xml?"
        )
    return found.group(1).decode("ascii", "replace")


def _number(page: bytes, tag: str) -> float:
    text = _text(page, tag)
    if not re.fullmatch(r"\d+(\.\d+)?", text) or not float(text) > 0:
        raise ProtocolError(f"the load cell's <{tag}> is {text!r}; expected a number above 0")
    return float(text)
