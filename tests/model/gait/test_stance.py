# SPDX-License-Identifier: MIT
import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from model.errors import DomainError
from model.gait.stance import event_intervals, stance_intervals


@given(st.floats(-20.0, 20.0), st.floats(0.3, 5.0), st.floats(-2.0, 2.0), st.floats(0.1, 6.0))
def test_steady_leg_stands_for_the_share_of_its_stance_angle(start, turns, down, stance):
    t = np.linspace(0.0, 1.0, 50)
    theta = (start + 2 * np.pi * np.ceil(turns) * t)[:, None]
    (found,) = stance_intervals(t, theta, down, down + stance)
    assert (found[:, 1] - found[:, 0]).sum() == pytest.approx(stance / (2 * np.pi), abs=1e-9)


@given(st.lists(st.floats(-3.0, 9.0), min_size=2, max_size=20))
def test_it_stands_exactly_where_the_angle_is_between_touchdown_and_liftoff(angles):
    t = np.arange(len(angles), dtype=float)
    theta = np.array(angles)[:, None]
    (found,) = stance_intervals(t, theta, 0.7, 2.1)
    at = np.linspace(0.0, t[-1], 301)[1:-1]
    turned = (np.interp(at, t, theta[:, 0]) - 0.7) % (2 * np.pi)
    clear = np.abs(turned[:, None] - [0.0, 1.4, 2 * np.pi]).min(axis=1) > 1e-6
    stands = ((found[:, :1] <= at) & (at < found[:, 1:])).any(axis=0)
    np.testing.assert_array_equal(stands[clear], (turned < 1.4)[clear])


def test_resting_leg_stands_all_the_time_or_never():
    t = np.array([0.0, 1.0, 2.0])
    theta = np.tile([1.0, 3.0], (3, 1))
    stands, flies = stance_intervals(t, theta, 0.7, 2.1)
    assert stands.tolist() == [[0.0, 2.0]]
    assert flies.shape == (0, 2)


def test_leg_that_turns_back_over_its_touchdown_stands_twice():
    t = np.array([0.0, 1.0, 2.0, 3.0])
    theta = np.array([[0.5], [0.9], [0.5], [0.9]])
    (found,) = stance_intervals(t, theta, 0.7, 2.1)
    np.testing.assert_allclose(found, [[0.5, 1.5], [2.5, 3.0]])


def test_events_are_cut_at_the_chart_and_left_out_beyond_it():
    down, up = np.array([[0.0], [2.0], [4.0]]), np.array([[1.0], [3.0], [5.0]])
    assert event_intervals(down, up, (0.5, 2.5))[0].tolist() == [[0.5, 1.0], [2.0, 2.5]]


def test_liftoff_before_touchdown_is_refused_with_its_leg():
    with pytest.raises(DomainError, match="leg 2 touches down at 90 and lifts off at 45 degrees"):
        stance_intervals(np.arange(2.0), np.zeros((2, 2)), [0.0, np.pi / 2], [np.pi / 2, np.pi / 4])
