# SPDX-License-Identifier: MIT
"""Chosen slips are better than even ones by their own objective, and what is kept is kept."""

import numpy as np
import pytest

from model.design.choose import choose_slips, objective, planned, spaced
from model.design.targets import Target


@pytest.fixture(scope="module")
def problem():
    """A line through noise: two coordinates, offset and slope, candidates from 0 to 1."""
    x = np.linspace(0.0, 1.0, 21)
    root = np.stack([np.ones_like(x), x], axis=-1)[None, :, None]  # (1, n, 1, 2)
    before = np.eye(2)[None] * 1e-3
    slope = Target("slope", ("slope",), ("dimensionless",), np.array([[[0.0, 1.0]]]))
    return before, root, slope


def test_a_slope_is_measured_at_both_ends(problem):
    before, roots, slope = problem
    found = choose_slips(before, roots, [slope], count=10, kept=np.array([], dtype=int))
    assert found.counts[[0, -1]].tolist() == [5, 5]
    assert found.counts.sum() == 10


def test_kept_slips_are_kept_and_the_rest_is_better_than_even_or_quadratic_spacing(problem):
    before, roots, slope = problem
    kept = np.array([0, 5, 10, 15, 20])
    found = choose_slips(before, roots, [slope], count=21, kept=kept)
    assert (found.counts[kept] >= 1).all()
    even = planned(before, roots, np.ones(21, dtype=int), [slope])
    near = np.round(20 * spaced(0.0, 1.0, 21)).astype(int)
    quadratic = planned(before, roots, np.bincount(near, minlength=21), [slope])
    assert found.objective < min(even.objective, quadratic.objective)


def test_what_is_left_is_the_inverse_of_all_information(problem):
    before, roots, slope = problem
    counts = np.arange(21)
    found = planned(before, roots, counts, [slope])
    design = np.repeat(roots[0, :, 0], counts, axis=0)
    expected = np.linalg.inv(before[0] + design.T @ design)
    assert found.covariance[0] == pytest.approx(expected)
    assert found.objective == pytest.approx(0.5 * np.log(expected[1, 1]))
    assert objective(found.covariance, [slope, slope]) == pytest.approx(found.objective)


def test_greedy_and_exchange_find_the_best_of_all_choices(problem):
    before, roots, _ = problem
    roots = roots[:, ::5]
    both = Target("both", ("a", "b"), ("dimensionless",) * 2, np.eye(2)[None])
    found = choose_slips(before, roots, [both], count=3, kept=np.array([2]))
    choices = [np.bincount([2, i, j], minlength=5) for i in range(5) for j in range(5)]
    best = min(planned(before, roots, each, [both]).objective for each in choices)
    assert found.objective == pytest.approx(best)


def test_more_points_leave_less(problem):
    before, roots, slope = problem
    none = np.array([], dtype=int)
    left = [choose_slips(before, roots, [slope], count=n, kept=none).objective for n in (2, 3, 9)]
    assert left[0] > left[1] > left[2]


def test_spacing_is_towards_zero_on_each_side():
    assert spaced(0.1, 0.5, 3).tolist() == pytest.approx([0.1, 0.2, 0.5])
    assert spaced(-1.0, 0.0, 3).tolist() == pytest.approx([-1.0, -0.25, 0.0])
    assert 0.0 in spaced(-0.3, 0.7, 8)
    assert np.all(np.diff(spaced(-0.3, 0.7, 8)) > 0)
