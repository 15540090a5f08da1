# SPDX-License-Identifier: MIT
"""The body is drawn where and when it was there."""

from dataclasses import replace

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st
from matplotlib.figure import Figure

from model.robot import Robot
from model.walk.ground import FLAT, with_slope
from support.grounds import sample_ground
from zebro_lab.plots.walk_path import (
    draw_ground,
    mean_rate,
    motion,
    orientation,
    path_with_snapshots,
)

LOW, HIGH = np.array([-0.5, -0.2]), np.array([1.0, 0.3])


def drawn(ground):
    axes = Figure().add_subplot()
    axes.set(xlim=(-0.1, 0.2), ylim=(0.0, 0.1))
    draw_ground(axes, ground, LOW, HIGH)
    assert axes.get_xlim() == (-0.1, 0.2)
    assert axes.get_ylim() == (0.0, 0.1)
    return axes


def test_level_ground_is_not_drawn():
    axes = drawn(FLAT)
    assert not axes.images


def test_heights_are_shaded_in_millimetres_where_they_are():
    step = sample_ground(lambda x, y: 0.01 * (x > 0.5) + 0 * y, x=(-1, 2), y=(-1, 1))
    axes = drawn(with_slope(step, 0.1, 0.0))
    (shading,) = axes.images
    height = np.asarray(shading.get_array())
    left, right, bottom, top = shading.get_extent()
    assert (left, bottom) == pytest.approx(LOW, abs=0.01)
    assert (right, top) == pytest.approx(HIGH, abs=0.01)
    expected = 1000 * np.tan(0.1) * np.array([-0.5, 1.0]) + np.array([0.0, 10.0])
    np.testing.assert_allclose(height[3, [0, -1]], expected, atol=0.5)
    assert axes.figure.axes[1].get_ylabel() == "height of the ground [mm]"


def test_motion_is_drawn_with_means_of_its_derivatives(walked):
    panels = np.reshape(motion(walked, title="A walk").axes, (3, 3))
    inner = slice(10, -10)
    for column in range(3):
        position, speed, _ = (axes.lines[0].get_ydata() for axes in panels[:, column])
        np.testing.assert_array_equal(position, walked.position[:, column])
        smooth = np.gradient(position, walked.t)
        np.testing.assert_allclose(speed[inner], smooth[inner], atol=1e-4)
    for unit, axes in zip(("[m]", "[m/s]", "[m/s²]"), panels[:, 0], strict=True):
        assert unit in axes.get_ylabel()


def test_an_impact_of_one_sample_is_spread_over_the_window_and_nothing_is_cut_off(walked):
    position = walked.position.copy()
    position[200:, 2] += 0.001
    for axes in motion(replace(walked, position=position), title="").axes:
        (line,) = axes.lines
        low, high = axes.get_ylim()
        assert low <= line.get_ydata().min() <= line.get_ydata().max() <= high
    steps = mean_rate(walked.t, position)[:, 2] - mean_rate(walked.t, walked.position)[:, 2]
    np.testing.assert_allclose(steps.max(), 0.001 / 0.1)
    moved = np.flatnonzero(steps > 1e-9)
    assert walked.t[moved[-1]] - walked.t[moved[0]] <= 0.1 + 1e-9


@given(st.floats(-5, 5), st.floats(0.001, 0.3), st.integers(1, 60))
def test_the_mean_rate_of_a_line_is_its_slope_to_both_ends(slope, step, count):
    t = 3.0 + step * np.arange(count)
    expected = slope if count > 1 else 0.0
    np.testing.assert_allclose(mean_rate(t, slope * t[:, None]), expected, atol=1e-9)


def test_angles_are_drawn_in_degrees(walked):
    panels = np.reshape(orientation(walked, title="A walk").axes, (3, 3))
    for column, axes in enumerate(panels[0]):
        shown = axes.lines[0].get_ydata()
        np.testing.assert_allclose(shown, np.degrees(walked.orientation[:, column]))


def test_snapshots_are_where_they_are_asked_for(walked):
    at = (0.5, 1.25)
    figure = path_with_snapshots(walked, Robot(), title="A walk", at=at)
    labels = [text.get_text() for text in figure.legends[0].get_texts()]
    assert labels == ["t = 0.5 s", "t = 1.25 s", "body's centre", "whole seconds"]
    for patch, t in zip(figure.axes[0].patches, at, strict=True):
        body = patch.get_path().vertices
        middle = (body.min(axis=0) + body.max(axis=0)) / 2
        there = walked.position[np.abs(walked.t - t).argmin(), :2]
        np.testing.assert_allclose(middle, there, atol=0.03)
