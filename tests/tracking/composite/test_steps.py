# SPDX-License-Identifier: MIT
"""Steps lead there and back, and chains of them are the same from anywhere."""

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from support.drawn_board import STEPS
from tracking.composite.steps import (
    LEAST_STEP,
    REACH,
    apart,
    are_apart,
    beside,
    headed,
    is_beside,
    is_near,
    nearby,
    shifted_sets,
    steady_chain,
    step_between,
    stepped,
    unsteadiness,
)

POSES = st.tuples(st.floats(-1, 1), st.floats(-1, 1), st.floats(-3, 3)).map(np.array)


@given(pose=POSES, step=STEPS)
def test_a_step_there_and_back_ends_where_it_began(pose, step):
    np.testing.assert_allclose(step_between(pose, stepped(pose, step)), step, atol=1e-9)
    np.testing.assert_allclose(stepped(stepped(pose, step), -step), pose, atol=1e-9)


@given(pose=POSES, step=STEPS, more=st.floats(-0.05, 0.05))
def test_a_chain_is_the_same_from_any_of_its_exposures(pose, step, more):
    chain = steady_chain(pose, step, more, 4, 0)
    first = step_between(chain[2], chain[3])
    again = steady_chain(chain[2], first, more, 2, 2)
    np.testing.assert_allclose(again[[4, 3, 0, 1, 2]], chain, atol=1e-9)


def test_steady_steps_are_steady_and_a_slip_is_not():
    walk = steady_chain(np.zeros(3), np.array([0.1, 0.0, 0.1]), 0.0, 6, 0)
    assert unsteadiness(walk) == pytest.approx(0.0, abs=1e-12)
    walk[3, 0] += 0.02
    assert unsteadiness(walk) > 10


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


def test_an_exposure_beside_another_has_nearly_its_heading_and_is_a_step_away():
    pose = np.array([0.1, 0.2, 0.4])
    assert is_beside(np.add(pose, [0.2, 0, 0.3]), [pose], 0.2)
    assert not is_beside(np.add(pose, [0.2, 0, 0.7]), [pose], 0.2)
    assert not is_beside(np.add(pose, [0.3, 0, 0.0]), [pose], 0.2)
    assert not is_beside(pose, [], 0.2)


def test_shifted_sets_gain_or_lose_an_exposure_at_the_ends_of_the_walk():
    walk = steady_chain(np.zeros(3), np.array([0.1, 0.0, 0.1]), 0.0, 3, 0)
    longer = steady_chain(np.zeros(3), np.array([0.1, 0.0, 0.1]), 0.0, 4, 1)
    for poses in shifted_sets(walk[[1, 0, 2, 3]]):
        np.testing.assert_array_equal(poses[0], walk[1])
        assert 2 <= len(poses) <= 6
        assert all(np.abs(longer - pose).max(axis=1).min() < 1e-9 for pose in poses)
