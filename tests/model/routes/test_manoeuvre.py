# SPDX-License-Identifier: MIT
"""Manoeuvres end where the walk of their program ends, and are fitted to end at a goal."""

import numpy as np
import pytest

from model.gait.notation import TETRAPOD
from model.robot import GRAVITY, Robot
from model.routes.goal import Goal
from model.routes.manoeuvre import SOLVED, Part, Stepping, Surroundings, fitted, walked_end
from model.routes.program import Segment, Until, lay_out
from model.walk.dynamics import DynamicsOptions, walk
from model.walk.traction import VelocityCoulomb

ROBOT = Robot()
TABLE = VelocityCoulomb(0.38).table(weight=ROBOT.mass * GRAVITY)
AROUND = Surroundings(ROBOT, TABLE, DynamicsOptions(dt=0.005))
TRIPOD_STEPS = Stepping()
TETRAPOD_STEPS = Stepping(TETRAPOD, ground_time=2.0, flight_time=1.0)


def test_the_end_is_that_of_the_program_with_the_same_segments():
    parts = (Part(-1.0, 0.6, 1), Part(0.2, 0.9, 2))
    segments = [Segment(TRIPOD_STEPS.cycle(part), Until(strides=part.strides)) for part in parts]
    legs, _ = lay_out(segments, ROBOT, TABLE, options=AROUND.options)
    path = walk(ROBOT, legs.reference(), TABLE, duration=legs.end, options=AROUND.options)
    np.testing.assert_allclose(
        walked_end(parts, TRIPOD_STEPS, AROUND), [*path.position[-1, :2], path.yaw[-1]], atol=1e-9
    )


def test_bend_is_the_side_and_half_of_what_steering_lacks_to_one():
    assert (Part(0.0, 1.0, 1).steering, Part(1.0, 1.0, 1).steering) == (1.0, -1.0)
    assert (Part(-0.25, 1.0, 1).steering, Part(-0.25, 1.0, 1).direction) == (0.5, "right")


@pytest.mark.parametrize("stepping", [TRIPOD_STEPS, TETRAPOD_STEPS], ids=["tripod", "tetrapod"])
def test_an_arc_is_fitted_to_a_place(stepping):
    start = (Part(0.1, 0.9, 4),)
    goal = Goal(0.36, 0.06)
    found = fitted(start, [(0, "share"), (0, "bend")], goal, stepping, AROUND)
    assert found.missed <= SOLVED
    assert np.hypot(found.end[0] - 0.36, found.end[1] - 0.06) <= SOLVED
    assert found.parts != start


def test_a_goal_out_of_reach_is_come_near_with_the_whole_stance():
    found = fitted((Part(0.0, 0.5, 2),), [(0, "share")], Goal(1.0, 0.0), TRIPOD_STEPS, AROUND)
    assert found.parts[0].share == pytest.approx(1.0)
    assert found.missed == pytest.approx(1.0 - found.end[0], abs=0.01)


def test_a_share_of_a_stance_between_given_angles_keeps_both_given():
    given = Stepping(touchdown=np.radians(50), liftoff=np.radians(130))
    down, up = given.stance(1.0)
    assert np.degrees([down, up]) == pytest.approx([50.0, 130.0])
    down, up = given.stance(0.5)
    assert np.degrees(up - down) == pytest.approx(40.0)
    assert Stepping().stance(0.5)[1] is None
