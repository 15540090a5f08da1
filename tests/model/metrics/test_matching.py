# SPDX-License-Identifier: MIT
"""Poses are matched with the nearest in time, each once."""

import numpy as np
import pytest

from model.metrics.matching import match_times


def test_the_nearest_time_within_the_limit_is_taken():
    first, second = match_times(np.array([0.0, 1.0, 2.0, 3.0]), np.array([0.1, 2.2]), most=0.15)
    assert (first.tolist(), second.tolist()) == ([0], [0])
    first, second = match_times(
        np.array([0.0, 1.0, 2.0, 3.0]), np.array([0.1, 2.2]), most=0.2 + 1e-9
    )
    assert (first.tolist(), second.tolist()) == ([0, 2], [0, 1])


def test_no_time_is_matched_twice():
    first, second = match_times(
        np.array([0.0, 0.9, 1.0, 1.05]), np.array([0.0, 1.04, 5, 6, 7]), most=1
    )
    assert first.tolist() == [0, 3]
    assert second.tolist() == [0, 1]


@pytest.mark.parametrize("seed", range(20))
def test_pairs_are_those_of_an_exhaustive_search(seed):
    rng = np.random.default_rng(seed)
    first, second = np.sort(rng.uniform(0, 10, 30)), np.sort(rng.uniform(0, 10, 200))
    gap = np.abs(first[:, None] - second[None, :])
    expected = {}
    for i in range(30):
        j = int(gap[i].argmin())
        if gap[i, j] <= 0.02 and (j not in expected or gap[i, j] < gap[expected[j], j]):
            expected[j] = i
    a, b = match_times(first, second, most=0.02)
    assert dict(zip(b.tolist(), a.tolist(), strict=True)) == expected
    c, d = match_times(second, first, most=0.02)
    assert (c.tolist(), d.tolist()) == (b.tolist(), a.tolist())


def test_times_that_never_meet_give_no_pair():
    first, second = match_times(np.array([0.0, 1.0]), np.array([10.0, 11.0, 12.0]), most=0.5)
    assert len(first) == len(second) == 0
