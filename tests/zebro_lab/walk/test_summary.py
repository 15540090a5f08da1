# SPDX-License-Identifier: MIT
"""The summary of a walk gives back the circle it was made on."""

import io
from dataclasses import replace

import numpy as np
import pytest
from hypothesis import assume, given
from hypothesis import strategies as st
from rich.console import Console

from model.walk.path import WalkPath
from zebro_lab.walk.screen import summary_lines
from zebro_lab.walk.summary import segment_summaries, segment_table, stride_poses, summarise
from zebro_lab.walk.walking import WalkedSegment


def walk_on_circle(radius: float, speed: float, duration: float, wiggle: float) -> WalkPath:
    """Return a walk of 2 s strides on a circle, wiggling within each stride."""
    t = np.linspace(0.0, duration, round(200 * duration) + 1)
    yaw = speed / radius * t
    wobble = wiggle * np.sin(np.pi * t)
    x = (radius + wobble) * np.sin(yaw)
    y = radius - (radius + wobble) * np.cos(yaw)
    legs = np.zeros((len(t), 6))
    return WalkPath(
        t=t,
        position=np.column_stack([x, y, np.full_like(t, 0.06)]),
        orientation=np.column_stack([0.02 * np.sin(t), 0 * t, yaw]),
        theta=np.pi * t[:, None] + 0.2 * np.sin(np.pi * t)[:, None] + np.arange(6),
        contact=legs == 0,
        slip_velocity=np.full((len(t), 6, 2), np.nan),
        slip_ratio=np.full_like(legs, np.nan),
        normal_force=legs,
        traction_force=np.zeros((len(t), 6, 2)),
    )


@given(
    radius=st.floats(0.5, 10) | st.floats(-10, -0.5),
    speed=st.floats(0.02, 0.3),
    duration=st.floats(5, 40),
    wiggle=st.floats(0, 0.01),
)
def test_radius_speed_and_yaw_rate_of_a_circle_are_found(radius, speed, duration, wiggle):
    assume(abs(duration / 2 - round(duration / 2)) > 0.01)  # else rounding says which stride ended
    summary = summarise(walk_on_circle(radius, speed, duration, wiggle))
    assert summary.radius == pytest.approx(radius, rel=1e-3)
    assert summary.speed == pytest.approx(speed, rel=1e-3)
    assert summary.yaw_rate == pytest.approx(speed / radius, rel=1e-3)
    assert summary.strides == int(duration / 2) - 1
    assert not summary.straight
    assert np.isnan(summary.mean_slip)


def test_straight_walk_has_no_radius():
    path = walk_on_circle(1e12, 0.1, 10.0, 0.0)
    summary = summarise(replace(path, orientation=0 * path.orientation))
    assert summary.straight
    assert summary.radius == np.inf
    assert summary.speed == pytest.approx(0.1)
    assert summary.length == pytest.approx(1.0)


def test_walk_shorter_than_a_stride_is_summed_up_as_a_whole():
    path = walk_on_circle(1.0, 0.1, 1.0, 0.0)
    poses, strides = stride_poses(path)
    assert strides == 0
    np.testing.assert_array_equal(poses[:, 0], [0.0, 1.0])
    assert summarise(path).radius == pytest.approx(1.0, rel=1e-4)


def test_slip_is_that_of_legs_in_contact(walked):
    slip = np.where(walked.contact[..., None], 0.03, 99.0) * np.array([0.6, 0.8])
    assert summarise(replace(walked, slip_velocity=slip)).mean_slip == pytest.approx(0.03)


def test_standing_robot_has_a_summary(walked):
    still = replace(walked.part(np.zeros(10, dtype=int)), t=np.arange(10) * 0.1)
    summary = summarise(still)
    assert (summary.speed, summary.yaw_rate, summary.strides) == (0.0, 0.0, 0)


def test_a_walk_on_an_s_curve_has_no_radius_and_is_not_called_straight(walked):
    path = walk_on_circle(1.0, 0.1, 24.0, 0.0)
    half = len(path.t) // 2
    yaw = np.concatenate([path.yaw[:half], 2 * path.yaw[half] - path.yaw[half:]])
    steps = np.diff(path.t, prepend=0.0)[:, None] * 0.1
    position = np.cumsum(steps * np.column_stack([np.cos(yaw), np.sin(yaw), 0 * yaw]), axis=0)
    orientation = np.column_stack([0 * yaw, 0 * yaw, yaw])
    summary = summarise(replace(path, position=position, orientation=orientation))
    assert np.isnan(summary.radius)
    assert not summary.straight
    assert "on no circle, so without a radius" in summary_lines(summary)[1]


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
