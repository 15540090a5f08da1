# SPDX-License-Identifier: MIT
"""Tracks of drawn walks err as much as their covariances say; a long test judges it by many."""

import numpy as np
import pytest

from benchmarks.accuracy.drawn_walks.world import PLAIN, Spreads
from benchmarks.accuracy.tracked_walks import jobs, score


def test_walks_are_drawn_with_both_lenses_at_all_distances():
    drawn = jobs(20, None)
    assert {lens.focal for _, lens, _, _ in drawn} == {(1394.0, 1394.0), (980.0, 982.0)}
    assert len({distance for _, _, distance, _ in drawn}) == 5
    assert len({spreads.edges for _, _, _, spreads in drawn}) == 20


def test_a_walk_is_scored_by_its_covariance():
    scored = score((1, PLAIN, 2.6, Spreads()))
    assert 0.1 < scored.marginal < 5
    assert 0.1 < scored.joint < 5
    assert np.all(scored.sd > 0)


@pytest.mark.long
def test_errors_are_as_large_as_the_covariances_say():
    scored = [score(job) for job in jobs(60, None)]
    assert np.mean([each.marginal for each in scored]) == pytest.approx(1.0, abs=0.25)
    assert np.mean([each.joint for each in scored]) == pytest.approx(1.0, abs=0.2)
