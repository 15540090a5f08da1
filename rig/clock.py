# SPDX-License-Identifier: MIT
"""Host time as an argument: the system's monotonic clock, or a manual clock for tests."""

import time
from typing import Protocol


class Clock(Protocol):
    """Monotonic time of the host, with an arbitrary origin."""

    def now(self) -> float:
        """Return the present time [s]."""
        ...

    def sleep(self, duration: float) -> None:
        """Wait for `duration`; return at once where it is negative [s]."""
        ...


class SystemClock:
    """Monotonic clock of the system, which changes of the wall clock do not affect."""

    def now(self) -> float:
        """Return the time of the system's monotonic clock [s]."""
        return time.monotonic()

    def sleep(self, duration: float) -> None:
        """Block the calling thread for `duration`; return at once where it is negative [s]."""
        time.sleep(max(duration, 0.0))


class ManualClock:
    """Clock for tests that starts at `start` [s] and advances only by `sleep`, without waiting.

    >>> clock = ManualClock(5.0)
    >>> clock.sleep(0.25)
    >>> clock.now()
    5.25
    """

    def __init__(self, start: float = 0.0) -> None:
        self._now = start

    def now(self) -> float:
        """Return `start` plus all durations of `sleep` [s]."""
        return self._now

    def sleep(self, duration: float) -> None:
        """Advance the time by `duration` without waiting; a negative one changes nothing [s]."""
        self._now += max(duration, 0.0)


SYSTEM_CLOCK = SystemClock()
"""Default clock of the drivers."""
