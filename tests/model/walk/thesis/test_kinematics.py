# SPDX-License-Identifier: MIT
import numpy as np
import pytest

from model.walk.thesis.kinematics import side_mean, turn


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
