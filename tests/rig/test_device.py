# SPDX-License-Identifier: MIT
"""Samples of a stream one by one for a while, whether it sends or not."""

import pytest

from rig.clock import ManualClock
from rig.device import Counters, Sample, iterate


class Ticking:
    """Gives a sample every 0.25 s of its clock, or none at all."""

    def __init__(self, clock, *, silent=False):
        self._clock, self._silent, self.waits = clock, silent, []

    def read(self, timeout):
        self.waits.append(timeout)
        self._clock.sleep(timeout)
        return [] if self._silent else [Sample(self._clock.now(), None, None, ())]


@pytest.mark.parametrize("silent", [True, False])
def test_iterating_ends_on_time(silent):
    clock = ManualClock(7.0)
    stream = Ticking(clock, silent=silent)
    found = list(iterate(stream, duration=1.05, clock=clock, wait=0.25))
    assert clock.now() == pytest.approx(8.05)
    assert len(found) == (0 if silent else 5)
    assert stream.waits[-1] == pytest.approx(0.05)


def test_rejected_frames_are_damaged_repeated_and_refused():
    assert Counters(received=9, lost=5, damaged=1, repeated=2, refused=4).rejected == 7


def test_what_was_counted_since_is_the_difference_of_each_number():
    earlier = Counters(received=9, lost=5, restarted=1)
    assert Counters(received=12, lost=5, repeated=2, restarted=1).since(earlier) == Counters(
        received=3, repeated=2
    )
