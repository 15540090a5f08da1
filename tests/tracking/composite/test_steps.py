# SPDX-License-Identifier: MIT
"""Candidates lie a step beside an exposure, and the best that are apart are kept."""

import numpy as np
import pytest

from tracking.composite.steps import (
    LEAST_STEP,
    REACH,
    apart,
    beside,
    distances,
    headed,
    improved,
    usual_step,
)


@pytest.mark.parametrize("turned", range(4))
@pytest.mark.parametrize("turn", [-0.6, 0.0, 0.3])
def test_a_square_robot_is_headed_along_the_arc_that_leads_to_it(turn, turned):
    after = np.array([0.3 * np.cos(turn / 2), 0.3 * np.sin(turn / 2), turn])
    seen = after + np.array([0, 0, turned * np.pi / 2])
    found = headed(seen, np.zeros((1, 3)), square=True)
    assert np.cos(found[2] - after[2]) == pytest.approx(1.0)


def test_places_beside_are_a_step_ahead_or_behind_and_never_to_the_side():
    pose, length = np.array([0.1, 0.2, 0.4]), 0.2
    places = beside(pose, length, spacing=0.02)
    away = np.hypot(*(places - pose)[:, :2].T)
    assert LEAST_STEP * length < away.min() < away.max() < REACH * length
    along = (places - pose)[:, :2] @ [np.cos(0.4), np.sin(0.4)] / away
    assert np.abs(along).min() > 0.5
    assert along.min() < 0 < along.max()


def test_the_best_of_places_in_one_place_is_taken():
    poses = np.array([[0.0, 0, 0], [0.01, 0, 0], [0.3, 0, 0], [0.6, 0, 0]])
    kept = apart(poses, np.array([1.0, 2.0, 3.0, -np.inf]), 0.1, most=9)
    np.testing.assert_array_equal(kept, poses[[2, 1]])


def test_the_usual_step_is_the_median_distance_to_the_nearest_other():
    poses = np.array([[0.0, 0, 0], [0.3, 0, 0], [0.5, 0, 0], [1.5, 0, 0]])
    np.testing.assert_allclose(distances(poses, poses[0]), [0.0, 0.3, 0.5, 1.5])
    assert usual_step(poses) == pytest.approx(0.25)
    assert usual_step(poses[:1]) == 0.0


def test_a_function_is_climbed_to_its_top():
    top, value = improved(lambda at: 2.0 - float(((at - 0.3) ** 2).sum()), np.zeros(2),
                          reach=(0.1, 0.1), tries=200)  # fmt: skip
    np.testing.assert_allclose(top, 0.3, atol=1e-3)
    assert value == pytest.approx(2.0, abs=1e-5)
