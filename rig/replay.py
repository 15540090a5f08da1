# SPDX-License-Identifier: MIT
"""Recorded samples through the interface of a live stream."""

import itertools
from collections.abc import Sequence
from typing import Self

from rig.clock import SYSTEM_CLOCK, Clock
from rig.device import Counters, Sample
from rig.errors import ProtocolError


class ReplayStream:
    """Stream of recorded samples at their recorded pace; implements the protocol `Stream`.

    Host times are shifted so that the first sample arrives when the stream is entered; device
    times, sequence numbers and counts are as recorded. Gaps in the sequence numbers count as lost.

    Args:
        samples: The recorded samples, in order of host time.
        name: Name of the stream.
        source: Where the samples come from, such as `replay:RUN`.
        clock: Host time.

    Raises:
        ProtocolError: A sample's host time is below the previous sample's.
    """

    def __init__(
        self,
        samples: Sequence[Sample],
        *,
        name: str,
        source: str,
        clock: Clock = SYSTEM_CLOCK,
    ) -> None:
        for before, after in itertools.pairwise(samples):
            if after.host_time < before.host_time:
                raise ProtocolError(
                    f"the recorded host time falls from {before.host_time:g} s to "
                    f"{after.host_time:g} s; sort the samples by host time first"
                )
        self.name = name
        self.source = source
        self._samples = samples
        self._clock = clock
        self._began: float | None = None
        self._next = 0
        self._lost = 0

    @property
    def finished(self) -> bool:
        """Return whether every recorded sample has been returned."""
        return self._next >= len(self._samples)

    @property
    def counters(self) -> Counters:
        """Number of samples returned so far, and of those lost; the other counters are 0."""
        return Counters(received=self._next, lost=self._lost)

    def read(self, timeout: float) -> list[Sample]:
        """Return the samples that are due, waiting at most `timeout` for the first [s].

        Before the stream is entered, and after the last sample, there are none; the call then waits
        the whole `timeout`.
        """
        if self._began is None or self.finished:
            self._clock.sleep(timeout)
            return []
        wait = self._due(self._next) - self._clock.now()
        self._clock.sleep(min(max(wait, 0.0), timeout))
        now = self._clock.now()
        first = self._next
        while not self.finished and self._due(self._next) <= now:
            self._count_gap(self._next)
            self._next += 1
        return [
            self._samples[index]._replace(host_time=self._due(index))
            for index in range(first, self._next)
        ]

    def __enter__(self) -> Self:
        self._began = self._clock.now()
        return self

    def __exit__(self, *exception: object) -> None:
        self._began = None

    def _due(self, index: int) -> float:
        """Compute the host time at which a sample is returned, at the recorded pace [s]."""
        after = self._samples[index].host_time - self._samples[0].host_time
        return (self._began or 0.0) + after

    def _count_gap(self, index: int) -> None:
        """Count sequence numbers missing between a sample and the one before it as lost."""
        last = self._samples[index - 1].sequence if index else None
        number = self._samples[index].sequence
        if last is not None and number is not None:
            self._lost += number - last - 1
