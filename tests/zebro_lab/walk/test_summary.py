# SPDX-License-Identifier: MIT
"""The summary of a walk gives back the circle it was made on."""

from dataclasses import replace

import numpy as np
import pytest
from hypothesis import assume, given
from hypothesis import strategies as st

from model.walk.path import WalkPath
from zebro_lab.walk.screen import summary_lines
from zebro_lab.walk.summary import stride_poses, summarise


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
