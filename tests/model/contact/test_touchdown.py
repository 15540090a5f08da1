# SPDX-License-Identifier: MIT
import numpy as np
import pytest

from model.contact.touchdown import touchdowns
from model.gait.steering import tripod_angles, tripod_reference

GAIT = tripod_reference(tripod_angles(np.radians(50.0), 1.2), 2.0)
T = np.arange(1001, dtype=float) * 0.01
THETA = GAIT.angles(T)
TURN = 2 * np.pi


def by_angle(down_deg, up_deg):
    """Return contacts of legs that stand between two angles."""
    angle = np.degrees(THETA) % 360
    return (angle >= down_deg) & (angle < up_deg)


def of_leg(leg, contact, **options):
    return [each for each in touchdowns(T, THETA, contact, **options) if each.leg == leg]


def test_touchdown_and_lift_off_are_the_first_samples_on_and_off_the_ground():
    contact = by_angle(60.0, 110.0)
    for leg in range(6):
        rows = of_leg(leg, contact)
        down = np.flatnonzero(~contact[:-1, leg] & contact[1:, leg]) + 1
        up = np.flatnonzero(contact[:-1, leg] & ~contact[1:, leg]) + 1
        assert [row.t for row in rows] == T[down].tolist()
        np.testing.assert_allclose([row.angle for row in rows], THETA[down, leg] % TURN)
        off = [row.liftoff_t for row in rows if not np.isnan(row.liftoff_t)]
        assert off == T[up[up > down[0]]].tolist()
        assert {row.contacts for row in rows} == {1}


def test_a_leg_that_touches_where_asked_is_late_by_less_than_a_sample():
    angle = THETA % TURN
    contact = (angle >= GAIT.touchdown - 1e-9) & (angle < GAIT.liftoff)
    rows = touchdowns(T, THETA, contact, asked=GAIT.touchdowns((0.0, 10.0)))
    assert len(rows) == 6 * 5  # legs 1, 4 and 5 stand at the first sample
    for row in rows:
        assert 0 <= row.late < 0.01 + 1e-9
        assert row.asked_angle == pytest.approx(GAIT.touchdown[row.leg])


def test_legs_that_stand_in_a_hole_touch_later_than_asked_by_the_angle_they_turn():
    rows = touchdowns(T, THETA, by_angle(70.0, 110.0), asked=GAIT.touchdowns((0.0, 10.0)))
    for row in rows:
        expected = (np.radians(70.0) - GAIT.touchdown[row.leg]) / GAIT.ground_speed[row.leg]
        assert row.late == pytest.approx(expected, abs=0.011)


def test_a_turn_without_contact_is_missed_and_one_that_is_not_over_is_left_out():
    contact = by_angle(60.0, 110.0)
    contact[:, 0] = False
    rows = of_leg(0, contact, asked=GAIT.touchdowns((0.0, 10.0)))
    assert [row.contacts for row in rows] == [0, 0, 0, 0]  # asked for at 2, 4, 6 and 8 s
    assert all(np.isnan(row.t) and np.isnan(row.liftoff_angle) for row in rows)
    assert of_leg(0, contact) == []


def shown(row):
    return row.t, row.angle, str(row.liftoff_t), row.contacts


def test_short_gaps_do_not_end_a_contact_and_short_contacts_do_not_count():
    contact = by_angle(60.0, 110.0)
    whole = [shown(row) for row in of_leg(1, contact)]
    inside = int(np.searchsorted(T, whole[0][0])) + 3
    contact[inside, 1] = False
    contact[inside - 20, 1] = True
    assert of_leg(1, contact)[0].contacts == 3
    assert [shown(row) for row in of_leg(1, contact, least=0.02)] == whole


def test_legs_that_turn_back_have_their_touchdowns_in_their_turns():
    contact = by_angle(60.0, 110.0)
    rows = touchdowns(T, THETA[::-1], contact[::-1])
    assert all(np.radians(105.0) < row.angle < np.radians(110.0) for row in rows)
    turns = [row.turn for row in rows if row.leg == 2]
    assert turns == sorted(set(turns))


def test_legs_that_swing_to_and_fro_touch_down_in_one_turn_each_time():
    theta = np.tile(np.radians(90.0 + 60.0 * np.sin(0.5 * np.pi * T))[:, None], (1, 6))
    contact = np.abs(theta - np.radians(90.0)) < np.radians(20.0)  # for 0.2 s about 0, 2, 4, ... s
    times = np.array([1.78, 3.78, 5.78, 7.78, 9.78])
    angles = np.radians([110.0, 70.0, 110.0, 70.0, 110.0])
    rows = [row for row in touchdowns(T, theta, contact, asked=[(times, angles)] * 6)
            if row.leg == 3]  # fmt: skip
    assert [row.asked_t for row in rows] == times.tolist()
    assert {(row.turn, row.contacts) for row in rows} == {(0, 1)}
    assert max(abs(row.late) for row in rows) < 0.02
    assert max(abs(row.angle - row.asked_angle) for row in rows) < 0.03
