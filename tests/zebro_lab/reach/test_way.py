# SPDX-License-Identifier: MIT
"""Two ways are compared by time and work, and one that misses its goal is told of."""

from dataclasses import replace

import numpy as np
import pytest

from model.routes.goal import Goal
from model.routes.manoeuvre import Part
from support.ways import made_way as way
from zebro_lab.reach.way import CURVE, STOP_TURN_WALK, compared, missed, named


@pytest.mark.parametrize(
    ("turning", "curving", "said"),
    [
        ({"time": 12.0}, {"done": 1.0},
         "curve is faster by 2 s (17%), and needs less work by 1 J (50%)"),
        ({"time": 12.0, "done": 1.0}, {},
         "curve is faster by 2 s (17%), and stop-turn-walk needs less work by 1 J (50%)"),
        ({"done": 2.005}, {}, "both ways take as long, and both need the same work"),
    ],
)  # fmt: skip
def test_the_faster_and_the_cheaper_way_are_named(turning, curving, said):
    line = compared(way(STOP_TURN_WALK, **turning), way(CURVE, **curving))
    assert line == f"goal 1 (1, 0 m): {said}"


def test_a_goal_that_is_missed_is_told_of():
    assert missed(way(end=(1.004, 0.0, 0.0))) is None
    assert "ends 20 mm from the goal" in missed(way(end=(1.0, 0.02, 0.0)))
    turned = replace(way(end=(1.0, 0.0, 0.1)), goal=Goal(1.0, 0.0, 0.05))
    assert "2.9 deg from the goal" in missed(turned)


def test_whole_turns_do_not_count_as_an_error():
    found = way(end=(1.0, 0.0, 2 * np.pi + 0.01), goal=Goal(1.0, 0.0, 0.0))
    assert found.heading_error == pytest.approx(0.01)
    assert np.isnan(way().heading_error)


def test_parts_are_described_in_order():
    parts = (Part(-1.0, 0.5, 1), Part(0.0, 1.0, 3), Part(0.25, 1.0, 2))
    assert way(parts=parts).described == (
        "1 stride on the spot to the right, 3 strides straight, "
        "2 strides of steering 0.500 to the left"
    )
    assert way(parts=parts).strides == 6


def test_a_goal_is_named_with_its_heading():
    assert named(Goal(1.0, -0.5, np.radians(-30))) == "1, -0.5 m, -30 deg"
