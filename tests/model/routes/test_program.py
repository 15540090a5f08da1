# SPDX-License-Identifier: MIT
"""Segments of a program end where a walk of the whole program is at their ends."""

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from model.errors import DomainError
from model.gait.notation import TETRAPOD, TRIPOD
from model.gait.program import cycle_gait
from model.robot import GRAVITY, Robot
from model.routes.program import Segment, Until, lay_out
from model.walk.dynamics import DynamicsOptions, walk
from model.walk.path import turning_radius
from model.walk.traction import VelocityCoulomb

ROBOT = Robot()
TABLE = VelocityCoulomb(0.38).table(weight=ROBOT.mass * GRAVITY)
OPTIONS = DynamicsOptions()
STRAIGHT = cycle_gait(TRIPOD, ground_time=1.0, flight_time=1.0)
SPOT = cycle_gait(TRIPOD, ground_time=1.0, flight_time=1.0, steering=-1.0)
CURVE = cycle_gait(TETRAPOD, ground_time=2.0, flight_time=1.0, steering=0.4, direction="right")


def laid_out(*segments):
    return lay_out(segments, ROBOT, TABLE, options=OPTIONS)


def test_headings_and_places_are_met_in_a_walk_of_the_whole_program():
    near = (0.25, 0.0, 0.12)
    legs, ends = laid_out(
        Segment(STRAIGHT, Until(strides=3)),
        Segment(SPOT, Until(heading=np.radians(180))),
        Segment(stand=0.5),
        Segment(STRAIGHT, Until(near=near)),
        Segment(CURVE, Until(heading=np.radians(75))),
        Segment(STRAIGHT, Until(time=3.0)),
    )
    path = walk(ROBOT, legs.reference(), TABLE, duration=legs.end, options=OPTIONS)
    x, y, yaw = (
        np.interp([end.end for end in ends], path.t, column)
        for column in (path.position[:, 0], path.position[:, 1], path.yaw)
    )
    assert [end.cycles for end in ends[:3]] == [3, ends[1].cycles, 0]
    assert np.degrees(yaw[1] - yaw[0]) == pytest.approx(180, abs=0.5)
    assert np.hypot(x[3] - near[0], y[3] - near[1]) <= near[2] + 1e-3
    assert np.degrees(yaw[4] - yaw[3]) == pytest.approx(-75, abs=0.5)
    assert ends[5].end - ends[4].end == pytest.approx(3.0)  # legs that came down stand for 1 s
    assert ends[-1].end == pytest.approx(legs.end)


@settings(max_examples=10)
@given(
    heading=st.floats(5, 200), groups=st.sampled_from([TRIPOD, TETRAPOD]),
    steering=st.sampled_from([-1.0, -0.6, 0.0, 0.5, 0.8]), side=st.sampled_from(["left", "right"]),
    straight_before=st.booleans(),
)  # fmt: skip
def test_every_heading_is_met(heading, groups, steering, side, straight_before):
    flight = 2.0 / len(groups.groups)
    turn = cycle_gait(
        groups, ground_time=2.0 - flight, flight_time=flight, steering=steering, direction=side
    )
    before = [Segment(STRAIGHT, Until(strides=2))] if straight_before else []
    segments = [*before, Segment(turn, Until(heading=np.radians(heading)))]
    legs, ends = lay_out(segments, ROBOT, TABLE, options=DynamicsOptions(dt=0.004))
    assert abs(np.degrees(ends[-1].missed)) < 1.0
    path = walk(ROBOT, legs.reference(), TABLE, duration=legs.end, options=DynamicsOptions(0.004))
    began = ends[0].end if straight_before else 0.0
    turned = np.degrees(path.yaw[-1] - np.interp(began, path.t, path.yaw))
    assert turned == pytest.approx(heading if side == "left" else -heading, abs=1.2)


@pytest.mark.parametrize("steering", [0.3, 0.6, 0.75, 0.95])
def test_the_circle_widens_with_steering_as_without_slip_and_somewhat_more(steering):
    gait = cycle_gait(TRIPOD, ground_time=1.0, flight_time=1.0, steering=steering)
    legs, _ = laid_out(Segment(gait, Until(strides=3)))
    path = walk(ROBOT, legs.reference(), TABLE, duration=legs.end, options=OPTIONS)
    strides = [round(t / OPTIONS.dt) for t in (2.0, 6.0)]
    radius = turning_radius(path.position[strides, :2], path.yaw[strides])
    without_slip = float(ROBOT.hips[0, 1]) * (1 + steering) / (1 - steering)
    assert without_slip < radius < 1.4 * without_slip


