# SPDX-License-Identifier: MIT
import numpy as np
from hypothesis import given
from hypothesis import strategies as st
from scipy.spatial.transform import Rotation

from model.walk.quaternion import (
    roll_pitch_yaw,
    rotate,
    rotation_matrix,
    turned_about_vertical,
    unwrapped_yaw,
)


@given(st.lists(st.floats(-30.0, 30.0), min_size=3, max_size=3), st.floats(1e-5, 0.1))
def test_turning_by_a_vector_is_its_rotation(w, dt):
    q = Rotation.from_euler("ZYX", [0.4, -0.3, 0.2]).as_quat(scalar_first=True)
    expected = Rotation.from_rotvec(np.array(w) * dt) * Rotation.from_quat(q, scalar_first=True)
    matrix = np.empty((3, 3))
    rotate(q, np.array(w), dt)
    rotation_matrix(q, matrix)
    np.testing.assert_allclose(matrix, expected.as_matrix(), atol=1e-12)


def test_angles_of_a_quaternion_are_those_it_was_made_of():
    angles = np.random.default_rng(1).uniform(-1.4, 1.4, (50, 3))
    angles[:, 2] = np.linspace(-6.0, 6.0, 50)  # more than a turn: yaw is unwrapped
    q = Rotation.from_euler("ZYX", angles[:, ::-1]).as_quat(scalar_first=True)
    found = roll_pitch_yaw(q)
    found[:, 2] += angles[0, 2] - found[0, 2]
    np.testing.assert_allclose(found, angles, atol=1e-9)
    np.testing.assert_array_equal(unwrapped_yaw(q), roll_pitch_yaw(q)[:, 2])


def test_a_turn_about_the_vertical_adds_to_yaw_alone():
    q = Rotation.from_euler("ZYX", [0.4, -0.3, 0.2]).as_quat(scalar_first=True)
    turned = turned_about_vertical(q, 0.5)
    np.testing.assert_allclose(roll_pitch_yaw(turned[None])[0], [0.2, -0.3, 0.9])
