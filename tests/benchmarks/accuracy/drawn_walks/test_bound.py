# SPDX-License-Identifier: MIT
"""The least standard deviation of a drawn walk's last pose is what its causes leave."""

from dataclasses import replace

import numpy as np
import pytest

from benchmarks.accuracy.drawn_walks.bound import Clicks, least_sd
from benchmarks.accuracy.drawn_walks.world import PLAIN, DrawnWalk, Spreads, draw_walk
from tracking.body import TopPlate

EXACT = Spreads(0, 0, 0, 0, 0, 0, 0, 0, 0, 0)


def drawn(spreads: Spreads) -> DrawnWalk:
    lens = replace(PLAIN, sd=(0.0,) * 9)
    return draw_walk(np.random.default_rng(3), lens=lens, distance=3.4, spreads=spreads)


def test_the_turn_of_the_marker_is_that_of_all_headings():
    assert least_sd(drawn(replace(EXACT, turn=0.01)))[2] == pytest.approx(0.01, rel=1e-2)


def test_a_mean_height_moves_the_path_along_the_line_of_sight():
    walk = drawn(replace(EXACT, height=5e-3, side=1.0))  # a side that nobody knows
    eye = walk.camera[1] - walk.bodies[-1, :3]
    shift = 5e-3 / (eye[2] - 0.0385) * np.linalg.norm(eye[:2])
    assert np.linalg.norm(least_sd(walk)[:2]) == pytest.approx(shift, rel=0.05)


def test_whoever_is_told_more_is_never_less_sure():
    usual = least_sd(drawn(Spreads()))
    for name in ("tape", "side", "turn", "height", "bounce", "tilt", "edges"):
        assert (least_sd(drawn(replace(Spreads(), **{name: 0.0}))) < usual * (1 + 1e-6)).all(), name


def test_clicks_leave_more_than_a_marker_and_those_in_one_photograph_more_than_in_two():
    walk, top = drawn(Spreads()), TopPlate(0.176, 0.176, 0.0385).corners_body[:, :2]
    photos = range(len(walk.t))
    one = Clicks(top, 0.5, 0.15, 4e-3, [(k, 0) for k in photos])
    two = Clicks(top, 0.5, 0.15, 4e-3, [(k, 0 if k < 7 else 14) for k in photos])
    assert least_sd(walk, one)[2] > least_sd(walk, two)[2]
    assert (least_sd(walk, two) > least_sd(walk)).all()
