# SPDX-License-Identifier: MIT
"""Places where an exposure may be lie along a walk."""

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from support.drawn_board import STEPS
from tracking.composite.candidates import (
    LEAST_STEP,
    REACH,
    apart,
    are_apart,
    beside,
    headed,
    is_near,
    nearby,
)
from tracking.composite.chain import stepped


@given(step=STEPS, turned=st.integers(0, 3))
def test_a_square_robot_is_headed_along_the_arc_that_leads_to_it(step, turned):
    after = stepped(np.zeros(3), step * [1, 0, 1])
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


def test_places_nearby_are_around_the_expected_one():
    pose = np.array([0.1, 0.2, 0.4])
    places = nearby(pose, 0.2)
    np.testing.assert_allclose(places.mean(axis=0), pose)
    assert all(is_near(place, pose, 0.2) for place in places)
    assert not is_near(np.add(pose, [0.1, 0, 0]), pose, 0.2)
    assert not is_near(np.add(pose, [0, 0, 0.5]), pose, 0.2)


def test_the_best_of_places_in_one_place_is_taken():
    poses = np.array([[0.0, 0, 0], [0.01, 0, 0], [0.3, 0, 0], [0.6, 0, 0]])
    kept = apart(poses, np.array([1.0, 2.0, 3.0, -np.inf]), 0.1, most=9)
    np.testing.assert_array_equal(kept, poses[[2, 1]])
    assert are_apart(poses[[0, 2]], 0.2)
    assert not are_apart(poses[:2], 0.2)
