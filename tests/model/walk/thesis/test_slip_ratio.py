# SPDX-License-Identifier: MIT
import numpy as np
import pytest

from model.walk.thesis.slip_ratio import along, walk_slip


@pytest.mark.parametrize(("leg", "ground", "slip"), [(1.0, 0.5, 1.0), (0.5, 1.0, -0.5), (0, 0, 0)])
def test_the_walk_s_slip_is_the_excess_over_the_ground_speed(leg, ground, slip):
    assert walk_slip(float(leg), float(ground), True) == pytest.approx(slip)


def test_slip_on_standing_ground_is_cut_off():
    assert walk_slip(1.0, 1e-9, True) == 100.0


def test_a_leg_that_turns_back_by_a_hair_drives_at_full_grip_in_the_listing_only():
    assert walk_slip(-1e-6, 0.1, False) > 0.9
    assert walk_slip(-1e-6, 0.1, True) == pytest.approx(-1.0, abs=1e-4)


def test_velocity_along_an_axis_counts_rotation_about_the_arm():
    v, arm = np.array([1.0, 2.0, 3.0, 0.1, 0.2, 0.3]), np.array([0.5, -0.4, 0.3])
    full = v[:3] + np.cross(v[3:], arm)
    for axis in np.eye(3):
        assert along(axis, v, arm) == pytest.approx(axis @ full)
