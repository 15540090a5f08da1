# SPDX-License-Identifier: MIT
import numpy as np
from hypothesis import given
from hypothesis import strategies as st

from rig.links.sequence import LATE_WINDOW, SequenceTracker, TimeUnwrapper


@given(
    start=st.integers(0, 65_535),
    steps=st.lists(st.integers(1, 200), min_size=1, max_size=50),
)
def test_what_is_received_and_lost_is_what_was_sent(start, steps):
    tracker = SequenceTracker(modulus=1 << 16)
    numbers = [start]
    for step in steps:
        numbers.append(numbers[-1] + step)
    taken = [tracker.accept(number % 65_536, 0.0) for number in numbers]
    assert taken == numbers
    assert tracker.lost + len(numbers) == numbers[-1] - numbers[0] + 1


@given(st.integers(0, LATE_WINDOW - 2), st.integers(100, 60_000))
def test_a_doubled_or_late_number_is_refused(back, last):
    tracker = SequenceTracker(modulus=1 << 16)
    tracker.accept(last, 0.0)
    assert tracker.accept(last - back, 0.0) is None
    assert (tracker.repeated, tracker.lost, tracker.restarted) == (1, 0, 0)


def test_a_device_that_numbers_anew_has_restarted_and_its_numbers_go_on_growing():
    tracker = SequenceTracker(modulus=1 << 32, rate=100.0)
    before = [tracker.accept(n, n / 100) for n in range(5000, 5005)]
    after = [tracker.accept(n, 60 + n / 100) for n in range(3)]
    assert (tracker.restarted, tracker.lost) == (1, 0)
    assert before[-1] < after[0] < after[1] < after[2]


def test_a_gap_is_a_loss_as_far_as_the_device_can_have_come():
    tracker = SequenceTracker(modulus=1 << 16, rate=100.0)
    tracker.accept(0, 0.0)
    tracker.accept(1000, 10.0)
    assert (tracker.lost, tracker.restarted) == (999, 0)
    tracker.accept(9000, 10.1)
    assert (tracker.lost, tracker.restarted) == (999, 1)


def test_samples_that_waited_together_are_not_taken_for_a_restart():
    tracker = SequenceTracker(modulus=1 << 32, rate=100.0)
    tracker.accept(0, 0.0)
    assert tracker.accept(1, 5.0) == 1
    assert tracker.accept(400, 5.0) == 400  # an overflowed buffer, read at once
    assert (tracker.lost, tracker.restarted) == (398, 0)


class Reader:
    """Reads numbers and, where the device sends its time, ticks, as the drivers do."""

    def __init__(self, rate, *, timed):
        self.tracker = SequenceTracker(modulus=1 << 32, rate=rate)
        self.clock = TimeUnwrapper(modulus=1 << 32, tick=1e-6) if timed else None
        self.received = 0

    def read(self, numbers, at, *, rate):
        """Read samples at a host time, taken so many a second since the device was switched on."""
        for number in numbers:
            ticks = round(number / rate * 1e6) % (1 << 32)
            elapsed = None if self.clock is None else self.clock.since(ticks)
            if self.tracker.accept(number, at, elapsed) is not None:
                self.received += 1
                if self.clock is not None:
                    self.clock.unwrap(ticks)


POLL = 0.004
RATES = st.sampled_from([100.0, 250.0, 1000.0, 7000.0])


def follow(reader, numbers, at, *, rate):
    """Read samples as they come, and return the host time after the last."""
    each = max(round(rate * POLL), 1)
    for k in range(0, len(numbers), each):
        at += len(numbers[k : k + each]) / rate
        reader.read(numbers[k : k + each], at, rate=rate)
    return at


