# SPDX-License-Identifier: MIT
"""The table of ways is whole in 80 columns; warnings come before what compares the ways."""

import io

import numpy as np
from rich.console import Console

from model.routes.goal import Goal
from model.routes.reach import Stride
from support.ways import made_way
from zebro_lab.reach.screen import lines, reach_document, way_table
from zebro_lab.reach.stage import ReachResult
from zebro_lab.reach.way import CURVE, STOP_TURN_WALK

FAR = Goal(-12.25, 10.75, float(np.radians(-135.0)))
NEAR = Goal(1.0, 0.0)
WAYS = (
    made_way(STOP_TURN_WALK, goal=NEAR),
    made_way(CURVE, goal=NEAR, end=(0.9, 0.0, 0.0)),
    made_way(STOP_TURN_WALK, number=2, goal=FAR, time=123.45, done=45.67),
    made_way(CURVE, number=2, goal=FAR, end=(-12.25, 10.75, -2.3)),
)
REACHED = ReachResult((NEAR, FAR), WAYS, Stride(0.16, 0.13), "tripod", ("a note",))


def test_the_table_is_whole_in_80_columns():
    console = Console(file=io.StringIO(), width=80)
    console.print(way_table(WAYS))
    printed = console.file.getvalue()
    assert "…" not in printed
    assert all(text in printed for text in ("123.45", "45.67", "stop-turn-walk", "3.22", "-135"))
    assert printed.count("1: 1, 0") == 1


def test_warnings_come_first_then_a_sentence_a_goal_then_notes():
    found = lines(REACHED)
    assert [line[:16] for line in found[:3]] == ["WARNING: goal 1:"] + ["WARNING: goal 2:"] * 2
    assert [line[:6] for line in found[3:5]] == ["goal 1", "goal 2"]
    assert found[5:] == ["a note"]


def test_the_document_has_two_ways_to_each_goal():
    found = reach_document(REACHED)
    assert [len(goal["ways"]) for goal in found["goals"]] == [2, 2]
    assert found["goals"][1]["ways"][0]["time_s"] == 123.45
