# SPDX-License-Identifier: MIT
"""Between the thread that reads a device and those who write or watch: nobody waits for anybody."""

import threading
from collections import deque
from collections.abc import Sequence

from rig.device import Sample


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
        self._waiting: list[Sample] = []
        self._lock = threading.Lock()

    def put(self, samples: Sequence[Sample]) -> bool:
        """Take samples, all or none; tell whether there was room."""
        with self._lock:
            if len(self._waiting) + len(samples) > self._limit:
                self.dropped += len(samples)
                return False
            self._waiting.extend(samples)
            return True

    def take(self) -> list[Sample]:
        """Hand on all that wait, in order."""
        with self._lock:
            taken, self._waiting = self._waiting, []
        return taken


class LossyTap:
    """The newest samples for a viewer, which takes them when it can: what it misses is gone.

    The recorder only ever appends, so that a viewer that is slow, hangs or raises holds up nobody.

    Args:
        limit: Most samples kept.
    """

    def __init__(self, *, limit: int = 1000) -> None:
        self._newest: deque[Sample] = deque(maxlen=limit)

    def put(self, samples: Sequence[Sample]) -> None:
        """Keep samples, in place of the oldest where there are too many."""
        self._newest.extend(samples)

    def take(self) -> list[Sample]:
        """Hand on what is kept, in order, and keep it no more."""
        taken: list[Sample] = []
        while self._newest:
            taken.append(self._newest.popleft())
        return taken
