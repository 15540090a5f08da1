# SPDX-License-Identifier: MIT
from itertools import pairwise
from typing import Any

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from model.contact.detection import DETECTIONS, detect_contacts
from model.contact.events import next_stance
from model.contact.stance import resting_stance
from model.errors import DomainError
from model.gait import parse_gait, scheduled_reference, turning_system
from model.gait.tetrapod import tetrapod_reference
from model.robot import Robot

ROBOT = Robot()
GAIT = tetrapod_reference(np.radians(45.0), np.radians(135.0), cycle_time=3.0)
CYCLE = [{2, 3, 6}, {1, 3, 4, 6}, {1, 4, 5}, {2, 4, 5}, {2, 5, 6}]  # Eq. (3-33)
GROUPS = ("{1,4} < {2,5} < {3,6}", "{1,6} < {2,5} < {3,4}", "{1,4,5} < {2,3,6}")


def angles(*, dt=0.004, duration=6.0, gait=GAIT):
    return gait.angles(np.arange(round(duration / dt)) * dt)


def states(found):
    rows = [set((np.flatnonzero(row) + 1).tolist()) for row in found.contact]
    return [rows[0], *(after for before, after in pairwise(rows) if after != before)]


def test_the_tetrapod_goes_through_the_thesis_contact_states():
    assert states(detect_contacts(ROBOT, angles())) == [{2, 5, 6}, *CYCLE, *CYCLE]


def test_with_the_centre_of_mass_tested_at_every_step_there_is_one_more_state():
    found = detect_contacts(ROBOT, angles(), detection="balanced")
    assert states(found) == [{2, 5, 6}, {2, 3, 5}, *CYCLE, {2, 3, 5}, *CYCLE]


@settings(max_examples=6)
@given(st.sampled_from(GROUPS), st.floats(40.0, 55.0), st.floats(115.0, 140.0),
       st.sampled_from(DETECTIONS))  # fmt: skip
def test_contacts_are_those_of_one_event_search_after_the_other(groups, down, up, detection):
    system = turning_system(
        parse_gait(groups), inner=(), ground_time=1.0, flight_time=0.5, turn_time=0.0
    )
    gait = scheduled_reference(system, np.radians(down), liftoff=np.radians(up))
    theta = angles(gait=gait, dt=0.01, duration=2.0)
    found = detect_contacts(ROBOT, theta, detection=detection)
    standing = resting_stance(ROBOT, theta[0]).standing
    for k in range(len(found)):
        stance = next_stance(
            ROBOT, theta[k], contact=tuple(np.flatnonzero(standing).tolist()),
            always_balanced=detection == "balanced",
        )  # fmt: skip
        standing = stance.standing
        np.testing.assert_array_equal(found.contact[k], standing)
        assert found.height[k] == pytest.approx(stance.height, abs=1e-12)
        assert (found.roll[k], found.pitch[k]) == pytest.approx((stance.roll, stance.pitch))


def test_pitch_and_roll_repeat_every_cycle_once_walking():
    found = detect_contacts(ROBOT, angles(duration=7.0))
    for angle in (found.roll, found.pitch):
        np.testing.assert_allclose(angle[875:1625], angle[125:875], atol=np.radians(0.3))


def test_late_detection_makes_the_angles_jump_in_proportion_to_the_step():
    coarse, fine = (detect_contacts(ROBOT, angles(dt=dt, duration=3.0)) for dt in (0.008, 0.002))
    jumps = [np.abs(np.diff(found.pitch)).max() for found in (coarse, fine)]
    assert 3 < jumps[0] / jumps[1] < 5


def test_a_robot_with_short_hips_wobbles_more():
    close = Robot(hips=Robot().hips * np.array([0.5, 1.0, 1.0]))
    short, long = (detect_contacts(robot, angles(duration=3.0)) for robot in (close, ROBOT))
    assert np.ptp(short.pitch) > 1.5 * np.ptp(long.pitch)


def test_where_no_contact_state_fits_the_detection_ends_and_says_why():
    found = detect_contacts(ROBOT, angles(duration=0.1), start=(0, 2, 4))
    assert len(found) == len(found.contact) == len(found.roll) == 0
    assert "legs 1, 3, 5 lie on one line" in found.ended


def test_an_unknown_detection_is_refused():
    unknown: Any = "force"
    with pytest.raises(DomainError, match="expected events or balanced"):
        detect_contacts(ROBOT, angles(duration=0.1), detection=unknown)


@pytest.mark.reference
def test_orientation_swings_as_far_as_the_independent_engines(shared):
    import pandas as pd

    engine = pd.read_csv(shared / "virtual-world/walks/tetrapod_mu0.20_tc3.csv.gz")
    found = detect_contacts(ROBOT, angles(duration=7.0), detection="balanced")
    late = engine["t"] > 3
    for ours, theirs in ((found.roll, engine["roll"]), (found.pitch, engine["pitch"])):
        swing = np.abs(theirs.to_numpy()[late.to_numpy()]).max()
        assert np.abs(ours[750:]).max() == pytest.approx(swing, abs=0.02)
