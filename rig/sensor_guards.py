# SPDX-License-Identifier: MIT
"""Guards against sensors that lie: readings that are old, frozen, or of records in disorder."""

from collections import deque
from typing import Final

import numpy as np
from numpy.typing import NDArray

from rig.device import Counters
from rig.errors import FrozenReading, StaleReading, UnreliableRecords

FEWEST_SAME: Final = 8
"""Equal readings in a row below which a sensor is not frozen, however slow it is."""
RESTART_WINDOW: Final = 10.0
"""Time within which a device may restart its numbering once [s]."""
SHARE_WINDOW: Final = 0.25
"""Time over which the share of missing and refused records is taken [s]."""
LARGEST_SHARE: Final = 0.5
"""Share of records that may be missing or refused [-]."""
FEWEST_RECORDS: Final = 20
"""Records below which no share is taken."""


class AgeGuard:
    """Makes a fault of readings that waited too long in a buffer before they were looked at.

    Args:
        name: Name of the stream, for the message.
        limit: Largest age allowed [s].
    """

    def __init__(self, name: str, *, limit: float) -> None:
        self._name = name
        self._limit = limit

    def check(self, taken: NDArray[np.float64], *, now: float) -> None:
        """Take when the readings of one look were taken, by host time, shape (n,) [s].

        Raises:
            StaleReading: One of them is older than the limit.
        """
        age = now - float(taken.min(initial=now))
        if age > self._limit:
            raise StaleReading(
                f"age of a reading of stream '{self._name}'", value=age, limit=self._limit, unit="s"
            )


class FrozenGuard:
    """Makes a fault of a sensor that gives the same value, bit for bit, again and again.

    A sensor at rest may do so by right, where its noise is below one count. So only readings count
    that were taken while what is measured must change.

    Args:
        what: What is measured, for the message.
        limit: Longest time without any change [s].
    """

    def __init__(self, what: str, *, limit: float) -> None:
        self._what = what
        self._limit = limit
        self._last: NDArray[np.float64] | None = None
        self._changed = 0.0
        self._same = 0

    def check(self, values: NDArray[np.float64], *, turning: bool, now: float) -> None:
        """Take the next values, in order.

        Args:
            values: What the channels of the sensor gave, shape (n, channels).
            turning: Whether what is measured must change.
            now: Host time [s].

        Raises:
            FrozenReading: None of the channels has changed for longer than the limit.
        """
        if not turning:
            self._last = None
        elif len(values):
            if self._last is None or (values != self._last).any():
                self._changed, self._same = now, 0
            self._last = values[-1].copy()
            self._same += len(values)
            if now - self._changed > self._limit and self._same >= FEWEST_SAME:
                raise FrozenReading(self._what, value=now - self._changed, limit=self._limit)


class RecordGuard:
    """Makes a fault of a stream whose numbering restarts again and again, or that hardly arrives.

    Numbers at random are restarts, too. One restart is let pass, and so are losses below a half.

    Args:
        name: Name of the stream, for the message.
    """

    def __init__(self, name: str) -> None:
        self._name = name
        self._restarts: deque[float] = deque()
        self._restarted = 0
        self._base: Counters | None = None
        self._since = 0.0

    def check(self, counters: Counters, *, now: float) -> None:
        """Take the stream's counters.

        Args:
            counters: What happened so far.
            now: Host time [s].

        Raises:
            UnreliableRecords: The numbering has restarted twice, or most records are missing or
                refused.
        """
        if self._base is None:
            self._base, self._since, self._restarted = counters, now, counters.restarted
        self._restarts.extend([now] * (counters.restarted - self._restarted))
        self._restarted = counters.restarted
        while self._restarts and self._restarts[0] < now - RESTART_WINDOW:
            self._restarts.popleft()
        if len(self._restarts) > 1:
            raise UnreliableRecords(
                f"stream '{self._name}' restarted its numbering {len(self._restarts)} times within "
                f"{RESTART_WINDOW:g} s; its limit is 1"
            )
        if now - self._since >= SHARE_WINDOW:
            self._require_most(counters, self._base)
            self._base, self._since = counters, now

    def _require_most(self, counters: Counters, base: Counters) -> None:
        received = counters.received - base.received
        bad = counters.lost + counters.rejected - base.lost - base.rejected
        if bad + received >= FEWEST_RECORDS and bad > LARGEST_SHARE * (bad + received):
            raise UnreliableRecords(
                f"stream '{self._name}': {100 * bad / (bad + received):.0f} % of its records are "
                f"missing or refused; its limit is {100 * LARGEST_SHARE:g} %"
            )
