# SPDX-License-Identifier: MIT
"""Both ways lead to goals ahead, to the side, behind, near and far, and to headings there."""

import numpy as np
import pytest

from model.errors import DomainError
from model.robot import GRAVITY, Robot
from model.routes.arcs import Arc
from model.routes.goal import Goal
from model.routes.manoeuvre import Stepping, Surroundings
from model.routes.reach import curve, measured_stride, stop_turn_walk
from model.walk.dynamics import DynamicsOptions
from model.walk.traction import VelocityCoulomb

ROBOT = Robot()
TABLE = VelocityCoulomb(0.38).table(weight=ROBOT.mass * GRAVITY)
AROUND = Surroundings(ROBOT, TABLE, DynamicsOptions(dt=0.005))
STEPPING = Stepping(ground_time=0.5, flight_time=0.5)
STRIDE = measured_stride(STEPPING, AROUND)
PLACES = [(0.5, 0.0), (0.0, 0.4), (-0.4, 0.0), (0.1, 0.05), (1.5, -0.5)]
POSES = [(0.5, 0.3, 90.0), (-0.3, 0.2, -45.0)]


def near(found, goal):
    return np.linalg.norm(goal.missed(found.end)) < 0.001


@pytest.mark.parametrize("place", PLACES, ids=str)
@pytest.mark.parametrize("plan", [stop_turn_walk, curve])
def test_a_place_is_met_within_a_millimetre(plan, place):
    goal = Goal(*place)
    assert near(plan(goal, STRIDE, STEPPING, AROUND), goal)


@pytest.mark.parametrize("pose", POSES, ids=str)
@pytest.mark.parametrize("plan", [stop_turn_walk, curve])
def test_a_heading_is_met_too(plan, pose):
    goal = Goal(pose[0], pose[1], np.radians(pose[2]))
    assert near(plan(goal, STRIDE, STEPPING, AROUND), goal)


@pytest.mark.parametrize("plan", [stop_turn_walk, curve])
def test_to_the_mirrored_goal_the_robot_turns_to_the_other_side(plan):
    left, right = (plan(Goal(0.4, y), STRIDE, STEPPING, AROUND) for y in (0.2, -0.2))
    for one, other in zip(left.parts, right.parts, strict=True):
        assert one.strides == other.strides
        assert other.bend == pytest.approx(-one.bend, abs=0.003)
        assert other.share == pytest.approx(one.share, abs=0.01)


def test_a_curve_turns_on_the_spot_nowhere():
    for goal in (Goal(0.5, 0.0, np.pi), Goal(-0.4, 0.1)):
        found = curve(goal, STRIDE, STEPPING, AROUND)
        assert max(abs(part.bend) for part in found.parts) <= 0.55


def test_no_stride_is_wasted():
    found = stop_turn_walk(Goal(1.2, 0.0), STRIDE, STEPPING, AROUND)
    (part,) = found.parts
    assert part.share * part.strides > part.strides - 1


def test_where_the_robot_stands_it_turns_on_the_spot_or_walks_a_loop():
    goal = Goal(0.0, 0.0, 1.0)
    turning, curving = (plan(goal, STRIDE, STEPPING, AROUND) for plan in (stop_turn_walk, curve))
    assert [part.bend for part in turning.parts] == [1.0]
    assert turning.end[2] == pytest.approx(1.0, abs=0.02)
    assert near(curving, goal)


@pytest.mark.parametrize("plan", [stop_turn_walk, curve])
def test_there_is_no_way_to_where_the_robot_is(plan):
    assert plan(Goal(0.0001, 0.0), STRIDE, STEPPING, AROUND) is None


@pytest.mark.parametrize("arc", [Arc(1.0, 0.0), Arc(0.0, -1.0), Arc(1.0, 2.0)])
def test_strides_add_up_to_the_length_and_the_turn(arc):
    part = STRIDE.part(arc)
    steps = part.share * part.strides * STRIDE.length
    assert steps * (1 - abs(part.bend)) == pytest.approx(arc.length)
    assert steps * part.bend / STRIDE.arm == pytest.approx(arc.turn)


def test_a_gait_that_leads_nowhere_is_refused():
    still = Surroundings(ROBOT, VelocityCoulomb(1e-9).table(weight=1.0), DynamicsOptions())
    with pytest.raises(DomainError, match="leads"):
        measured_stride(STEPPING, still)
