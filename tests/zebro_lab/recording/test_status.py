# SPDX-License-Identifier: MIT
"""A duration counts from the moment at which every stream has sent a sample."""

from types import SimpleNamespace

import pytest

from rig.clock_watch import ClockWatch
from rig.device import Counters, Sample
from rig.sample_queue import LossyTap
from zebro_lab.recording.status import FIRST_SAMPLE, StreamWatch, reading_failure


class Reader:
    """Reader of a stream that began at a time, or has not begun."""

    def __init__(self, first=None, failure=None):
        self.first, self.failure, self.counters, self.ends = first, failure, Counters(), []
        self.clock_watch, self.tap = ClockWatch(start=0.0), LossyTap()

    def end_at(self, t):
        self.ends.append(t)


def watch(readers, duration=5.0):
    noted = []
    recorder = SimpleNamespace(
        start=0.0, failure=None, folder="run", dropped=lambda name: 0,
        count_duration=lambda asked, since: noted.append((asked, since)),
    )  # fmt: skip
    devices = [
        SimpleNamespace(name=name, stream=SimpleNamespace(source="sim:x")) for name in readers
    ]
    return StreamWatch(recorder, readers, devices, duration), noted


def test_the_duration_counts_from_the_stream_that_begins_last():
    readers = {"legs": Reader(1.0), "imu": Reader()}
    streams, noted = watch(readers)
    assert streams.left(2.0) == 5.0
    assert streams.status(2.0).elapsed == 0.0
    readers["imu"].first = 3.0
    assert streams.left(4.0) == 4.0
    assert streams.status(4.0).elapsed == 1.0
    assert noted == [(5.0, 3.0)]
    assert readers["legs"].ends == [8.0]


def test_without_a_duration_nothing_is_left_to_count():
    streams, _ = watch({"legs": Reader()}, duration=None)
    assert streams.left(1e9) == float("inf")
    assert streams.problem(1e9) is None


def test_a_stream_that_never_begins_is_a_problem_once_it_is_late():
    streams, _ = watch({"legs": Reader(1.0), "imu": Reader()})
    assert streams.problem(0.9 * FIRST_SAMPLE) is None
    assert "no sample of imu" in streams.problem(1.1 * FIRST_SAMPLE)
    assert "switched on" in streams.problem(1.1 * FIRST_SAMPLE)


def test_packets_that_are_all_rejected_are_told_from_silence():
    reader = Reader()
    reader.counters = Counters(damaged=40, refused=2)
    problem = watch({"imu": reader})[0].problem(1.1 * FIRST_SAMPLE)
    assert "none of 42 packets is valid: check the baud rate" in problem
    assert "switched on" not in problem


def test_rates_are_samples_a_second():
    readers = {"legs": Reader(0.0)}
    streams, _ = watch(readers)
    readers["legs"].counters = Counters(received=200)
    assert streams.status(2.0).streams["legs"].rate == pytest.approx(100.0)


def test_what_could_not_be_read_on_is_named():
    assert reading_failure({"legs": Reader()}) is None
    assert reading_failure({"imu": Reader(failure=OSError("gone"))}) == "imu: OSError: gone"


def test_the_newest_samples_are_handed_on_once():
    readers = {"legs": Reader(0.0)}
    streams, _ = watch(readers)
    readers["legs"].tap.put([Sample(0.0, None, None, (1,))])
    newest = streams.status(0.1).streams["legs"].newest
    assert [sample.counts for sample in newest()] == [(1,)]
    assert list(newest()) == []
