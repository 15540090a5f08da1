# SPDX-License-Identifier: MIT
"""Limits that are checked before motion and on every sample. Not a safety device.

What stops a rig whose host is dead is the watchdog inside its drives, and a hardware emergency
stop.
"""

import math

from rig.device import Sample
from rig.errors import LimitExceeded, RigTimeout


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
    """Watches one measured quantity: one outlier is noise, several in a row are real.

    Args:
        limit: Largest magnitude allowed.
        quantity: What is watched, for the message.
        unit: Unit of the limit.
        in_a_row: So many consecutive samples beyond the limit are a fault.
    """

    def __init__(self, limit: float, *, quantity: str, unit: str, in_a_row: int = 3) -> None:
        self._limit = limit
        self._quantity = quantity
        self._unit = unit
        self._in_a_row = in_a_row
        self._beyond = 0

    def check(self, value: float) -> None:
        """Take the next value.

        Raises:
            LimitExceeded: It is the last of so many beyond the limit.
        """
        beyond = not (math.isfinite(value) and abs(value) <= self._limit)
        self._beyond = self._beyond + 1 if beyond else 0
        if self._beyond >= self._in_a_row:
            raise LimitExceeded(self._quantity, value=value, limit=self._limit, unit=self._unit)


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

    def check(self, samples: list[Sample], *, now: float) -> None:
        """Take what a read gave.

        Args:
            samples: The samples, none or more.
            now: Host time [s].

        Raises:
            RigTimeout: Nothing has come for longer than the limit.
        """
        if samples:
            self._heard = now
        elif now - self._heard > self._limit:
            raise RigTimeout(f"stream '{self._name}' sent nothing", waited=now - self._heard)
