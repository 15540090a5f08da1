# SPDX-License-Identifier: MIT
"""Unwrap sequence numbers and device times; detect lost, duplicate or late samples, restarts."""

from typing import Any, Final

import numpy as np
from numpy.typing import NDArray

from model.arrays import Array

LATE_WINDOW: Final = 64
"""Default distance behind the newest number below which a sample is late, not a restart."""
SLACK: Final = 64
"""Jump forward that is always a loss, added to the number that can have been sent [samples]."""


class SequenceTracker:
    """Unwraps the sequence numbers of one stream and counts losses, duplicates and restarts.

    A jump forward counts as a loss up to `SLACK` plus the number of samples that the device can
    send since the previous read at twice its rate. A longer jump, or one far back, is a restart of
    the device, after which the number of missing samples is unknown. (The time is not counted from
    the last sample, because samples of one read may have waited together in a buffer.)

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
        self._read_time = self._read_before = 0.0

    def accept(self, number: int, host_time: float) -> int | None:
        """Unwrap the sequence number of a sample and update the counters.

        Args:
            number: Number as the device sent it.
            host_time: Time at which it was read [s].

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
            self._last, self._read_time, self._read_before = number, host_time, host_time
            return number
        if host_time != self._read_time:
            self._read_time, self._read_before = host_time, self._read_time
        ahead = (number - self._last) % self._modulus
        behind = self._modulus - ahead
        if ahead == 0 or behind < self._late_window:
            self.repeated += 1
            return None
        if self._plausible(ahead, host_time - self._read_before):
            self.lost += ahead - 1
        else:
            self.restarted += 1
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
                self._last = int(accepted[-1])
                return slice(None), accepted
        one_by_one = [self.accept(number, host_time) for number in numbers.tolist()]
        kept = np.array([number is not None for number in one_by_one], bool)
        return kept, np.array([n for n in one_by_one if n is not None], np.int64)

    def _plausible(self, ahead: int, elapsed: float) -> bool:
        """Return whether a jump by `ahead` is a loss rather than a restart of the device.

        With a rate, the jump is at most `SLACK` plus twice the samples of the time `elapsed` [s]
        since the previous read; without one, it is less than half of the modulus.
        """
        if self._rate is None:
            return ahead < self._modulus // 2
        return ahead <= SLACK + 2 * self._rate * elapsed


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
