# SPDX-License-Identifier: MIT
"""Limit checks before motion and on every sample, and stop requests; not a safety device.

If the host fails, only the watchdogs inside the drives and a hardware emergency stop stop the rig.
"""

import math
from collections import deque
from collections.abc import Sequence
from dataclasses import dataclass
from enum import IntEnum
from typing import Final

import numpy as np

from model.arrays import Array
from rig.errors import LimitExceeded, RigError, RigTimeout

REST_SPEED: Final = 0.1
"""Largest mean speed of a disc that counts as standing, unless a plan sets it [rad/s]."""


def require_within(value: float, limit: float, *, quantity: str, unit: str) -> None:
    """Check that the magnitude of a set-point is within its limit.

    Args:
        value: Set-point.
        limit: Largest magnitude allowed.
        quantity: Name of the quantity, for the message.
        unit: Unit of value and limit, for the message.

    Raises:
        LimitExceeded: The magnitude is above the limit, or NaN.
    """
    if not abs(value) <= limit:  # NaN too
        raise LimitExceeded(quantity, value=value, limit=limit, unit=unit)


class SampleGuard:
    """Limit check of one measured quantity that tolerates single outliers.

    Args:
        limit: Largest magnitude allowed.
        quantity: Name of the quantity, for the message.
        unit: Unit of the limit.
        in_a_row: Number of samples beyond the limit, among the latest 2 in_a_row - 1, that are a
            fault. They need not be consecutive: a sensor that saturates in two samples of three
            never gives three in a row.
    """

    def __init__(self, limit: float, *, quantity: str, unit: str, in_a_row: int = 3) -> None:
        self._limit = limit
        self._quantity = quantity
        self._unit = unit
        self._in_a_row = in_a_row
        self._latest: deque[bool] = deque(maxlen=2 * in_a_row - 1)

    def check(self, value: float) -> None:
        """Check the next value; NaN and infinity count as beyond the limit.

        Raises:
            LimitExceeded: The value and `in_a_row` - 1 of the 2 in_a_row - 2 before it are beyond
                the limit.
        """
        beyond = not (math.isfinite(value) and abs(value) <= self._limit)
        self._latest.append(beyond)
        if beyond and sum(self._latest) >= self._in_a_row:
            raise LimitExceeded(self._quantity, value=value, limit=self._limit, unit=self._unit)

    def check_all(self, values: Array) -> None:
        """Check the next values, shape (n,), like `check`; faster where all are within the limit.

        Raises:
            LimitExceeded: As `check`; the values of earlier calls count as well.
        """
        within = np.abs(values) <= self._limit  # NaN is not
        if within.all():
            self._latest.extend(not w for w in within[-self._in_a_row * 2 :].tolist())
            return
        for value in values.tolist():
            self.check(value)


class FollowingGuard:
    """Limit check of a disc's speed error, speed less set-point; a short error is tolerated.

    Args:
        limit: Largest speed error allowed [rad/s].
        name: Name of the disc, for the message.
        longest: Longest time for which the error may exceed the limit [s].
    """

    def __init__(self, limit: float, *, name: str, longest: float) -> None:
        self._limit = limit
        self._name = name
        self._longest = longest
        self._since: float | None = None

    def check(self, speed: float, wanted: float, *, now: float, narrower: float = math.inf) -> None:
        """Check the latest speed against its set-point.

        Args:
            speed: Measured speed [rad/s].
            wanted: Commanded speed [rad/s].
            now: Host time [s].
            narrower: Further limit of the error; the smaller of the two holds [rad/s].

        Raises:
            LimitExceeded: In every check for `longest` or more, the speed error was beyond the
                limit or NaN.
        """
        departure, limit = speed - wanted, min(self._limit, narrower)
        if abs(departure) <= limit:
            self._since = None
            return
        self._since = now if self._since is None else self._since
        if now - self._since >= self._longest:
            quantity = f"speed error of the {self._name} at its set-point of {wanted:g} rad/s"
            raise LimitExceeded(quantity, value=departure, limit=limit, unit="rad/s")


class SilenceGuard:
    """Check that a stream does not stay without samples for longer than a limit.

    Args:
        name: Name of the stream, for the message.
        limit: Longest silence allowed [s].
        now: Host time at which the check begins [s].
    """

    def __init__(self, name: str, *, limit: float, now: float) -> None:
        self._name = name
        self._limit = limit
        self._last_arrival = now

    def check(self, samples: Sequence[object], *, now: float, late: float = 0.0) -> None:
        """Check the time since samples last arrived; a read with samples always passes.

        Args:
            samples: Samples of the latest read, possibly none.
            now: Host time [s].
            late: Part of that time in which this program was late to read, which is no silence [s].

        Raises:
            RigTimeout: The read is empty, and no sample has arrived for longer than the limit.
        """
        if samples:
            self._last_arrival = now
        elif now - self._last_arrival - late > self._limit:
            raise RigTimeout(f"stream '{self._name}' sent nothing", waited=now - self._last_arrival,
                             advice=f"limit {self._limit:g} s: check power and cable")  # fmt: skip


class StopCategory(IntEnum):
    """Ways to stop, the mildest first; in brackets the category of IEC 60204-1."""

    SOFT = 1
    """Ramp to standstill and hold there, energised (2)."""
    SAFE = 2
    """Ramp to standstill, then de-energise (1)."""
    EMERGENCY = 3
    """De-energise at once; latched until a person resets it (0)."""


@dataclass(frozen=True)
class Stop:
    """Request to stop.

    Attributes:
        category: How to stop.
        reason: Why a stop was requested, for the log.
    """

    category: StopCategory
    reason: str


class StopRequested(RigError):
    """A stop was requested; raised to leave the run so that it is carried out.

    Attributes:
        stop: The request, with category and reason.
    """

    def __init__(self, stop: Stop) -> None:
        super().__init__(f"{stop.category.name.lower()} stop: {stop.reason}")
        self.stop = stop


class StopSwitch:
    """Stop requests from signals, keys and other threads, polled by the acquiring thread.

    A harder stop prevails over a milder one. There is no mutex: a signal handler would deadlock
    with the thread that it interrupts. Appending to and reading a list are atomic.
    """

    def __init__(self) -> None:
        self._requests: list[Stop] = []

    def request(self, category: StopCategory, reason: str) -> None:
        """Request a stop; safe to call from a signal handler and from any thread.

        Args:
            category: How to stop.
            reason: Why the stop is requested, for the log.
        """
        self._requests.append(Stop(category, reason))

    @property
    def pending(self) -> Stop | None:
        """Hardest stop requested, the earliest of its category; None without any request."""
        return max(self._requests, key=lambda stop: stop.category, default=None)

    @property
    def latched(self) -> bool:
        """Return whether an emergency stop has been requested and not been reset since."""
        stop = self.pending
        return stop is not None and stop.category is StopCategory.EMERGENCY

    def release(self) -> None:
        """Clear requests of soft stops; safe and emergency stops stay."""
        self._requests[:] = [s for s in self._requests if s.category is not StopCategory.SOFT]

    def reset(self) -> None:
        """Clear every stop, an emergency stop included; only on a person's explicit request."""
        self._requests.clear()
