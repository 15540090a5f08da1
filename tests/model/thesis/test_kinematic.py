# SPDX-License-Identifier: MIT
"""Quantities that kinematics alone gives are those of the dynamics' walk."""

from dataclasses import fields
from functools import cache

import numpy as np

from model.frames import thesis_attitude
from model.gait.steering import tripod_angles, tripod_reference
from model.robot import Robot
from model.thesis import SwitchedLegs, walk_thesis
from model.thesis.kinematic import kinematic_path, thesis_angles
from model.walk.path import WalkPath

ROBOT = Robot()
GAIT = tripod_reference(tripod_angles(np.radians(45.0), 1.2), 1.0)


@cache
def both():
    """Return a walk by the dynamics, and the quantities found again from its path alone."""
    path = walk_thesis(ROBOT, SwitchedLegs.of(GAIT), duration=1.5)
    bare = WalkPath(**{each.name: getattr(path, each.name) for each in fields(WalkPath)})
    return path, kinematic_path(ROBOT, bare)


def test_angles_phi_and_hip_heights_are_found_again():
    path, found = both()
    for name in ("angles", "phi", "hip_height"):
        np.testing.assert_allclose(getattr(found, name), getattr(path, name), atol=1e-9)
    R = thesis_attitude(*found.angles.T)
    np.testing.assert_allclose(thesis_angles(found.orientation), found.angles)
    assert R.shape == (len(path.t), 3, 3)


def test_speeds_are_those_of_the_dynamics_but_where_contacts_change():
    path, found = both()
    for name in ("leg_speed", "contact_speed", "hip_speed"):
        ours, theirs = getattr(found, name), getattr(path, name)
        np.testing.assert_array_equal(np.isnan(ours), ~path.contact)
        apart = np.abs(ours - theirs)[path.contact]
        assert np.median(apart) < 2e-3  # m/s, of some 0.2
        assert np.median(theirs[path.contact]) > 0.1


def test_what_needs_forces_is_not_known():
    path, found = both()
    assert found.is_kinematic
    assert not path.is_kinematic
    np.testing.assert_array_equal(np.isnan(found.static_load), path.contact)
