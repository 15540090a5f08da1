# SPDX-License-Identifier: MIT
"""Legs leave the ground on the side where they are free, and land where they touch it."""

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from model.gait.swing import LEAST_SWING, landing_angles, swing
from model.leg import hip_height, wrap_angle

ARC = np.pi
SIX = np.ones(6)


def height(theta):
    return hip_height(wrap_angle(np.pi / 2 - theta), 1.0, ARC - np.pi)


@given(st.floats(-1.0, 4.0), st.sampled_from([-1.0, 1.0]))
def test_a_swing_ends_at_the_touchdown_angle_in_the_sense_of_the_leg(lifted, sense):
    touchdown = np.radians(50.0 if sense > 0 else 118.0)
    landed, turned = swing(lifted * SIX, touchdown * SIX, sense * SIX, leg_arc=ARC, clear=True)
    assert wrap_angle(landed[0] - touchdown) == pytest.approx(0, abs=1e-9)
    last = lifted if np.isnan(turned[0]) else turned[0]
    assert sense * (landed[0] - last) > 0
    assert sense * (landed[0] - last) >= LEAST_SWING - 1e-9 or not np.isnan(turned[0])


@pytest.mark.parametrize(("lifted", "sense"), [(50.0, 1.0), (118.0, -1.0)])
def test_a_leg_that_would_stand_up_first_leaves_the_ground_the_other_way(lifted, sense):
    touchdown, at = np.radians(50.0 if sense > 0 else 118.0) * SIX, np.radians(lifted)
    landed, turned = swing(at * SIX, touchdown, sense * SIX, leg_arc=ARC, clear=True)
    np.testing.assert_allclose(turned, at - sense * np.pi / 2)
    np.testing.assert_allclose(landed, at, atol=1e-9)
    _, never = swing(at * SIX, touchdown, sense * SIX, leg_arc=ARC, clear=False)
    assert np.isnan(never).all()


@given(st.floats(0.9, 2.0))
def test_legs_land_at_the_height_of_the_highest_leg_of_their_side(standing):
    angles = np.array([standing, 1.0, 0.0, 0.0, 0.0, 0.0])
    flies, sense = np.array([False, False, *[True] * 4]), np.array([1.0, 1.0, 1.0, -1.0, -1.0, 1.0])
    found = landing_angles(angles, flies, sense, leg_arc=ARC)
    np.testing.assert_array_equal(found[:2], angles[:2])
    np.testing.assert_allclose(height(found[[2, 4]]), height(standing), atol=1e-6)
    np.testing.assert_allclose(height(found[[3, 5]]), height(1.0), atol=1e-6)
    assert found[2] <= np.pi / 2 <= found[4]
