# SPDX-License-Identifier: MIT
"""How legs turn is found whatever their zeros and signs, and however long the walk takes."""

import numpy as np
import pytest

from model.gait.leg_motion import CLEAR, leg_motion
from support.leg_motions import T, tripod


def motion(theta: np.ndarray):
    found = leg_motion(theta)
    assert found is not None
    return found


def apart(first: np.ndarray, second: np.ndarray) -> np.ndarray:
    return np.abs((first - second + 0.5) % 1 - 0.5)


def test_a_tripod_stands_below_the_hips_in_two_groups():
    found = motion(tripod().angles(T))
    np.testing.assert_allclose(np.degrees(found.centre), 84, atol=1.5)  # from 50 to 118
    np.testing.assert_allclose(found.turns, 6, atol=0.2)
    assert (found.direction == 1).all()
    assert found.coherence > 0.95
    assert (apart(found.phase, np.array([0, 0.5, 0.5, 0, 0, 0.5])) < 0.04).all()


def test_phases_do_not_depend_on_signs_and_zeros():
    theta, rng = tripod(1.3).angles(T), np.random.default_rng(3)
    plain = motion(theta)
    sign, zero = rng.choice([-1, 1], 6), rng.uniform(-3, 3, 6)
    other = motion(sign * theta + zero)
    assert (apart(other.phase, plain.phase) < 0.03).all()
    np.testing.assert_allclose(other.weight, plain.weight, atol=0.02)
    np.testing.assert_array_equal(other.direction, sign)
    assert (
        apart(other.centre / (2 * np.pi), (sign * plain.centre + zero) / (2 * np.pi)) < 0.01
    ).all()


def test_time_does_not_matter():
    """A slow start and a rest of half the log change nothing but where the rows fall."""
    plain = motion(tripod().angles(T))
    start = np.where(T < 2, T**2 / 4, T - 1)
    late = motion(tripod().angles(np.concatenate([np.zeros(2000), start])))
    np.testing.assert_allclose(late.centre, plain.centre, atol=0.05)
    assert (apart(late.phase, plain.phase) < 0.05).all()


@pytest.mark.parametrize("noise", [0.0, 0.02])
def test_standing_legs_are_not_judged(noise):
    rng = np.random.default_rng(1)
    assert leg_motion(1.5 + rng.normal(0, noise, (4000, 6))) is None
    assert leg_motion(np.zeros((2, 6))) is None


def test_legs_that_turn_evenly_have_no_clear_stance():
    assert (motion(5 * T[:, None] + np.zeros(6)).weight < CLEAR).all()
