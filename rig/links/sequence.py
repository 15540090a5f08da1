# SPDX-License-Identifier: MIT
"""Unwrap sequence numbers and device times; detect lost, duplicate or late samples, restarts."""

from typing import Any, Final

import numpy as np
from numpy.typing import NDArray

from model.arrays import Array

LATE_WINDOW: Final = 8
"""Default distance behind the newest number below which a sample is late, not a restart: lines and
buses keep the order, so that only a bridge may exchange neighbours."""
SLACK: Final = 64
"""Jump forward that is always a loss, added to twice the number that is due [samples]."""


class SequenceTracker:
    """Unwraps the sequence numbers of one stream and counts losses, duplicates and restarts.

    A jump forward counts as a loss up to `SLACK` plus twice the number of samples that are due: at
    the device's rate for the time since the last sample by its own clock; where it sends no time,
    for all time of the host so far, less those that came (what waited in buffers during a pause
    comes before the jump). A longer jump, one far back, or one against the device's clock is a
    restart of the device, after which the number of missing samples is unknown.

    Args:
        modulus: Modulus at which the device's numbers wrap.
        rate: Sample rate; None where unknown, then only jumps back are restarts [Hz].
        late_window: A number less than this far back is a late sample; farther back it means a
            restart of the device; at most half of `modulus` is used.

    Attributes:
        lost: Number of samples missing so far.
        repeated: Number of duplicate or late samples discarded so far.
        restarted: Number of restarts of the device's numbers.
    """

    def __init__(
        self, *, modulus: int, rate: float | None = None, late_window: int = LATE_WINDOW
    ) -> None:
        self.lost = 0
        self.repeated = 0
        self.restarted = 0
        self._modulus = modulus
        self._rate = rate
        self._late_window = min(late_window, modulus // 2)
        self._last: int | None = None
        self._read_time = self._due = 0.0

    def accept(self, number: int, host_time: float, elapsed: float | None = None) -> int | None:
        """Unwrap the sequence number of a sample and update the counters.

        Args:
            number: Number as the device sent it.
            host_time: Time at which it was read [s].
            elapsed: Time since the last accepted sample by the device's clock, see
                `TimeUnwrapper.since`; None where the sample has no device time [s].

        Returns:
            The unwrapped number, larger than every earlier one; None where the sample is a
            duplicate or late, and must be discarded.

        >>> tracker = SequenceTracker(modulus=256)
        >>> [tracker.accept(number, 0.0) for number in (254, 255, 2, 2, 3)]
        [254, 255, 258, None, 259]
        >>> tracker.lost, tracker.repeated
        (2, 1)
        """
        if self._last is None:
            self._last, self._read_time = number, host_time
            return number
        self._due += (self._rate or 0.0) * (host_time - self._read_time)
        self._read_time = host_time
        ahead = (number - self._last - 1) % self._modulus + 1  # the same number is a whole turn
        late = self._modulus - ahead < self._late_window
        if self._is_restart(ahead, late, elapsed):
            self.restarted += 1
        elif late:
            self.repeated += 1
            return None
        else:
            self.lost += ahead - 1
        self._due = max(self._due - ahead, 0.0)
        self._last += ahead
        return self._last

    def accept_all(
        self, numbers: NDArray[np.integer[Any]], host_time: float
    ) -> tuple[NDArray[np.bool_] | slice, NDArray[np.int64]]:
        """Unwrap the sequence numbers of the samples of one read; see `accept`.

        Consecutive numbers, the usual case for a fast device, are processed together.

        Args:
            numbers: Numbers as the device sent them, shape (n,).
            host_time: Time at which they were read [s].

        Returns:
            Mask of shape (n,), or slice of everything, that selects the accepted numbers; and
            the accepted numbers unwrapped, shape (accepted,).

        >>> tracker = SequenceTracker(modulus=256)
        >>> tracker.accept_all(np.array([254, 255, 2, 2]), 0.0)
        (array([ True,  True,  True, False]), array([254, 255, 258]))
        """
        if self._last is not None and len(numbers):
            first = (self._last + 1) % self._modulus
            end = first + len(numbers)
            if end <= self._modulus and (numbers == np.arange(first, end)).all():
                accepted = np.arange(self._last + 1, self._last + 1 + len(numbers))
                self.accept(first, host_time)
                self._due = max(self._due - len(accepted) + 1, 0.0)
                self._last = int(accepted[-1])
                return slice(None), accepted
        one_by_one = [self.accept(number, host_time) for number in numbers.tolist()]
        kept = np.array([number is not None for number in one_by_one], bool)
        return kept, np.array([n for n in one_by_one if n is not None], np.int64)

    def _is_restart(self, ahead: int, late: bool, elapsed: float | None) -> bool:
        """Return whether a number `ahead` of the last one means a restart, as the class says.

        A `late` sample is one by the device's clock too, if that sends its time. Without a rate, a
        jump forward is a restart from half of the modulus on.
        """
        if self._rate is None:
            return not late and ahead >= self._modulus // 2
        if late:
            return elapsed is not None and not -2 * self._late_window <= self._rate * elapsed <= 0
        due = self._due if elapsed is None else self._rate * elapsed
        return ahead > SLACK + 2 * due


class TimeUnwrapper:
    """Converts the wrapping ticks of a device's clock to a non-decreasing time.

    Ticks below the previous ones count as wrapped, also where the device has restarted.

    Args:
        modulus: Modulus at which the device's ticks wrap.
        tick: Length of one tick [s].
    """

    def __init__(self, *, modulus: int, tick: float) -> None:
        self._modulus = modulus
        self._tick = tick
        self._last: int | None = None

    def since(self, ticks: int) -> float:
        """Compute the time from the last reading to another one, negative if that is older [s].

        It is at most half of the time in which the ticks wrap; before the first reading it is 0.

        >>> clock = TimeUnwrapper(modulus=1000, tick=0.001)
        >>> clock.unwrap(990), clock.since(4), clock.since(980)
        (0.99, 0.014, -0.01)
        """
        half = self._modulus // 2
        last = ticks if self._last is None else self._last
        return ((ticks - last + half) % self._modulus - half) * self._tick

    def unwrap(self, ticks: int) -> float:
        """Compute the device time [s] of a reading that is not older than the previous one.

        >>> clock = TimeUnwrapper(modulus=1000, tick=0.001)
        >>> [clock.unwrap(ticks) for ticks in (990, 999, 4)]
        [0.99, 0.999, 1.004]
        """
        if self._last is None:
            self._last = ticks
        self._last += (ticks - self._last) % self._modulus
        return self._last * self._tick

    def unwrap_all(self, ticks: NDArray[np.integer[Any]]) -> Array:
        """Compute the device times [s] of readings from their ticks, in order, both of shape (n,).

        >>> TimeUnwrapper(modulus=1000, tick=0.001).unwrap_all(np.array([990, 999, 4]))
        array([0.99 , 0.999, 1.004])
        """
        if len(ticks) == 0:
            return np.empty(0)
        start = int(ticks[0]) if self._last is None else self._last
        turns, last = divmod(start, self._modulus)
        ticks = ticks.astype(np.int64)
        if ticks[0] >= last and (ticks[1:] >= ticks[:-1]).all():  # they do not wrap
            total = turns * self._modulus + ticks
        else:
            total = start + np.cumsum(np.diff(ticks, prepend=start) % self._modulus)
        self._last = int(total[-1])
        return np.asarray(total * self._tick, dtype=float)
