# SPDX-License-Identifier: MIT
"""Between the thread that reads a device and those who write or watch: nobody waits for anybody."""

import threading
from collections import deque
from collections.abc import Sequence

from rig.device import Sample
from rig.sample_columns import SampleColumns


class SampleQueue:
    """Samples on their way to the log; bounded, and `put` never waits.

    Args:
        limit: Most samples that may wait.

    Attributes:
        dropped: Samples that found no room.
    """

    def __init__(self, *, limit: int) -> None:
        self.dropped = 0
        self._limit = limit
        self._waiting: list[Sequence[Sample]] = []
        self._count = 0
        self._lock = threading.Lock()

    def put(self, samples: Sequence[Sample]) -> bool:
        """Take samples, all or none; tell whether there was room."""
        with self._lock:
            if self._count + len(samples) > self._limit:
                self.dropped += len(samples)
                return False
            self._waiting.append(samples)
            self._count += len(samples)
            return True

    def take(self) -> Sequence[Sample]:
        """Hand on all that wait, in order."""
        with self._lock:
            taken, self._waiting, self._count = self._waiting, [], 0
        columns = [samples for samples in taken if isinstance(samples, SampleColumns)]
        if taken and len(columns) == len(taken):
            return SampleColumns.joined(columns)
        return [sample for samples in taken for sample in samples]


class LossyTap:
    """The newest samples for a viewer, which takes them when it can: what it misses is gone.

    Reads are kept whole while they come, and handed over whole: a viewer that is slow, hangs or
    raises holds up nobody.

    Args:
        limit: Most samples handed on; fewer than that and one read are kept.
    """

    def __init__(self, *, limit: int = 1000) -> None:
        self._limit = limit
        self._newest: deque[Sequence[Sample]] = deque()
        self._count = 0
        self._lock = threading.Lock()

    def put(self, samples: Sequence[Sample]) -> None:
        """Keep samples, in place of the oldest where there are too many."""
        with self._lock:
            self._newest.append(samples)
            self._count += len(samples)
            while self._count - len(self._newest[0]) >= self._limit:
                self._count -= len(self._newest.popleft())

    def take(self) -> list[Sample]:
        """Hand on what is kept, in order, and keep it no more."""
        with self._lock:
            reads, self._newest, self._count = self._newest, deque(), 0
        return [sample for samples in reads for sample in samples][-self._limit :]
