# SPDX-License-Identifier: MIT
"""Driver of a Net F/T load cell: records by UDP at up to 7 kHz."""

import struct
from collections.abc import Sequence
from enum import IntEnum
from typing import Final, Self

import numpy as np

from rig.clock import SYSTEM_CLOCK, Clock
from rig.device import Counters
from rig.links.byte_link import LinkedStream
from rig.links.sequence import SequenceTracker, TimeUnwrapper
from rig.links.udp import UdpLink
from rig.sample_columns import SampleColumns
from rig.slip_rig.profile import LoadCellProfile

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


START_AGAIN_AFTER: Final = 0.5
"""Silence after which the start request is repeated, because requests can be lost [s]."""
LATE_DATAGRAMS: Final = 4
"""Distance behind the newest datagram up to which one counts as late or duplicate [datagrams].

Farther back it means a restart of the cell.
"""
WHOLE: Final = frozenset(RECORD.size * count for count in range(1, MOST_IN_ONE + 1))
"""Valid lengths of datagrams [bytes]."""


class NetFtCell(LinkedStream[UdpLink]):
    """Stream of a Net F/T load cell: counts Fx, Fy, Fz, Tx, Ty, Tz; status bits `STATUS_BITS`.

    Losses show as gaps in the record numbers. The device time counts the cell's own readings.
    Datagrams may hold one record or many, whatever was requested. Entering sends the start request,
    without waiting for an answer; leaving sends the stop request.

    Args:
        link: Datagrams to and from the cell.
        profile: Profile of the cell.
        buffered: Request many records in each datagram, which takes less CPU time but delays
            them by a few milliseconds: not for guards. From a cell that then sends nothing,
            single records are requested.
        clock: Host time.
    """

    def __init__(
        self,
        link: UdpLink,
        *,
        profile: LoadCellProfile,
        buffered: bool = False,
        clock: Clock = SYSTEM_CLOCK,
    ) -> None:
        super().__init__(link, name="load_cell", clock=clock)
        self.profile = profile
        self._start = Request.START_BUFFERED if buffered else Request.START
        self._tracker = SequenceTracker(
            modulus=WRAP, rate=profile.rate, late_window=LATE_DATAGRAMS * MOST_IN_ONE
        )
        self._device_time = TimeUnwrapper(modulus=WRAP, tick=1 / profile.rate)
        self._damaged = 0
        self._reconnected = 0
        self._last_arrival = 0.0
        self._silent = False

    @property
    def counters(self) -> Counters:
        """Counters of the stream so far; damaged counts datagrams, all others count records.

        Reconnected counts silences longer than `START_AGAIN_AFTER` that ended.
        """
        return Counters(
            received=self._received,
            lost=self._tracker.lost,
            damaged=self._damaged,
            repeated=self._tracker.repeated,
            reconnected=self._reconnected,
            restarted=self._tracker.restarted,
        )

    def read(self, timeout: float) -> SampleColumns:
        """Return all samples that have arrived, waiting at most `timeout` for the first [s].

        To a cell that has been silent for `START_AGAIN_AFTER` the start request is sent again.
        """
        datagrams = self._link.read(timeout)
        now = self._clock.now()
        samples = self._samples(datagrams, now)
        self._check_silence(bool(samples), now)
        self._received += len(samples)
        return samples

    def __enter__(self) -> Self:
        super().__enter__()
        self._last_arrival = self._clock.now()
        self._link.write(encode_request(self._start))
        return self

    def __exit__(self, *exception: object) -> None:
        self._link.write(encode_request(Request.STOP))
        super().__exit__(*exception)

    def _samples(self, datagrams: Sequence[bytes], now: float) -> SampleColumns:
        """Decode the records of datagrams read at host time `now` [s]; drop late or duplicate ones.

        Datagrams of an invalid length are counted as damaged.
        """
        whole = datagrams
        if not WHOLE.issuperset(map(len, datagrams)):
            whole = [datagram for datagram in datagrams if len(datagram) in WHOLE]
            self._damaged += len(datagrams) - len(whole)
        records = np.frombuffer(b"".join(whole), COLUMNS)
        kept, sequence = self._tracker.accept_all(records["number"], now)
        records = records[kept]
        return SampleColumns(
            host_time=np.full(len(records), now),
            device_time=self._device_time.unwrap_all(records["reading"]),
            sequence=sequence,
            status=records["status"].astype(np.uint32),
            channel=np.zeros(len(records), np.uint32),
            counts=records["counts"].astype(np.int32),
        )

    def _check_silence(self, heard: bool, now: float) -> None:
        """Repeat the start request after each `START_AGAIN_AFTER` of silence; count its ends.

        Before the first sample, single records are requested, and the silence is not counted.
        """
        if heard:
            self._last_arrival = now
            self._reconnected += self._silent
            self._silent = False
        elif now - self._last_arrival > START_AGAIN_AFTER:
            self._last_arrival = now
            self._silent = self._received > 0
            if not self._received:
                self._start = Request.START  # which every cell knows
            self._link.write(encode_request(self._start))
