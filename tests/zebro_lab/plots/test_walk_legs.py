# SPDX-License-Identifier: MIT
"""Each leg has the panel, the contact and the force that are its own."""

from dataclasses import replace
from functools import partial

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st
from matplotlib.figure import Figure

from model.robot import Robot
from support.figure_extents import overhang
from zebro_lab.plots.walk_contacts import gantt
from zebro_lab.plots.walk_legs import (
    leg_angles,
    limits_without_tips,
    mark_beyond,
    normal_forces,
    slip_ratios,
    traction_forces,
)
from zebro_lab.plots.walk_path import motion, orientation, path_with_snapshots

T = np.linspace(0, 10, 1001)


def marks_of(values, limits):
    axes = Figure().add_subplot()
    mark_beyond(axes, T, values, limits, label="beyond")
    return {line.get_marker(): line.get_xdata() for line in axes.lines}, axes


def test_each_excursion_has_one_mark_at_its_edge():
    values = np.zeros_like(T)
    values[[100, 101, 103, 700]] = 9.0
    values[400] = -9.0
    marks, axes = marks_of(values, (-1.0, 1.0))
    np.testing.assert_allclose(marks["^"], [1.0, 7.0])
    np.testing.assert_allclose(marks["v"], [4.0])
    assert axes.get_ylim() == (-1.0, 1.0)
    assert set(axes.get_legend_handles_labels()[1]) == {"beyond"}


def test_what_lies_inside_and_what_is_unknown_has_no_mark():
    values = np.where(T < 5, 0.5, np.nan)
    assert marks_of(values, (-1.0, 1.0))[0] == {}


@given(st.floats(0, 0.02), st.floats(0, 1e-3))
def test_limits_hold_all_but_the_tips(cut, margin):
    values = np.sin(T)
    values[::200] = 50.0
    low, high = limits_without_tips(values, cut=0.01 + cut, margin=margin, least=0.0)
    assert low < -0.9
    assert 0.9 < high < 1.01
    assert limits_without_tips(values, cut=0.0, margin=0.0, least=0.0)[1] == 50.0


def test_rounding_errors_are_not_blown_up():
    low, high = limits_without_tips(1e-6 * np.sin(T), cut=0.0, margin=0.05, least=0.002)
    assert high - low == pytest.approx(0.002)
    assert limits_without_tips(np.full(3, np.nan), cut=0.0, margin=0.1, least=2.0) == (-1.0, 1.0)


FIGURES = {
    "path": partial(path_with_snapshots, robot=Robot()),
    "motion": motion,
    "orientation": orientation,
    "slip_ratio": slip_ratios,
    "normal_force": normal_forces,
    "traction_force": traction_forces,
    "leg_angles": leg_angles,
    "gantt": gantt,
}


@pytest.mark.parametrize("draw", FIGURES.values(), ids=FIGURES)
def test_a_walk_is_called_simulated_has_units_and_is_drawn_within_the_page(draw, walked):
    figure = draw(walked, title="A walk")
    assert figure.get_suptitle() == "A walk (simulated)"
    assert overhang(figure) <= 0
    labels = [label for a in figure.axes for label in (a.get_xlabel(), a.get_ylabel())]
    assert sum("[" in label for label in [*labels, figure.get_supylabel()]) >= 1 + (draw != gantt)
    still = walked.part(np.zeros(50, dtype=int))  # of a robot that stands
    draw(replace(still, t=np.arange(50) * 0.01), title="A walk")


@pytest.mark.parametrize("draw", FIGURES.values(), ids=FIGURES)
def test_a_model_without_forces_and_slip_is_drawn_and_says_so(draw, walked):
    """In the air forces are zero, which is no force that was computed."""
    bare = {name: np.full_like(getattr(walked, name), np.nan)
            for name in ("slip_ratio", "normal_force", "traction_force")}  # fmt: skip
    bare["normal_force"] = np.where(walked.contact, np.nan, 0.0)
    figure = draw(replace(walked, **bare), title="A walk")
    texts = [text.get_text() for axes in figure.axes for text in axes.texts]
    empty = draw in (slip_ratios, normal_forces, traction_forces)
    assert ("this model computes none" in texts) == empty


def test_legs_are_where_they_are_on_the_robot(walked):
    figure = normal_forces(walked, title="A walk")
    names = [axes.get_title(loc="left") for axes in figure.axes]
    assert names[0] == "leg 1, left front"
    assert names[5] == "leg 6, right rear"
    for leg, axes in enumerate(figure.axes):  # the first line is zero
        np.testing.assert_array_equal(axes.lines[1].get_ydata(), walked.normal_force[:, leg])


def test_leg_angles_are_drawn_modulo_a_turn_without_a_line_across(walked):
    for leg, axes in enumerate(leg_angles(walked, title="A walk").axes):
        (line,) = (each for each in axes.lines if len(each.get_xdata()) == len(walked.t))
        drawn = np.asarray(line.get_ydata(), dtype=float)
        seen = ~np.isnan(drawn)
        assert 0.9 < seen.mean() < 1.0  # a gap where a turn is over
        np.testing.assert_allclose(drawn[seen], np.degrees(walked.theta[seen, leg]) % 360)
        steps = np.diff(drawn)
        assert np.nanmax(np.abs(steps)) < 180
        assert axes.get_ylim() == (0, 360)


def test_a_leg_at_rest_has_no_slip_ratio_whatever_the_solver_leaves_of_it(walked):
    n, half = len(walked.t), len(walked.t) // 2
    theta = walked.theta.copy()
    theta[half:] = theta[half]
    still = replace(walked, theta=theta, slip_ratio=np.full((n, 6), 0.01))
    for axes in slip_ratios(still, title="").axes:
        drawn = axes.lines[1].get_ydata()
        assert np.all(np.isnan(drawn[half:]))
        assert np.isfinite(drawn[: half - 10]).mean() > 0.9
