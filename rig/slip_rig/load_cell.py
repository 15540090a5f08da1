# SPDX-License-Identifier: MIT
"""Driver of a Net F/T load cell: records by UDP at up to 7 kHz."""

from collections.abc import Sequence
from typing import Final, Self

import numpy as np

from rig.clock import SYSTEM_CLOCK, Clock
from rig.device import Counters
from rig.links.byte_link import LinkedStream
from rig.links.sequence import SequenceTracker, TimeUnwrapper
from rig.links.udp import UdpLink
from rig.sample_columns import SampleColumns
from rig.slip_rig.profile import LoadCellProfile
from rig.slip_rig.rdt import (
    COLUMNS,
    MOST_IN_ONE,
    RECORD,
    WRAP,
    Request,
    encode_request,
)

START_AGAIN_AFTER: Final = 0.5
"""Silence after which the start request is repeated, because requests can be lost [s]."""
LATE_DATAGRAMS: Final = 4
"""Distance behind the newest datagram up to which one counts as late or duplicate [datagrams].

Farther back it means a restart of the cell.
"""
WHOLE: Final = frozenset(RECORD.size * count for count in range(1, MOST_IN_ONE + 1))
"""Valid lengths of datagrams [bytes]."""


class NetFtCell(LinkedStream[UdpLink]):
    """Stream of a Net F/T load cell: counts are Fx, Fy, Fz, Tx, Ty, Tz; status as in `rdt`.

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
