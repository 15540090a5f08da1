# SPDX-License-Identifier: MIT
from dataclasses import replace

import numpy as np
import pytest

from model.errors import DomainError, WalkError
from model.gait.steering import tripod_angles, tripod_reference
from model.gait.tetrapod import tetrapod_reference
from model.robot import Robot
from model.thesis import detected
from model.thesis.detected import walk_detected
from model.thesis.detection import detect_contacts
from model.walk.no_slip import walk_no_slip

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
