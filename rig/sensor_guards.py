# SPDX-License-Identifier: MIT
"""Checks of sensor plausibility: stale readings, frozen values, and unreliable record numbers."""

from collections import deque
from typing import Final, TypeAlias

import numpy as np
from numpy.typing import NDArray

from model.arrays import Array
from rig.device import Counters
from rig.errors import FrozenReading, StaleReading, UnreliableRecords

Values: TypeAlias = Array

TURNING: Final = 1.0
"""Set-point above which a disc's sensors are checked, and change of the set-point above which the
speed must change too [rad/s]."""
MIN_REPEATS: Final = 8
"""Least number of equal consecutive readings of a frozen sensor."""
LARGE: Final = 3.0
"""Factor on a sensor's smallest step above which a change is more than its rounding [-]."""
SCATTER_BATCHES: Final = 9
"""Number of latest batches with any change, more than half of which need a large change."""
SCATTER_TIME: Final = 1.0
"""Time over which the fraction of batches with a large change is averaged [s]."""
SINGLE_PRECISION: Final = 2.0**-22
"""Relative resolution of values sent in single precision [-]."""
RESTART_WINDOW: Final = 10.0
"""Time within which a device may restart its record numbers once [s]."""
BAD_FRACTION_WINDOW: Final = 0.25
"""Time over which the fraction of missing and rejected records is computed [s]."""
MAX_BAD_FRACTION: Final = 0.5
"""Largest allowed fraction of missing and rejected records [-]."""
MIN_RECORDS: Final = 20
"""Least number of records from which the fraction is computed."""


class AgeGuard:
    """Check that no reading is older than a limit, for example because it waited in a buffer.

    Args:
        name: Name of the stream, for the message.
        limit: Largest age allowed [s].
    """

    def __init__(self, name: str, *, limit: float) -> None:
        self._name = name
        self._limit = limit

    def check(self, taken: Array, *, now: float) -> None:
        """Check the age of the oldest reading of one batch; an empty batch passes.

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
    """Check for a sensor that gives the same value, bit for bit, while discs turn.

    A working sensor gives a constant value at rest, where its noise is below one count, and a
    simulated one without noise does so at any steady speed. A constant value therefore counts as
    frozen only where it must change: where it scattered by several of its smallest steps until its
    last change, or, for a speed, where its set-point has changed.

    Args:
        what: Name of the quantity, for the message.
        limit: Longest time without any change [s].
        follows: Whether the quantity is a disc's speed, which the set-point commands.
    """

    def __init__(self, what: str, *, limit: float, follows: bool = False) -> None:
        self._what = what
        self._limit = limit
        self._follows = follows
        self._last: Values | None = None
        self._checked_at = self._changed = 0.0
        self._same = 0
        self._wanted = self._steady = 0.0
        self._smallest = self._large_fraction = np.zeros(0)
        self._large: deque[NDArray[np.bool_]] = deque(maxlen=SCATTER_BATCHES)
        self._scattered = False

    def check(self, values: Values, *, wanted: float, now: float) -> None:
        """Check the values of a batch; at set-points of at most `TURNING` start anew.

        Args:
            values: Values in the sensor's unit, in order of time, shape (n, channels).
            wanted: Set-point of the disc that makes the values change [rad/s].
            now: Host time [s].

        Raises:
            FrozenReading: No channel has changed for longer than the limit, over at least
                `MIN_REPEATS` readings, though one scattered or a speed's set-point moved.
        """
        if abs(wanted) <= TURNING:
            self._last = None
        elif len(values):
            if self._last is None or (values != self._last).any():
                self._changed, self._wanted, self._same = now, wanted, 0
            if self._last is not None and wanted == self._steady:
                self._learn(values, self._last, now)
            self._last, self._steady, self._checked_at = values[-1].copy(), wanted, now
            self._same += len(values)
            ramped = self._follows and abs(wanted - self._wanted) > TURNING
            must_change = self._scattered or ramped
            if must_change and self._same >= MIN_REPEATS and now - self._changed > self._limit:
                raise FrozenReading(self._what, value=now - self._changed, limit=self._limit)

    def _learn(self, values: Values, last: Values, now: float) -> None:
        """Update each channel's smallest step, and whether any scatters beyond its rounding.

        Args:
            values: Values of a batch, shape (n, channels), n > 0.
            last: Values before the batch, shape (channels,).
            now: Host time [s].
        """
        steps = np.abs(np.diff(values, axis=0, prepend=last[None]))
        if not len(self._smallest):
            self._smallest, self._large_fraction = np.full(len(last), np.inf), np.zeros(len(last))
        self._smallest = np.minimum(self._smallest, np.where(steps > 0, steps, np.inf).min(axis=0))
        resolution = np.maximum(self._smallest, SINGLE_PRECISION * np.abs(last))
        large = np.abs(values[-1] - last) >= LARGE * resolution
        weight = -np.expm1((self._checked_at - now) / SCATTER_TIME)
        self._large_fraction += weight * (large - self._large_fraction)
        if steps.any():
            self._large.append(large)
            often = np.mean(self._large, axis=0) > 0.5
            self._scattered = bool((often & (self._large_fraction > 0.5)).any())


class RecordGuard:
    """Check for a stream whose record numbers restart repeatedly, or of which most records fail.

    Random record numbers count as restarts. One restart within `RESTART_WINDOW` is tolerated, and
    so is a fraction of missing and rejected records of up to `MAX_BAD_FRACTION`. That fraction is
    checked after each `BAD_FRACTION_WINDOW`, if that had at least `MIN_RECORDS` records.

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
        """Check the stream's counters; losses are checked only among `MIN_RECORDS` or more records.

        Args:
            counters: Counters of the stream so far.
            now: Host time [s].

        Raises:
            UnreliableRecords: The record numbers restarted twice within `RESTART_WINDOW`, or more
                than `MAX_BAD_FRACTION` of one `BAD_FRACTION_WINDOW` is missing or rejected.
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
                f"{RESTART_WINDOW:g} s; at most 1 restart is allowed"
            )
        if now - self._since >= BAD_FRACTION_WINDOW:
            self._require_most(counters, self._base)
            self._base, self._since = counters, now

    def _require_most(self, counters: Counters, base: Counters) -> None:
        received = counters.received - base.received
        bad = counters.lost + counters.rejected - base.lost - base.rejected
        if bad + received >= MIN_RECORDS and bad > MAX_BAD_FRACTION * (bad + received):
            raise UnreliableRecords(
                f"{100 * bad / (bad + received):.0f} % of the latest records of stream "
                f"'{self._name}' are missing, damaged, repeated or refused; the limit is "
                f"{100 * MAX_BAD_FRACTION:g} %"
            )
