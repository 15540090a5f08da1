# SPDX-License-Identifier: MIT
"""Each leg has the panel, the contact and the force that are its own."""

from dataclasses import replace

import numpy as np
from hypothesis import given
from hypothesis import strategies as st
from hypothesis.extra.numpy import arrays

from zebro_lab.plots.walk_legs import (
    gantt,
    leg_angles,
    normal_forces,
    slip_ratios,
    stances,
)


def test_legs_are_where_they_are_on_the_robot(walked):
    figure = normal_forces(walked, title="A walk")
    names = [axes.get_title(loc="left") for axes in figure.axes]
    assert names[0] == "leg 1, left front"
    assert names[5] == "leg 6, right rear"
    for leg, axes in enumerate(figure.axes):  # the first line is zero
        np.testing.assert_array_equal(axes.lines[1].get_ydata(), walked.normal_force[:, leg])


@given(arrays(bool, st.integers(1, 30)))
def test_stances_are_where_the_contact_is(contact):
    t = np.arange(float(len(contact)))
    found = np.zeros(len(contact), dtype=bool)
    for start, end in stances(t, contact):
        found[(t >= start) & ((t < end) | ((t == t[-1]) & (end == t[-1]) & contact[-1]))] = True
    np.testing.assert_array_equal(found, contact)


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


def test_bars_of_contact_are_the_stances_of_each_leg(walked):
    (axes,) = gantt(walked, title="A walk").axes
    assert len(axes.collections) == 6
    labels = axes.get_legend_handles_labels()[1]
    assert set(labels) == {"left leg on the ground", "right leg on the ground"}
    for leg, bars in enumerate(axes.collections):
        boxes = [path.get_extents() for path in bars.get_paths()]
        drawn = [(box.x0, box.x1) for box in boxes]
        np.testing.assert_allclose(drawn, stances(walked.t, walked.contact[:, leg]))
        assert all(box.y0 < leg + 1 < box.y1 for box in boxes)
    low, high = axes.get_ylim()
    assert low > high  # leg 1 on top
    names = [label.get_text() for label in axes.get_yticklabels()]
    assert names[0] == "1  left front"
    assert axes.get_xlabel() == "time [s]"
    np.testing.assert_allclose(axes.get_xlim(), (walked.t[0] - 0.04, walked.t[-1] + 0.04))


def test_a_leg_at_rest_has_no_slip_ratio_whatever_the_solver_leaves_of_it(walked):
    n, half = len(walked.t), len(walked.t) // 2
    theta = walked.theta.copy()
    theta[half:] = theta[half]
    still = replace(walked, theta=theta, slip_ratio=np.full((n, 6), 0.01))
    for axes in slip_ratios(still, title="").axes:
        drawn = axes.lines[1].get_ydata()
        assert np.all(np.isnan(drawn[half:]))
        assert np.isfinite(drawn[: half - 10]).mean() > 0.9


def test_forces_that_a_model_does_not_compute_are_said_to_be_none(walked):
    """In the air they are zero, which is no force that was computed."""
    force = np.where(walked.contact, np.nan, 0.0)
    for path, texts in ((walked, 0), (replace(walked, normal_force=force), 6)):
        figure = normal_forces(path, title="A walk")
        said = [each for axes in figure.axes for each in axes.texts]
        assert len([each for each in said if "computes none" in each.get_text()]) == texts