@pytest.mark.parametrize("heading", [45, 120])
def test_only_the_first_stride_after_a_turn_on_the_spot_turns_once_more(heading):
    legs, ends = laid_out(
        Segment(STRAIGHT, Until(strides=2)), Segment(SPOT, Until(heading=np.radians(heading))),
        Segment(STRAIGHT, Until(strides=3)),
    )  # fmt: skip
    path = walk(ROBOT, legs.reference(), TABLE, duration=legs.end, options=OPTIONS)
    between = np.interp(ends[1].end + 2.0 * np.arange(4), path.t, path.yaw)
    first, *others = np.degrees(np.diff(between))
    assert 5 < first < 25
    assert np.abs(others).max() < 0.2


@pytest.mark.parametrize("reverse", [False, True])
def test_walked_backwards_a_circle_is_the_same_and_the_heading_turns_to_the_other_side(reverse):
    gait = cycle_gait(TRIPOD, ground_time=1.0, flight_time=1.0, steering=0.5, reverse=reverse)
    legs, _ = laid_out(Segment(gait, Until(strides=3)))
    path = walk(ROBOT, legs.reference(), TABLE, duration=legs.end, options=OPTIONS)
    assert path.position[-1, 1] > 0  # the centre is on the left
    assert np.sign(path.yaw[-1]) == (-1 if reverse else 1)


def test_a_program_that_is_too_long_ends_as_soon_as_it_is():
    seen = []
    with pytest.raises(
        DomainError, match=r"segment 2: the program would last 8 s or more; at most"
    ):
        lay_out(
            [Segment(STRAIGHT, Until(strides=3)), Segment(STRAIGHT, Until(strides=900))], ROBOT,
            None, options=OPTIONS, longest=7.0, progress=seen.append,
        )  # fmt: skip
    np.testing.assert_allclose(seen, np.arange(1, 4) / 6)


def test_progress_is_told_after_every_cycle_and_may_stop_a_segment():
    seen = []

    def stop(share):
        seen.append(share)
        if share > 0.3:
            raise InterruptedError

    with pytest.raises(InterruptedError):
        lay_out([Segment(STRAIGHT, Until(strides=20))], ROBOT, None, options=OPTIONS, progress=stop)
    assert len(seen) == 7


def test_a_place_that_the_robot_does_not_come_to_ends_in_a_message(monkeypatch):
    monkeypatch.setattr("model.routes.program.MOST_CYCLES", 3)
    with pytest.raises(DomainError, match=r"segment 2: after 3 cycles .* has not come to"):
        laid_out(Segment(stand=1.0), Segment(STRAIGHT, Until(near=(-2.0, 0.0, 0.1))))
    with pytest.raises(DomainError, match=r"has not turned by 90 degrees; it has by 0"):
        laid_out(Segment(STRAIGHT, Until(heading=np.pi / 2)))
    with pytest.raises(DomainError, match="after 3 cycles 6 s of 9 s are over"):
        laid_out(Segment(STRAIGHT, Until(time=9.0)))


def test_a_program_needs_a_gait_and_a_slip_law_where_it_must_be_walked():
    with pytest.raises(DomainError, match="no segment of the program has a gait"):
        laid_out(Segment(stand=1.0))
    with pytest.raises(DomainError, match="only a model with slip"):
        lay_out([Segment(SPOT, Until(heading=1.0))], ROBOT, None, options=OPTIONS)
    legs, _ = lay_out([Segment(SPOT, Until(strides=2))], ROBOT, None, options=OPTIONS)
    assert legs.end == pytest.approx(4.0)


@pytest.mark.parametrize(
    "given",
    [{}, {"strides": 2, "time": 1.0}, {"time": 0.0}, {"heading": -1.0}, {"heading": np.inf},
     {"near": (0.0, 0.0, 0.0)}, {"near": (np.nan, 0.0, 1.0)}],
)  # fmt: skip
def test_a_segment_has_one_end_above_zero(given):
    with pytest.raises(DomainError):
        Until(**given)
