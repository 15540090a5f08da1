# SPDX-License-Identifier: MIT
"""A program that is walked cycle by cycle comes to where it does walked at once."""

import numpy as np
import pytest

from model.gait.notation import TRIPOD
from model.gait.program import ProgramLegs, cycle_gait
from model.leg_state import LegState, corrected
from model.path_draws import bent_walk
from model.robot import GRAVITY, Robot
from model.routes.growing_walk import GrowingWalk
from model.walk.bend import STRAIGHT
from model.walk.dynamics import DynamicsOptions, walk
from model.walk.traction import VelocityCoulomb

ROBOT = Robot()
TABLE = VelocityCoulomb(0.38).table(weight=ROBOT.mass * GRAVITY)
OPTIONS = DynamicsOptions()
CURVE = cycle_gait(TRIPOD, ground_time=0.5, flight_time=0.5, steering=0.5)
ONE = np.ones(1)
FITTED = LegState(
    np.full((1, 6), 0.03),
    0.8 * ONE,
    ONE,
    ONE,
    1.2 * ONE,
    0.9 * ONE,
    0.1 * ONE,
    0.3 * ONE,
    0.05 * ONE,
)


@pytest.mark.parametrize("corrections", [None, FITTED])
def test_poses_of_a_growing_program_are_those_of_its_walk(corrections):
    robot, law, bend = ROBOT, TABLE, STRAIGHT
    if corrections is not None:
        robot, law, bend = corrected(ROBOT, TABLE, corrections)
    growing = GrowingWalk(robot, law, OPTIONS, bend=bend)
    legs, found = ProgramLegs.beginning_with(CURVE), []
    for _ in range(4):
        legs = legs.with_cycle(CURVE)
        found.append(growing.pose(legs))
    path = bent_walk(walk(robot, legs.reference(), law, duration=legs.end, options=OPTIONS), bend)
    at = [round(t / OPTIONS.dt) for t in (1.0, 2.0, 3.0, 4.0)]
    expected = np.column_stack([path.position[at, :2], path.yaw[at]])
    np.testing.assert_allclose(found, expected, atol=2e-3)


def test_a_step_back_is_walked_again_from_where_it_was():
    growing = GrowingWalk(ROBOT, TABLE, OPTIONS)
    legs = ProgramLegs.beginning_with(CURVE).with_cycle(CURVE)
    growing.pose(legs)
    kept = growing.reached
    first = growing.pose(legs.with_cycle(CURVE))
    growing.reached = kept
    assert growing.pose(legs.with_cycle(CURVE)) == first
