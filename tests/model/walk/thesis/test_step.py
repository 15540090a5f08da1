# SPDX-License-Identifier: MIT
"""Equations of the thesis's step, each against its text or mechanics."""

import numpy as np
import pytest

from model.gait.steering import tripod_angles, tripod_reference
from model.robot import Robot
from model.slip.thesis import thesis_curve
from model.walk.slip import Slip
from model.walk.thesis import ThesisOptions, walk_thesis
from model.walk.thesis.legs import SwitchedLegs
from model.walk.thesis.step import along, contact_axes, side_mean, turn, walk_slip


@pytest.mark.parametrize(("leg", "ground", "slip"), [(1.0, 0.5, 1.0), (0.5, 1.0, -0.5), (0, 0, 0)])
def test_the_walk_s_slip_is_the_excess_over_the_ground_speed(leg, ground, slip):
    assert walk_slip(float(leg), float(ground), True) == pytest.approx(slip)


def test_slip_on_standing_ground_is_cut_off():
    assert walk_slip(1.0, 1e-9, True) == 100.0


def test_a_leg_that_turns_back_by_a_hair_drives_at_full_grip_in_the_listing_only():
    assert walk_slip(-1e-6, 0.1, False) > 0.9
    assert walk_slip(-1e-6, 0.1, True) == pytest.approx(-1.0, abs=1e-4)


@pytest.mark.parametrize("tilt", [-0.3, 0.0, 0.2])
def test_contact_axes_are_orthonormal_and_right_handed(tilt):
    axes = np.empty((3, 3))
    contact_axes(0.7, tilt, axes)
    np.testing.assert_allclose(axes @ axes.T, np.eye(3), atol=1e-12)
    assert np.linalg.det(axes) == pytest.approx(1.0)


def test_a_turned_vector_keeps_its_length_and_yaw_turns_to_the_left():
    out = np.empty(3)
    turn(np.array([0, 0, 0, 0, 0, np.pi / 2]), np.array([1.0, 0, 0]), out)
    np.testing.assert_allclose(out, [0, 1, 0], atol=1e-12)
    turn(np.array([0, 0, 0, 0.2, -0.3, 0.5]), np.array([1.0, 2.0, 3.0]), out)
    assert np.linalg.norm(out) == pytest.approx(np.sqrt(14))


def test_velocity_along_an_axis_counts_rotation_about_the_arm():
    v, arm = np.array([1.0, 2.0, 3.0, 0.1, 0.2, 0.3]), np.array([0.5, -0.4, 0.3])
    full = v[:3] + np.cross(v[3:], arm)
    for axis in np.eye(3):
        assert along(axis, v, arm) == pytest.approx(axis @ full)


def test_a_side_s_mean_counts_legs_on_the_ground():
    values, down = np.arange(6.0), np.array([True, False, False, True, True, False])
    assert side_mean(values, down, 0) == pytest.approx(2.0)
    assert side_mean(values, down, 1) == pytest.approx(3.0)


def test_three_legs_carry_the_weight_at_every_sample_of_a_walk():
    legs = SwitchedLegs.of(tripod_reference(tripod_angles(np.radians(50.0), 1.2), 2.0))
    robot = Robot()
    weight = robot.mass * 9.81
    traction = Slip(thesis_curve(), "thesis").thesis_traction(weight=weight)
    path = walk_thesis(
        robot, legs, duration=2.0, traction=traction, options=ThesisOptions(dt=0.001)
    )
    assert np.all((path.normal_force > 0).sum(axis=1) <= 3)
    assert np.median(path.normal_force.sum(axis=1)) == pytest.approx(weight, rel=0.1)
    assert path.length > 0.05
