# SPDX-License-Identifier: MIT
"""A program is summarised segment by segment."""

import io
from dataclasses import replace

import numpy as np
import pytest
from rich.console import Console

from model.walk.path import WalkPath
from zebro_lab.walk.asked import WalkedSegment
from zebro_lab.walk.program_summary import segment_summaries, segment_table

SEGMENTS = (
    WalkedSegment("tripod, straight", 3, 6.0), WalkedSegment("stand", 0, 7.0),
    WalkedSegment("tripod, steering 0.4 left", 4, 15.0),
)  # fmt: skip


def path():
    """Return 0.6 m ahead in 6 s, a second of standing, then 0.8 m on a circle of radius 1 m."""
    t = np.linspace(0.0, 15.0, 1501)
    walked = 0.1 * (np.minimum(t, 6.0) + np.maximum(t - 7.0, 0.0))
    turned = np.maximum(walked - 0.6, 0.0)
    xy = np.column_stack([np.minimum(walked, 0.6) + np.sin(turned), 1 - np.cos(turned)])
    zero, legs = np.zeros_like(t), np.zeros((len(t), 6))
    return WalkPath(
        t, np.column_stack([xy, zero]), np.column_stack([zero, zero, turned]), legs, legs == 0,
        np.zeros((len(t), 6, 2)), legs, legs + 1, np.zeros((len(t), 6, 2)),
    )  # fmt: skip


def test_length_turn_speed_and_radius_are_those_of_each_segment():
    straight, stand, curve = segment_summaries(path(), SEGMENTS)
    assert (straight.length, straight.turn, straight.speed) == pytest.approx((0.6, 0.0, 0.1))
    assert abs(straight.radius) > 1e9
    assert (stand.length, stand.turn) == pytest.approx((0.0, 0.0))
    assert np.isnan(stand.speed)
    assert (curve.length, curve.turn) == pytest.approx((0.8, 0.8), rel=1e-4)
    assert (curve.speed, curve.radius) == pytest.approx((0.1, 1.0), rel=1e-4)
    assert curve.pose == pytest.approx((0.6 + np.sin(0.8), 1 - np.cos(0.8), 0.8), rel=1e-4)


def test_the_table_says_where_a_segment_is_straight_and_where_it_stands():
    table = segment_table(segment_summaries(path(), SEGMENTS))
    radius = [*table.columns[-1].cells]
    assert radius == ["straight", "-", "1.000"]


def test_the_table_is_whole_in_80_columns():
    long = WalkedSegment(
        "{1,4} < {2,5} < {3,6}, steering -0.123456, turn time 0.1 s right", 12, 15.0
    )
    summaries = segment_summaries(path(), (*SEGMENTS[:2], long))
    console = Console(file=io.StringIO(), width=80)
    far = replace(summaries[2], pose=(-12.345, -10.678, np.radians(-170.0)), length=12.345)
    console.print(segment_table((*summaries[:2], far)))
    printed = console.file.getvalue()
    assert "…" not in printed
    assert all(text in printed for text in ("-12.345", "-10.678", "-170.0", "12.345", "straight"))
    assert "12 cycles" in printed
