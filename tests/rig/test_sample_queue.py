# SPDX-License-Identifier: MIT
"""Nobody waits, and what finds no room is counted."""

from hypothesis import given
from hypothesis import strategies as st

from rig.device import Sample
from rig.sample_queue import LossyTap, SampleQueue


def numbered(first, count):
    return [Sample(float(n), None, n, (n,)) for n in range(first, first + count)]


@given(st.lists(st.integers(1, 30), max_size=20), st.integers(1, 60))
def test_a_queue_keeps_order_and_counts_what_it_drops(sizes, limit):
    queue, sent, taken, refused = SampleQueue(limit=limit), 0, [], 0
    for i, size in enumerate(sizes):
        batch = numbered(sent, size)
        sent += size
        if not queue.put(batch):
            refused += size
        if i % 3 == 0:
            taken += queue.take()
    taken += queue.take()
    numbers = [sample.sequence for sample in taken]
    assert numbers == sorted(numbers)
    assert len(numbers) + queue.dropped == sent
    assert queue.dropped == refused


def test_a_tap_keeps_the_newest_and_never_refuses():
    tap = LossyTap(limit=10)
    for first in range(0, 1000, 7):
        tap.put(numbered(first, 7))
    assert [sample.sequence for sample in tap.take()] == list(range(991, 1001))
    assert tap.take() == []


def test_a_tap_that_nobody_takes_from_holds_no_more_than_its_limit_and_a_read():
    tap = LossyTap(limit=10)
    for size in (1, 400, 3, 7, 400, 2):
        tap.put(numbered(0, size))
        assert sum(map(len, tap._newest)) < 10 + 400
    for first in range(500):
        tap.put(numbered(first, 1))
    assert sum(map(len, tap._newest)) == 10
