# SPDX-License-Identifier: MIT
"""A Net F/T load cell: records by UDP at up to 7 kHz, zero, and counts to newtons."""

import http.client
from collections.abc import Sequence
from functools import partial
from itertools import repeat
from types import TracebackType
from typing import Final, Self

from rig.clock import SYSTEM_CLOCK, Clock
from rig.device import Counters, Sample
from rig.errors import LinkError
from rig.links.sequence import SequenceTracker, TimeUnwrapper
from rig.links.udp import UdpLink
from rig.slip_rig.profile import LoadCellProfile
from rig.slip_rig.rdt import (
    COUNTS,
    HEAD,
    RECORD,
    WRAP,
    CellConfiguration,
    Request,
    encode_request,
    parse_configuration,
)

START_AGAIN_AFTER: Final = 0.5
"""Silence after which a cell is asked to start once more: requests, too, may be lost [s]."""
LONGEST_PAGE: Final = 1 << 20
_SAMPLE: Final = partial(tuple.__new__, Sample)
"""Makes a sample of its fields' tuple without a call in Python, 7,000 times a second."""


class NetFtCell:
    """Stream of a Net F/T load cell: counts are Fx, Fy, Fz, Tx, Ty, Tz; status as in `rdt`.

    Losses show as gaps in the record numbers. The device time counts the cell's own readings.

    Args:
        link: Datagrams to and from the cell.
        profile: Its profile.
        name: Name of the stream.
        clock: Host time.
    """

    def __init__(
        self,
        link: UdpLink,
        *,
        profile: LoadCellProfile,
        name: str = "load_cell",
        clock: Clock = SYSTEM_CLOCK,
    ) -> None:
        self.name = name
        self.profile = profile
        self._link = link
        self._clock = clock
        self._tracker = SequenceTracker(modulus=WRAP, rate=profile.rate)
        self._device_time = TimeUnwrapper(modulus=WRAP, tick=1 / profile.rate)
        self._received = 0
        self._damaged = 0
        self._reconnected = 0
        self._heard = 0.0
        self._silent = False

    @property
    def source(self) -> str:
        """Where the samples come from."""
        return self._link.source

    @property
    def counters(self) -> Counters:
        """What happened so far; reconnected counts silences that ended."""
        return Counters(
            received=self._received,
            lost=self._tracker.lost,
            damaged=self._damaged,
            repeated=self._tracker.repeated,
            reconnected=self._reconnected,
            restarted=self._tracker.restarted,
        )

    def read(self, timeout: float) -> list[Sample]:
        """Hand on all samples that have arrived, waiting at most `timeout` for the first [s]."""
        datagrams = self._link.read(timeout)
        now = self._clock.now()
        samples = self._samples(datagrams, now)
        self._listen(bool(samples), now)
        self._received += len(samples)
        return samples

    def bias(self) -> None:
        """Make what the cell reads now its zero; the cell itself subtracts it from then on."""
        self._link.write(encode_request(Request.BIAS))

    def __enter__(self) -> Self:
        self._link.open()
        self._heard = self._clock.now()
        self._link.write(encode_request(Request.START))
        return self

    def __exit__(
        self,
        kind: type[BaseException] | None,
        error: BaseException | None,
        trace: TracebackType | None,
    ) -> None:
        self._link.write(encode_request(Request.STOP))
        self._link.close()

    def _samples(self, datagrams: Sequence[bytes], now: float) -> list[Sample]:
        """Make samples of all records of a read together, column by column."""
        records = [datagram for datagram in datagrams if len(datagram) == RECORD.size]
        self._damaged += len(datagrams) - len(records)
        if not records:
            return []
        data = b"".join(records)
        numbers, readings, status = zip(*HEAD.iter_unpack(data), strict=True)
        counts = list(COUNTS.iter_unpack(data))
        sequence = self._tracker.accept_all(numbers, now)
        if isinstance(sequence, list) and None in sequence:
            kept = [i for i, number in enumerate(sequence) if number is not None]
            readings, status = [readings[i] for i in kept], [status[i] for i in kept]
            sequence, counts = [sequence[i] for i in kept], [counts[i] for i in kept]
        times = self._device_time.unwrap_all(readings)
        columns = zip(repeat(now), times, sequence, counts, status, repeat(0), strict=False)
        return list(map(_SAMPLE, columns))

    def _listen(self, heard: bool, now: float) -> None:
        """Ask a silent cell to start again, and count when it does."""
        if heard:
            self._heard = now
            self._reconnected += self._silent
            self._silent = False
        elif now - self._heard > START_AGAIN_AFTER:
            self._heard = now
            self._silent = self._received > 0
            self._link.write(encode_request(Request.START))


def read_configuration(host: str, *, port: int = 80, timeout: float = 2.0) -> CellConfiguration:
    """Ask a cell for its configuration.

    Args:
        host: Its address.
        port: Its HTTP port.
        timeout: Longest wait for each step [s].

    Returns:
        Counts in SI and the rate, for the profile.

    Raises:
        LinkError: The cell does not answer.
        ProtocolError: The answer is not a cell's.
    """
    connection = http.client.HTTPConnection(host, port, timeout=timeout)
    try:
        connection.request("GET", "/netftapi2.xml")
        page = connection.getresponse().read(LONGEST_PAGE)
    except (OSError, http.client.HTTPException) as problem:
        raise LinkError(
            f"load cell {host}:{port} did not give its configuration: {problem!r}; check address "
            "and network"
        ) from problem
    finally:
        connection.close()
    return parse_configuration(page)
