# SPDX-License-Identifier: MIT
"""Recorded samples come again at their pace through the interface of a live stream."""

import pytest

from rig.clock import ManualClock
from rig.device import Sample
from rig.errors import ProtocolError
from rig.replay import ReplayStream


def samples(*numbers):
    """Return samples 0.1 s apart with these numbers."""
    return [Sample(5.0 + 0.1 * i, float(i), n, (n,)) for i, n in enumerate(numbers)]


def replay(recorded):
    clock = ManualClock(100.0)
    return ReplayStream(recorded, name="legs", source="replay:RUN", clock=clock), clock


def test_each_sample_comes_when_it_is_due():
    stream, clock = replay(samples(1, 2, 3))
    with stream:
        assert [s.counts for s in stream.read(0.0)] == [(1,)]
        assert stream.read(0.05) == []
        (second,) = stream.read(0.0501)
        assert second[1:] == samples(1, 2)[1][1:]
        assert second.host_time == pytest.approx(100.1)
        clock.sleep(10.0)
        assert [s.counts for s in stream.read(0.0)] == [(3,)]
        assert stream.finished


def test_what_was_lost_is_counted_as_lost_again():
    stream, clock = replay(samples(1, 4, 5))
    with stream:
        clock.sleep(1.0)
        stream.read(0.0)
    assert (stream.counters.received, stream.counters.lost) == (3, 2)


def test_a_recording_at_its_end_is_silent():
    stream, clock = replay(samples(1))
    with stream:
        stream.read(0.0)
        assert stream.read(0.5) == []
    assert clock.now() == 100.5


def test_a_recording_whose_time_runs_back_is_not_replayed():
    recorded = [Sample(1.0, None, 0, ()), Sample(0.5, None, 1, ())]
    with pytest.raises(ProtocolError, match=r"falls from 1 s to 0\.5"):
        replay(recorded)
