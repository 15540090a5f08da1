# SPDX-License-Identifier: MIT
import numpy as np
import pytest
from hypothesis import example, given
from hypothesis import strategies as st

from model.contact.events import next_stance
from model.contact.stance import resting_stance
from model.errors import DomainError
from model.robot import Robot

ROBOT = Robot()
THETA = st.lists(st.floats(0.8, 2.2), min_size=6, max_size=6).map(np.array)
TURN = st.lists(st.floats(0.0, 0.1), min_size=6, max_size=6).map(np.array)


def on_ground(stance):
    return tuple(int(i) for i in np.flatnonzero(stance.standing))


@given(THETA)
def test_where_nothing_turns_nothing_changes(theta):
    rest = resting_stance(ROBOT, theta)
    same = next_stance(ROBOT, theta, contact=on_ground(rest))
    assert on_ground(same) == on_ground(rest)


@given(THETA, TURN)
def test_no_leg_is_below_the_ground_after_a_step(theta, turn):
    contact = on_ground(resting_stance(ROBOT, theta))
    assert next_stance(ROBOT, theta + turn, contact=contact).clearance.min() > -1e-9


@given(THETA, TURN)
@example(np.array([1.0, 1.0, 1.625, 1.4375, 1.375, 1.34375]), np.array([0, 0, 0, 0.0625, 0, 0]))
def test_always_balanced_the_weight_stays_inside(theta, turn):
    contact = on_ground(resting_stance(ROBOT, theta))
    stance = next_stance(ROBOT, theta + turn, contact=contact, always_balanced=True)
    assert stance.depth > -1e-9


def test_a_leg_that_reaches_the_ground_replaces_one_that_stood():
    theta = np.radians([160.0, 90.0, 80.0, 120.0, 90.0, 120.0])
    contact = on_ground(resting_stance(ROBOT, theta))
    assert contact == (1, 2, 4)
    theta[0], theta[2] = np.radians(100.0), np.radians(130.0)
    assert on_ground(next_stance(ROBOT, theta, contact=contact)) == (0, 1, 4)


def test_legs_that_cannot_carry_are_refused():
    with pytest.raises(DomainError, match="legs 1, 3, 5 lie on one line"):
        next_stance(ROBOT, np.full(6, np.pi / 2), contact=(0, 2, 4))


def test_three_feet_on_one_line_leave_the_stance_to_the_other_legs():
    hips = ROBOT.hips.copy()
    hips[2] = hips[:2].mean(axis=0) - [0.02, 0.0, 0.0]  # between legs 1 and 2, 0.02 m behind them
    robot = Robot(hips=hips)
    theta = np.full(6, np.radians(100.0))
    # The toe of leg 3 is 0.02 m further forward than those of legs 1 and 2: on their line.
    theta[2] = np.arccos(np.cos(theta[0]) + 0.02 / (2 * robot.leg_radius))
    assert next_stance(robot, theta, contact=tuple(range(6))).depth > 0
