# SPDX-License-Identifier: MIT
import numpy as np
from hypothesis import given
from hypothesis import strategies as st

from model.robot import Robot
from model.walk.bend import Bend, bent_poses, move_state, turned_vectors
from model.walk.dynamics import unsettled_state
from model.walk.ground import FLAT, with_slope
from model.walk.quaternion import roll_pitch_yaw, turned_about_vertical

SLOPE = with_slope(FLAT, 0.1, -0.05)


def poses(n=30):
    s = np.linspace(0.0, 0.3, n)
    tilted = turned_about_vertical(np.array([0.99, 0.1, 0.05, 0.0]) / np.sqrt(0.9926), 0.2)
    return np.column_stack([s, 0 * s, 0.06 + 0 * s, np.tile(tilted, (n, 1))])


@given(st.floats(-0.1, 0.1), st.floats(-1.0, 1.0))
def test_bent_poses_keep_their_tilt_and_turn_by_curvature_times_distance(stretch, curvature):
    pose = poses()
    moved, turned = bent_poses(pose, Bend(stretch, curvature), SLOPE)
    np.testing.assert_allclose(turned, curvature * pose[:, 0], atol=1e-12)
    before, after = roll_pitch_yaw(pose[:, 3:]), roll_pitch_yaw(moved[:, 3:])
    np.testing.assert_allclose(after[:, :2], before[:, :2], atol=1e-12)
    np.testing.assert_allclose(after[:, 2] - before[:, 2], turned, atol=1e-12)
    length = np.hypot(*np.diff(moved[:, :2], axis=0).T).sum()
    np.testing.assert_allclose(length, 0.3 * (1 + stretch))


def test_bent_poses_rise_as_the_plane_does():
    pose = poses()
    moved, _ = bent_poses(pose, Bend(0.1, 0.5), SLOPE)
    rise = moved[:, 2] - pose[:, 2]
    away = moved[:, :2] - pose[:, :2]
    np.testing.assert_allclose(rise, away @ [SLOPE.slope_x, SLOPE.slope_y], atol=1e-12)


def test_a_moved_state_has_its_velocities_turned():
    state = unsettled_state(Robot())
    state.v[:], state.w[:] = (1.0, 0.0, 0.5), (0.0, 2.0, 0.1)
    pose = np.array([1.0, 2.0, 3.0, *turned_about_vertical(state.q, np.pi / 2)])
    move_state(state, pose, np.pi / 2)
    np.testing.assert_allclose(state.v, [0.0, 1.0, 0.5], atol=1e-12)
    np.testing.assert_allclose(state.w, [-2.0, 0.0, 0.1], atol=1e-12)
    np.testing.assert_allclose([*state.p, *state.q], pose)


def test_vectors_in_the_plane_are_turned_to_the_left():
    np.testing.assert_allclose(
        turned_vectors(np.array([[1.0, 0.0]]), np.pi / 2), [[0, 1]], atol=1e-12
    )
