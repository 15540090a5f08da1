# SPDX-License-Identifier: MIT
from dataclasses import fields, replace
from functools import cache

import numpy as np
import pytest

from model.errors import DomainError, WalkError
from model.frames import thesis_attitude
from model.gait.steering import tripod_angles, tripod_reference
from model.gait.tetrapod import tetrapod_reference
from model.robot import Robot
from model.thesis import detected
from model.thesis.detected import kinematic_path, thesis_angles, walk_detected
from model.thesis.detection import detect_contacts
from model.thesis.legs import SwitchedLegs
from model.thesis.walk import walk_thesis
from model.walk.no_slip import walk_no_slip
from model.walk.path import WalkPath

ROBOT = Robot()
TETRAPOD = tetrapod_reference(np.radians(45.0), np.radians(135.0), cycle_time=3.0)


@pytest.mark.parametrize("steering", [1.0, 1.3])
def test_a_matched_tripod_walks_as_without_slip(steering):
    gait = tripod_reference(tripod_angles(np.radians(50.0), steering), 2.0)
    ours, theirs = (
        walk(ROBOT, gait, duration=4.0, dt=0.002) for walk in (walk_detected, walk_no_slip)
    )
    np.testing.assert_allclose(ours.position[-1, :2], theirs.position[-1, :2], atol=5e-4)
    assert ours.yaw[-1] == pytest.approx(theirs.yaw[-1], abs=2e-3)


def test_the_tetrapod_rocks_as_in_the_thesis_and_shorter_steps_change_little():
    path = walk_detected(ROBOT, TETRAPOD, duration=3.0)
    roll, pitch = np.degrees(path.orientation[450:, :2]).T
    assert (roll.min(), roll.max()) == pytest.approx((-2.9, 5.9), abs=0.06)
    assert (pitch.min(), pitch.max()) == pytest.approx((-7.0, 7.4), abs=0.06)
    coarse = walk_detected(ROBOT, TETRAPOD, duration=3.0, dt=0.002)
    np.testing.assert_allclose(coarse.position[-1], path.position[-1], atol=2e-3)


def test_no_time_is_refused():
    with pytest.raises(DomainError, match="duration is 0 s"):
        walk_detected(ROBOT, TETRAPOD, duration=0.0)


def test_where_no_contact_state_fits_the_time_is_said(monkeypatch):
    def ends(robot, theta, **options):
        found = detect_contacts(robot, theta[:100], **options)
        return replace(found, ended="no legs fit")

    monkeypatch.setattr(detected, "detect_contacts", ends)
    with pytest.raises(WalkError, match=r"at t = 0\.1 s contact detection ends: no legs fit"):
        walk_detected(ROBOT, TETRAPOD, duration=1.0, dt=0.002)


# --- kinematic quantities


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
