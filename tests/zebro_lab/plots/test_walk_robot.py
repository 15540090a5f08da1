# SPDX-License-Identifier: MIT
"""The drawn robot has the shape of the modelled one."""

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st
from scipy.spatial.transform import Rotation

from model.robot import Robot
from zebro_lab.plots.walk_robot import body_corners, leg_arcs, outline, to_world

angles = st.floats(-3, 3)


@given(angles, angles, angles)
def test_rotation_is_roll_then_pitch_then_yaw(roll, pitch, yaw):
    expected = Rotation.from_euler("ZYX", [yaw, pitch, roll]).as_matrix()
    turned = to_world(np.eye(3), np.zeros(3), np.array([roll, pitch, yaw]))
    np.testing.assert_allclose(turned, expected.T, atol=1e-12)


@given(st.lists(st.floats(0.0, 2 * np.pi), min_size=6, max_size=6), st.floats(np.pi, 4.0))
def test_leg_goes_from_hip_to_toe_along_its_arc(theta, arc):
    robot = Robot(leg_arc=arc)
    legs = leg_arcs(robot, np.array(theta))
    np.testing.assert_allclose(legs[:, 0], robot.hips, atol=1e-12)
    steps = np.linalg.norm(np.diff(legs, axis=1), axis=-1)
    np.testing.assert_allclose(steps, 2 * robot.leg_radius * np.sin(arc / 48), rtol=1e-9)


@pytest.mark.parametrize("theta", [0.3, 0.9, np.pi / 2, 2.0, 2.5])
def test_a_leg_reaches_as_low_as_its_hip_is_high_rolling_and_on_its_toe(theta):
    robot = Robot()
    lowest = leg_arcs(robot, np.full(6, theta))[..., 2].min(axis=1)
    rolling, r = theta <= np.pi / 2, robot.leg_radius
    height = r * (1 + np.sin(theta)) if rolling else 2 * r * np.sin(theta)
    np.testing.assert_allclose(lowest, -height, atol=2e-4 if rolling else 1e-12)  # of 25 points


def test_body_has_its_size_and_points_where_it_heads():
    robot = Robot()
    np.testing.assert_allclose(np.ptp(body_corners(robot), axis=0), robot.body_size)
    tip = outline(robot)[np.argmax(outline(robot)[:, 0])]
    ahead = to_world(tip, np.zeros(3), np.array([0.0, 0.0, np.pi / 2]))
    assert ahead[1] == pytest.approx(tip[0])
    assert abs(ahead[0]) < 1e-12
