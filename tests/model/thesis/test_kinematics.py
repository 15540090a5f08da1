# SPDX-License-Identifier: MIT
import numpy as np
import pytest

from model.robot import Robot
from model.thesis.kinematics import Legs, place_legs, side_mean, turn
from model.thesis.step import Machine


def test_a_turned_vector_keeps_its_length_and_yaw_turns_to_the_left():
    out = np.empty(3)
    turn(np.array([0, 0, 0, 0, 0, np.pi / 2]), np.array([1.0, 0, 0]), out)
    np.testing.assert_allclose(out, [0, 1, 0], atol=1e-12)
    turn(np.array([0, 0, 0, 0.2, -0.3, 0.5]), np.array([1.0, 2.0, 3.0]), out)
    assert np.linalg.norm(out) == pytest.approx(np.sqrt(14))


def test_a_side_s_mean_counts_legs_on_the_ground():
    values, down = np.arange(6.0), np.array([True, False, False, True, True, False])
    assert side_mean(values, down, 0) == pytest.approx(2.0)
    assert side_mean(values, down, 1) == pytest.approx(3.0)


ROBOT = Robot()
MACHINE = Machine(
    ROBOT.hips, ROBOT.leg_radius, ROBOT.toe_beyond, ROBOT.mass, ROBOT.principal_inertia, ROBOT.track
)


def placed(theta, *, q, speed, before):
    """Return the kinematics of legs that all turn at one speed, of a body that does not move."""
    legs = Legs(*(np.empty(6) for _ in range(5)), np.empty((6, 3)), np.empty((6, 3)))
    turning = np.full(6, speed)
    place_legs(MACHINE, q, np.zeros(6), theta, turning, turning, before, legs)
    return legs


def test_legs_of_a_level_body_stand_below_their_hips():
    q, before = np.array([0.3, -0.2, 0.06, 0, 0, 0]), np.array([0.29, -0.2, 0.06])
    theta = np.linspace(0.6, 1.4, 6)
    legs = placed(theta, q=q, speed=2.0, before=before)
    np.testing.assert_allclose(legs.hip, ROBOT.hips + before)
    height = ROBOT.leg_radius * (1 + np.sin(theta))
    np.testing.assert_allclose(legs.height, height)
    np.testing.assert_allclose(legs.point[:, 2], q[2] + ROBOT.hips[:, 2] - height)
    np.testing.assert_allclose(legs.point[:, 1], q[1] + ROBOT.hips[:, 1])
    forward = ROBOT.leg_radius * np.cos(theta)
    np.testing.assert_allclose(legs.point[:, 0], q[0] + ROBOT.hips[:, 0] + forward)


def test_rates_of_hip_height_are_its_derivatives():
    q, theta, step = np.array([0, 0, 0.06, 0, 0, 0.0]), np.linspace(0.6, 1.4, 6), 1e-5
    earlier, now, later = (
        placed(theta + 2.0 * t, q=q, speed=2.0, before=q[:3]) for t in (-step, 0.0, step)
    )
    rate = (later.height - earlier.height) / (2 * step)
    np.testing.assert_allclose(now.height_rate, rate, rtol=1e-6)
    change = (later.height_rate - earlier.height_rate) / (2 * step)
    np.testing.assert_allclose(now.height_acceleration, change, rtol=1e-6)
