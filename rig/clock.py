# SPDX-License-Identifier: MIT
"""Host time as an argument: the machine's own, or one that a test turns by hand."""

import time
from typing import Protocol


class Clock(Protocol):
    """Monotonic time of the host; its origin means nothing."""

    def now(self) -> float:
        """Read the time [s]."""
        ...

    def sleep(self, duration: float) -> None:
        """Let `duration` pass [s]."""
        ...


class SystemClock:
    """The machine's monotonic clock: no step of the wall clock moves it."""

    def now(self) -> float:
        """Read the time [s]."""
        return time.monotonic()

    def sleep(self, duration: float) -> None:
        """Let `duration` pass [s]."""
        time.sleep(max(duration, 0.0))


class ManualClock:
    """A clock that stands still until somebody sleeps on it; then time passes at once.

    >>> clock = ManualClock(5.0)
    >>> clock.sleep(0.25)
    >>> clock.now()
    5.25
    """

    def __init__(self, start: float = 0.0) -> None:
        self._now = start

    def now(self) -> float:
        """Read the time [s]."""
        return self._now

    def sleep(self, duration: float) -> None:
        """Move the time on by `duration` [s]."""
        self._now += max(duration, 0.0)


SYSTEM_CLOCK = SystemClock()
"""What drivers use unless they are given another clock."""
