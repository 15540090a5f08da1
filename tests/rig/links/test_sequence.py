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
