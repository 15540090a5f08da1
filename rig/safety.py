# SPDX-License-Identifier: MIT
"""Limits that are checked before motion and on every sample. Not a safety device.

What stops a rig whose host is dead is the watchdog inside its drives, and a hardware emergency
stop.
"""

import math
from collections import deque
from collections.abc import Sequence
from dataclasses import dataclass
from enum import IntEnum
from typing import Final

import numpy as np
from numpy.typing import NDArray

from rig.errors import LimitExceeded, RigError, RigTimeout

REST_SPEED: Final = 0.1
"""Mean speed below which a disc stands, unless a plan says otherwise [rad/s]."""


def require_within(value: float, limit: float, *, quantity: str, unit: str) -> None:
    """Check a set-point.

    Args:
        value: What is to be commanded.
        limit: Largest magnitude allowed.
        quantity: What it is, for the message.
        unit: Unit of both.

    Raises:
        LimitExceeded: It is beyond the limit, or no number.
    """
    if not abs(value) <= limit:  # NaN too
        raise LimitExceeded(quantity, value=value, limit=limit, unit=unit)


class SampleGuard:
    """Watches one measured quantity: one outlier is noise, several close together are real.

    Args:
        limit: Largest magnitude allowed.
        quantity: What is watched, for the message.
        unit: Unit of the limit.
        in_a_row: So many samples beyond the limit are a fault, in a row or as most of the latest
            2 in_a_row - 1: a sensor that saturates in two samples of three never gives three in a
            row.
    """

    def __init__(self, limit: float, *, quantity: str, unit: str, in_a_row: int = 3) -> None:
        self._limit = limit
        self._quantity = quantity
        self._unit = unit
        self._in_a_row = in_a_row
        self._latest: deque[bool] = deque(maxlen=2 * in_a_row - 1)

    def check(self, value: float) -> None:
        """Take the next value.

        Raises:
            LimitExceeded: It is the last of so many beyond the limit.
        """
        beyond = not (math.isfinite(value) and abs(value) <= self._limit)
        self._latest.append(beyond)
        if beyond and sum(self._latest) >= self._in_a_row:
            raise LimitExceeded(self._quantity, value=value, limit=self._limit, unit=self._unit)

    def check_all(self, values: NDArray[np.float64]) -> None:
        """Take the next values, shape (n,), in order; at 7 kHz one by one would cost too much.

        Raises:
            LimitExceeded: So many of the latest ones, those before counted, are beyond the limit.
        """
        within = np.abs(values) <= self._limit  # NaN is not
        if within.all():
            self._latest.extend(not w for w in within[-self._in_a_row * 2 :].tolist())
            return
        for value in values.tolist():
            self.check(value)


class FollowingGuard:
    """Watches whether a disc follows its set-point; a short departure is acceleration.

    Args:
        limit: Largest departure allowed [rad/s].
        name: Name of the disc, for the message.
        longest: How long a departure may last [s].
    """

    def __init__(self, limit: float, *, name: str, longest: float) -> None:
        self._limit = limit
        self._name = name
        self._longest = longest
        self._since: float | None = None

    def check(self, speed: float, wanted: float, *, now: float, narrower: float = math.inf) -> None:
        """Take the latest speed and its set-point [rad/s].

        Args:
            speed: Measured.
            wanted: Commanded.
            now: Host time [s].
            narrower: A smaller limit that holds for now.

        Raises:
            LimitExceeded: The disc has departed too far for too long, or its speed is no number.
        """
        departure, limit = speed - wanted, min(self._limit, narrower)
        if abs(departure) <= limit:
            self._since = None
            return
        self._since = now if self._since is None else self._since
        if now - self._since >= self._longest:
            quantity = f"departure of the {self._name} from its set-point of {wanted:g} rad/s"
            raise LimitExceeded(quantity, value=departure, limit=limit, unit="rad/s")


class SilenceGuard:
    """Makes an event of a stream that has fallen silent.

    Args:
        name: Name of the stream, for the message.
        limit: Longest silence allowed [s].
        now: Host time at which watching begins [s].
    """

    def __init__(self, name: str, *, limit: float, now: float) -> None:
        self._name = name
        self._limit = limit
        self._heard = now

    def check(self, samples: Sequence[object], *, now: float) -> None:
        """Take what a read gave.

        Args:
            samples: What came, nothing or more.
            now: Host time [s].

        Raises:
            RigTimeout: Nothing has come for longer than the limit.
        """
        if samples:
            self._heard = now
        elif now - self._heard > self._limit:
            raise RigTimeout(f"stream '{self._name}' sent nothing", waited=now - self._heard)


class StopCategory(IntEnum):
    """Ways to stop, the mildest first; in brackets the category of IEC 60204-1."""

    SOFT = 1
    """Ramp to standstill and hold there, energised (2)."""
    SAFE = 2
    """Ramp to standstill, then de-energise (1)."""
    EMERGENCY = 3
    """De-energise at once; latched until somebody resets it (0)."""


@dataclass(frozen=True)
class Stop:
    """A wish to stop.

    Attributes:
        category: How.
        reason: Why, for the log.
    """

    category: StopCategory
    reason: str


class StopRequested(RigError):
    """Somebody asked for a stop; the run is left so that it is obeyed.

    Attributes:
        stop: How and why.
    """

    def __init__(self, stop: Stop) -> None:
        super().__init__(f"{stop.category.name.lower()} stop: {stop.reason}")
        self.stop = stop


class StopSwitch:
    """Where signals, keys and other threads ask for stops, and the acquiring thread looks.

    A harder stop prevails over a milder one. No lock: a signal's handler would wait for the thread
    that it interrupted. Appending to and reading a list is whole by itself.
    """

    def __init__(self) -> None:
        self._asked: list[Stop] = []

    def request(self, category: StopCategory, reason: str) -> None:
        """Request a stop; safe to call from a signal handler and from any thread.

        Args:
            category: How to stop.
            reason: Why, for the log.
        """
        self._asked.append(Stop(category, reason))

    @property
    def pending(self) -> Stop | None:
        """The hardest stop that was asked for, the first of its category; None where none was."""
        return max(self._asked, key=lambda stop: stop.category, default=None)

    @property
    def latched(self) -> bool:
        """Tell whether an emergency stop holds until it is reset."""
        stop = self.pending
        return stop is not None and stop.category is StopCategory.EMERGENCY

    def release(self) -> None:
        """Take back soft stops; safe and emergency stops stay."""
        self._asked[:] = [s for s in self._asked if s.category is not StopCategory.SOFT]

    def reset(self) -> None:
        """Release everything, an emergency stop too: only ever at a person's explicit wish."""
        self._asked.clear()
