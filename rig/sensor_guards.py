# SPDX-License-Identifier: MIT
"""Guards against sensors that lie: readings that are old, frozen, or of records in disorder."""

from collections import deque
from typing import Final, TypeAlias

import numpy as np
from numpy.typing import NDArray

from rig.device import Counters
from rig.errors import FrozenReading, StaleReading, UnreliableRecords

Values: TypeAlias = NDArray[np.float64]

TURNING: Final = 1.0
"""Set-point above which a disc's sensors must move, and change of one which they must show [rad/s].
"""
FEWEST_SAME: Final = 8
"""Equal readings in a row below which a sensor is not frozen, however slow it is."""
LARGE: Final = 3.0
"""Smallest steps of a sensor that are more than its rounding."""
LATEST_LOOKS: Final = 9
SCATTER_TIME: Final = 1.0
"""Time over which the share of looks with a large change is averaged [s]."""
SINGLE_PRECISION: Final = 2.0**-22
"""Relative step of what travels as a single-precision number [-]."""
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
        """Check the age of the readings of one batch.

        Args:
            taken: Host time at which each reading was taken, shape (n,) [s].
            now: Host time [s].

        Raises:
            StaleReading: A reading is older than the limit.
        """
        age = now - float(taken.min(initial=now))
        if age > self._limit:
            raise StaleReading(
                f"age of a reading of stream '{self._name}'", value=age, limit=self._limit, unit="s"
            )


class FrozenGuard:
    """Makes a fault of a sensor that gives the same value, bit for bit, while discs turn.

    A sensor may do so by right: at rest, where its noise is below one count, and a simulated one
    without noise at any steady speed. So what does not change is frozen only where it must change:
    where it scattered by several of its smallest steps up to its last change, and a speed also
    where its set-point has changed.

    Args:
        what: What is measured, for the message.
        limit: Longest time without any change [s].
        follows: Whether it is the speed that is commanded.
    """

    def __init__(self, what: str, *, limit: float, follows: bool = False) -> None:
        self._what = what
        self._limit = limit
        self._follows = follows
        self._last: Values | None = None
        self._looked = self._changed = 0.0
        self._same = 0
        self._wanted = self._steady = 0.0
        self._smallest = self._share = np.zeros(0)
        self._large: deque[NDArray[np.bool_]] = deque(maxlen=LATEST_LOOKS)
        self._scattered = False

    def check(self, values: Values, *, wanted: float, now: float) -> None:
        """Take what a look gave, in order.

        Args:
            values: What the channels of the sensor gave, shape (n, channels).
            wanted: Set-point of the disc that makes the value change [rad/s].
            now: Host time [s].

        Raises:
            FrozenReading: None of the channels has changed for longer than the limit.
        """
        if abs(wanted) <= TURNING:
            self._last = None
        elif len(values):
            if self._last is None or (values != self._last).any():
                self._changed, self._wanted, self._same = now, wanted, 0
            if self._last is not None and wanted == self._steady:
                self._learn(values, self._last, now)
            self._last, self._steady, self._looked = values[-1].copy(), wanted, now
            self._same += len(values)
            ramped = self._follows and abs(wanted - self._wanted) > TURNING
            must_change = self._scattered or ramped
            if must_change and self._same >= FEWEST_SAME and now - self._changed > self._limit:
                raise FrozenReading(self._what, value=now - self._changed, limit=self._limit)

    def _learn(self, values: Values, last: Values, now: float) -> None:
        """Take note of how the channels scatter at a steady set-point."""
        steps = np.abs(np.diff(values, axis=0, prepend=last[None]))
        if not len(self._smallest):
            self._smallest, self._share = np.full(len(last), np.inf), np.zeros(len(last))
        self._smallest = np.minimum(self._smallest, np.where(steps > 0, steps, np.inf).min(axis=0))
        resolution = np.maximum(self._smallest, SINGLE_PRECISION * np.abs(last))
        large = np.abs(values[-1] - last) >= LARGE * resolution
        self._share += -np.expm1((self._looked - now) / SCATTER_TIME) * (large - self._share)
        if steps.any():
            self._large.append(large)
            often = np.mean(self._large, axis=0) > 0.5
            self._scattered = bool((often & (self._share > 0.5)).any())


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