@given(
    rate=RATES,
    pace=st.sampled_from([1.0, 0.999, 0.8, 1.25]),
    pause=st.floats(0.3, 20.0),
    waited=st.floats(0.0, 0.9),
    reads=st.integers(1, 5),
    before=st.integers(1, 500),
    timed=st.booleans(),
)
def test_a_pause_of_the_host_is_a_loss_of_what_no_buffer_held(
    rate, pace, pause, waited, reads, before, timed
):
    true = rate * (pace if timed else min(pace, 1.0))
    reader, missed = Reader(rate, timed=timed), round(pause * true)
    at = follow(reader, list(range(before)), 0.0, rate=true)
    kept = list(range(before, before + round(waited * missed)))
    each = len(kept) // reads + 1
    for k in range(reads):  # what waited comes in one read or in several
        reader.read(kept[k * each : (k + 1) * each], at + pause + k * POLL, rate=true)
    live = before + missed + round(reads * POLL * true)
    follow(reader, list(range(live, live + 300)), at + pause + reads * POLL, rate=true)
    tracker = reader.tracker
    assert (tracker.restarted, tracker.repeated) == (0, 0)
    assert reader.received == before + len(kept) + 300
    assert tracker.lost == live + 300 - reader.received


@given(
    rate=RATES,
    before=st.integers(LATE_WINDOW + 1, 1000),
    first=st.integers(0, 1000),
    silent=st.floats(0.0, 20.0),
    timed=st.booleans(),
)
def test_a_restart_is_seen_however_short_the_device_had_run(rate, before, first, silent, timed):
    first = min(first, before - 1 - LATE_WINDOW)  # numbers lost before it are unknown
    reader = Reader(rate, timed=timed)
    at = follow(reader, list(range(before)), 0.0, rate=rate)
    follow(reader, list(range(first, first + 40)), at + silent, rate=rate)
    tracker = reader.tracker
    assert (tracker.restarted, tracker.lost, tracker.repeated) == (1, 0, 0)
    assert reader.received == before + 40


def test_the_device_s_clock_tells_a_restart_from_a_late_sample_and_from_a_loss():
    def after(number, elapsed):
        tracker = SequenceTracker(modulus=1 << 16, rate=100.0)
        tracker.accept(20, 0.0)
        tracker.accept(number, 0.01, elapsed)
        return tracker.restarted, tracker.repeated, tracker.lost

    assert after(18, -0.02) == (0, 1, 0)
    assert after(20, 0.0) == (0, 1, 0)
    assert after(18, 0.03) == after(20, 0.3) == (1, 0, 0)  # the number ran back, the clock on
    assert after(18, -9.0) == after(25, -9.0) == (1, 0, 0)  # the clock ran back too far
    assert after(4020, 40.0) == (0, 0, 3999)
    assert after(4020, 0.04) == (1, 0, 0)


@given(st.lists(st.integers(0, 999), min_size=1, max_size=40))
def test_device_time_never_runs_back(steps):
    clock = TimeUnwrapper(modulus=1000, tick=0.001)
    total, ticks = 17, 17
    assert clock.unwrap(ticks) == 0.017
    for step in steps:
        total, ticks = total + step, (ticks + step) % 1000
        assert clock.unwrap(ticks) == total * 0.001


@given(
    st.lists(st.lists(st.integers(0, 255), max_size=8), max_size=6),
    st.integers(0, 255),
    st.integers(0, 40),
)
def test_numbers_taken_together_are_taken_as_one_by_one(reads, start, length):
    run = [(start + i) % 256 for i in range(length)]
    together = SequenceTracker(modulus=256, rate=10.0)
    single = SequenceTracker(modulus=256, rate=10.0)
    for at, numbers in enumerate([run[: length // 2], run[length // 2 :], *reads, run]):
        expected = [single.accept(number, float(at)) for number in numbers]
        kept, accepted = together.accept_all(np.array(numbers, int), float(at))
        assert accepted.tolist() == [number for number in expected if number is not None]
        taken = [n for n, number in zip(numbers, expected, strict=True) if number is not None]
        assert np.array(numbers, int)[kept].tolist() == taken
    assert vars(together) == vars(single)


@given(st.lists(st.lists(st.integers(0, 999), max_size=8), max_size=6))
def test_ticks_unwrapped_together_are_those_unwrapped_one_by_one(reads):
    together, single = (TimeUnwrapper(modulus=1000, tick=0.001) for _ in range(2))
    for ticks in [*reads, *map(sorted, reads)]:
        found = together.unwrap_all(np.array(ticks, int))
        assert found.tolist() == [single.unwrap(tick) for tick in ticks]
