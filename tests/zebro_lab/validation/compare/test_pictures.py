# SPDX-License-Identifier: MIT
"""Two slip curves or tracks are drawn over each other, and named in the key."""

from dataclasses import replace

import numpy as np
import pytest

from model.poses import Poses
from support.figure_extents import overhang
from zebro_lab.validation.compare.pictures import overlay
from zebro_lab.validation.compare.values import Comparison, Curve

T = np.linspace(0.0, 1.0, 5)
PATH = Poses(T, np.column_stack([T, T]), 0 * T)
POINTS = np.empty((2, 0))


def comparison(**content) -> Comparison:
    return Comparison(kind="x", names=("tiles", "carpet"), quantities=(), source="real",
                      files=(), **content)  # fmt: skip


def keys(figure):
    return [text.get_text() for text in figure.legends[0].get_texts()]


def test_curves_have_a_panel_a_load_and_a_line_each():
    bands = np.array([[T, T + 1, T + 2], [T, T + 2, T + 3]])
    curves = tuple(Curve(T, load, bands, POINTS) for load in (2.0, 7.5))
    figure = overlay(comparison(curves=curves, definition="travel"), simulated=True)
    first, second = figure.axes
    for axes, load in ((first, "load 2 N"), (second, "load 7.5 N")):
        assert axes.get_title(loc="left") == load
        tiles, carpet = axes.lines
        np.testing.assert_array_equal(tiles.get_ydata(), T + 1)
        np.testing.assert_array_equal(carpet.get_ydata(), T + 2)
        assert axes.get_xlabel() == "slip ratio, travel definition [-]"
    assert first.get_ylabel() == "traction force [N]"
    assert figure.get_suptitle() == "tiles and carpet (simulated)"
    assert {"tiles", "carpet"} <= set(keys(figure))
    assert sum("90 % of whole curves" in key for key in keys(figure)) == 2


def test_a_narrow_peak_has_a_panel_of_small_slips_below():
    slip = np.linspace(0.01, 1.0, 100)
    force = slip * np.exp(-slip / 0.05)
    curve = Curve(slip, 2.0, np.stack([[force] * 3] * 2), POINTS)
    whole, narrow = overlay(comparison(curves=(curve,)), simulated=False).axes
    assert narrow.get_xlim()[1] == pytest.approx(0.15)
    assert whole.get_xlim()[1] > 1


def test_a_curve_that_is_unknown_at_a_load_leaves_the_other_s_panels():
    slip = np.linspace(0.01, 1.0, 100)
    peak = [slip * np.exp(-slip / 0.05)] * 3
    curve = Curve(slip, 2.0, np.stack([peak, np.full((3, 100), np.nan)]), POINTS)
    assert len(overlay(comparison(curves=(curve,)), simulated=False).axes) == 2


def test_tracks_are_drawn_from_their_start():
    figure = overlay(comparison(paths=(PATH, PATH)), simulated=False)
    (axes,) = figure.axes
    assert axes.get_xlabel() == "x from the start [m]"
    assert keys(figure) == ["tiles, tracked", "carpet, tracked"]


@pytest.mark.parametrize("letters", [30, 120])
def test_long_names_of_runs_stay_inside_the_picture(letters):
    names = tuple(f"20200601T120000Z_walk_{end * letters}" for end in "ab")
    compared = replace(comparison(paths=(PATH, PATH)), names=names)
    assert overhang(overlay(compared, simulated=True)) <= 0
