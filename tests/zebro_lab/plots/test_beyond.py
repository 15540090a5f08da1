# SPDX-License-Identifier: MIT
"""What a figure cuts off is marked where it is cut."""

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st
from matplotlib.figure import Figure

from zebro_lab.plots.beyond import limits_without_tips, mark_beyond

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
