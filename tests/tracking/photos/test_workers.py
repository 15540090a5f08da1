# SPDX-License-Identifier: MIT
"""Batches are done in order, on one core or several, and a wish to stop is obeyed."""

import pytest
from hypothesis import given
from hypothesis import strategies as st

from tracking.errors import TrackStopped
from tracking.photos.workers import LONGEST_BATCH, NoProgress, batches_of, run_batches


class Noted(NoProgress):
    """Notes every step, and asks to stop after some."""

    def __init__(self, stop_after: int = 99) -> None:
        self.steps: list[tuple[str, float | None]] = []
        self.stop_after = stop_after

    def step(self, what: str, fraction: float | None) -> None:
        """Note it."""
        self.steps.append((what, fraction))

    def stop_requested(self) -> bool:
        """Tell whether that were enough."""
        return len(self.steps) > self.stop_after


@given(count=st.integers(0, 200), workers=st.integers(1, 8))
def test_batches_are_the_whole_in_order(count, workers):
    batches = batches_of(range(count), workers)
    assert [each for batch in batches for each in batch] == list(range(count))
    assert all(1 <= len(batch) <= LONGEST_BATCH for batch in batches)


@pytest.mark.parametrize("workers", [1, 2])
def test_results_come_in_the_order_of_the_jobs(workers):
    progress = Noted()
    assert run_batches(abs, [-3, 2, -1], workers=workers, progress=progress, what="signs") == [
        3, 2, 1,
    ]  # fmt: skip
    assert progress.steps[0] == ("signs", 0.0)
    assert progress.steps[-1] == ("signs", 1.0)


def test_a_wish_to_stop_ends_the_work():
    with pytest.raises(TrackStopped):
        run_batches(abs, [1, 2, 3], workers=1, progress=Noted(stop_after=2), what="signs")
