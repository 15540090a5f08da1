# SPDX-License-Identifier: MIT
from itertools import pairwise

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from model.contact.stance import resting_stance
from model.gait import parse_gait, scheduled_reference, turning_system
from model.gait.tetrapod import tetrapod_reference
from model.robot import Robot
from model.thesis.detection import detect_contacts, next_stance

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


@settings(max_examples=6)
@given(st.sampled_from(GROUPS), st.floats(40.0, 55.0), st.floats(115.0, 140.0))
def test_contacts_are_those_of_one_event_search_after_the_other(groups, down, up):
    system = turning_system(
        parse_gait(groups), inner=(), ground_time=1.0, flight_time=0.5, turn_time=0.0
    )
    gait = scheduled_reference(system, np.radians(down), liftoff=np.radians(up))
    theta = angles(gait=gait, dt=0.01, duration=2.0)
    found = detect_contacts(ROBOT, theta)
    standing = resting_stance(ROBOT, theta[0]).standing
    for k in range(len(found)):
        stance = next_stance(ROBOT, theta[k], contact=tuple(np.flatnonzero(standing).tolist()))
        standing = stance.standing
        np.testing.assert_array_equal(found.contact[k], standing)
        assert found.height[k] == pytest.approx(stance.height, abs=1e-12)
        assert (found.roll[k], found.pitch[k]) == pytest.approx((stance.roll, stance.pitch))


def test_pitch_and_roll_repeat_every_cycle_once_walking():
    found = detect_contacts(ROBOT, angles(duration=7.0))
    for angle in (found.roll, found.pitch):
        np.testing.assert_allclose(angle[875:1625], angle[125:875], atol=np.radians(0.3))


def test_where_no_contact_state_fits_the_detection_ends_and_says_why():
    found = detect_contacts(ROBOT, angles(duration=0.1), start=(0, 2, 4))
    assert len(found) == len(found.contact) == len(found.roll) == 0
    assert "legs 1, 3, 5 lie on one line" in found.ended


@pytest.mark.reference
def test_orientation_swings_as_far_as_the_independent_engines(shared):
    import pandas as pd

    engine = pd.read_csv(shared / "virtual-world/walks/tetrapod_mu0.20_tc3.csv.gz")
    found = detect_contacts(ROBOT, angles(duration=7.0))
    late = engine["t"] > 3
    for ours, theirs in ((found.roll, engine["roll"]), (found.pitch, engine["pitch"])):
        swing = np.abs(theirs.to_numpy()[late.to_numpy()]).max()
        assert np.abs(ours[750:]).max() == pytest.approx(swing, abs=0.02)


# --- one step

THETA = st.lists(st.floats(0.8, 2.2), min_size=6, max_size=6).map(np.array)
TURN = st.lists(st.floats(0.0, 0.1), min_size=6, max_size=6).map(np.array)


def on_ground(stance):
    return tuple(int(i) for i in np.flatnonzero(stance.standing))


@given(THETA, TURN)
def test_no_leg_is_below_the_ground_after_a_step(theta, turn):
    contact = on_ground(resting_stance(ROBOT, theta))
    assert next_stance(ROBOT, theta + turn, contact=contact).clearance.min() > -1e-9


def test_a_leg_that_reaches_the_ground_replaces_one_that_stood():
    theta = np.radians([160.0, 90.0, 80.0, 120.0, 90.0, 120.0])
    contact = on_ground(resting_stance(ROBOT, theta))
    assert contact == (1, 2, 4)
    theta[0], theta[2] = np.radians(100.0), np.radians(130.0)
    assert on_ground(next_stance(ROBOT, theta, contact=contact)) == (0, 1, 4)


def test_three_feet_on_one_line_leave_the_stance_to_the_other_legs():
    hips = ROBOT.hips.copy()
    hips[2] = hips[:2].mean(axis=0) - [0.02, 0.0, 0.0]  # between legs 1 and 2, 0.02 m behind them
    robot = Robot(hips=hips)
    theta = np.full(6, np.radians(100.0))
    # The toe of leg 3 is 0.02 m further forward than those of legs 1 and 2: on their line.
    theta[2] = np.arccos(np.cos(theta[0]) + 0.02 / (2 * robot.leg_radius))
    assert next_stance(robot, theta, contact=tuple(range(6))).depth > 0
