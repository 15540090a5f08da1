# SPDX-License-Identifier: MIT
"""Equations of the thesis's step, each against its text or mechanics."""

import numpy as np
import pytest

from model.gait.steering import tripod_angles, tripod_reference
from model.robot import Robot
from model.slip.thesis_curve import thesis_curve
from model.thesis.legs import SwitchedLegs
from model.thesis.step import contact_axes
from model.thesis.traction import slip_traction
from model.thesis.walk import ThesisOptions, walk_thesis
from model.walk.slip import Slip


@pytest.mark.parametrize("tilt", [-0.3, 0.0, 0.2])
def test_contact_axes_are_orthonormal_and_right_handed(tilt):
    axes = np.empty((3, 3))
    contact_axes(0.7, tilt, axes)
    np.testing.assert_allclose(axes @ axes.T, np.eye(3), atol=1e-12)
    assert np.linalg.det(axes) == pytest.approx(1.0)


def test_three_legs_carry_the_weight_at_every_sample_of_a_walk():
    legs = SwitchedLegs.of(tripod_reference(tripod_angles(np.radians(50.0), 1.2), 2.0))
    robot = Robot()
    weight = robot.mass * 9.81
    traction = slip_traction(Slip(thesis_curve(), "thesis"), weight=weight)
    path = walk_thesis(
        robot, legs, duration=2.0, traction=traction, options=ThesisOptions(dt=0.001)
    )
    assert np.all((path.normal_force > 0).sum(axis=1) <= 3)
    assert np.median(path.normal_force.sum(axis=1)) == pytest.approx(weight, rel=0.1)
    assert path.length > 0.05
