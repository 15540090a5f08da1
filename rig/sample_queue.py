# SPDX-License-Identifier: MIT
"""Non-blocking queues between the thread that reads a device and the writer or viewer."""

import threading
from collections import deque
from collections.abc import Collection, Sequence

from rig.device import Sample
from rig.sample_columns import SampleColumns


class SampleQueue:
    """Bounded, non-blocking queue of samples from a reader thread to the log writer.

    Args:
        limit: Capacity [samples].

    Attributes:
        dropped: Samples dropped so far because the queue was full.
    """

    def __init__(self, *, limit: int) -> None:
        self.dropped = 0
        self._limit = limit
        self._waiting: list[Sequence[Sample]] = []
        self._count = 0
        self._lock = threading.Lock()

    def put(self, samples: Sequence[Sample]) -> bool:
        """Append all samples, or drop them all if the queue would then exceed `limit`.

        Returns whether they were appended.
        """
        with self._lock:
            if self._count + len(samples) > self._limit:
                self.dropped += len(samples)
                return False
            self._waiting.append(samples)
            self._count += len(samples)
            return True

    def take(self) -> Sequence[Sample]:
        """Remove and return all queued samples, in order; as columns if all were columns."""
        with self._lock:
            taken, self._waiting, self._count = self._waiting, [], 0
        return _joined(taken)


class LossyTap:
    """Ring buffer of the newest samples for a viewer; older samples are discarded.

    A viewer that is slow, hangs or raises does not block the reader thread.

    Args:
        limit: Largest number of samples that `take` returns. Whole reads are stored, so that the
            oldest one stored may extend beyond the limit.
    """

    def __init__(self, *, limit: int = 1000) -> None:
        self._limit = limit
        self._newest: deque[Sequence[Sample]] = deque()
        self._count = 0
        self._lock = threading.Lock()

    def put(self, samples: Sequence[Sample]) -> None:
        """Append the samples of a read; discard the oldest reads that `take` would not return."""
        with self._lock:
            self._newest.append(samples)
            self._count += len(samples)
            while self._count - len(self._newest[0]) >= self._limit:
                self._count -= len(self._newest.popleft())

    def take(self) -> Sequence[Sample]:
        """Remove all samples and return the newest of them, at most `limit`, in order.

        They are columns if all were columns.
        """
        with self._lock:
            reads, self._newest, self._count = self._newest, deque(), 0
        return _joined(reads)[-self._limit :]


def _joined(reads: Collection[Sequence[Sample]]) -> Sequence[Sample]:
    """Join the samples of reads in order: to columns if all are columns, else to a list."""
    columns = [samples for samples in reads if isinstance(samples, SampleColumns)]
    if reads and len(columns) == len(reads):
        return SampleColumns.joined(columns)
    return [sample for samples in reads for sample in samples]
