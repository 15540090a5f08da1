# SPDX-License-Identifier: MIT
"""Two are drawn over each other, and their differences with what zero is to them."""

from dataclasses import replace

import numpy as np
import pytest

from model.metrics.difference import Difference
from model.poses import Poses
from support.figure_extents import overhang
from zebro_lab.validation.compare.pictures import overlay
from zebro_lab.validation.compare.values import Comparison, Curve, Quantity, RunPaths

T = np.linspace(0.0, 1.0, 5)
APART = (Difference(1.0, 0.5, 1.5, 0.99), Difference(0.1, -0.9, 1.1, 0.6))
QUANTITIES = tuple(Quantity(name, "", (T, T)) for name in ("friction", "slope"))


def comparison(**content) -> Comparison:
    return Comparison(kind="x", names=("tiles", "carpet"), quantities=QUANTITIES, source="real",
                      files=(), **content)  # fmt: skip


def keys(figure):
    return [text.get_text() for text in figure.legends[0].get_texts()]


def test_curves_have_a_panel_a_load_and_a_line_each():
    bands = np.array([[T, T + 1, T + 2], [T, T + 2, T + 3]])
    curves = tuple(Curve(T, load, bands) for load in (2.0, 7.5))
    figure = overlay(comparison(curves=curves, definition="travel"), APART, simulated=True)
    first, second, _ = figure.axes
    for axes, load in ((first, "load 2 N"), (second, "load 7.5 N")):
        assert axes.get_title(loc="left") == load
        tiles, carpet = axes.lines
        np.testing.assert_array_equal(tiles.get_ydata(), T + 1)
        np.testing.assert_array_equal(carpet.get_ydata(), T + 2)
        assert axes.get_xlabel() == "slip ratio, travel definition [-]"
    assert first.get_ylabel() == "traction force [N]"
    assert figure.get_suptitle() == "tiles and carpet (simulated)"
    assert keys(figure)[:4] == [
        "tiles: median", "tiles: 90 % of curves", "carpet: median", "carpet: 90 % of curves",
    ]  # fmt: skip


def test_a_calibration_that_is_not_trustworthy_is_marked_in_the_key():
    bands = np.array([[T, T + 1, T + 2], [T, T + 2, T + 3]])
    shown = comparison(curves=(Curve(T, 2.0, bands),), doubted=(False, True))
    assert keys(overlay(shown, APART, simulated=True))[:3:2] == [
        "tiles: median", "carpet (NOT TRUSTWORTHY): median",
    ]  # fmt: skip


def test_differences_are_black_where_zero_lies_outside():
    path = Poses(T, np.column_stack([T, T]), 0 * T)
    band = Poses(T, np.stack([path.position] * 50), np.zeros((50, len(T))))
    paths = (RunPaths(path, band), RunPaths(path, None))
    figure = overlay(comparison(paths=paths), APART, simulated=False)
    above, below = figure.axes
    assert len(above.lines) == 40 + 1 + 1 + 1  # draws, their name, two tracks
    assert above.get_xlabel() == "x from the start [m]"
    assert len(set(keys(figure))) == len(keys(figure)) == 6  # three of paths, three of differences
    clear, middle, unclear, _, zero = below.lines
    np.testing.assert_allclose(clear.get_xdata(), [1.0, 3.0])
    np.testing.assert_allclose(middle.get_xdata(), 2.0)
    np.testing.assert_allclose(unclear.get_xdata(), [-0.9, 1.1])
    assert (clear.get_color(), unclear.get_color()) == ("black", "0.6")
    assert set(zero.get_xdata()) == {0}
    assert [label.get_text() for label in below.get_yticklabels()] == ["friction", "slope"]
    assert below.get_title(loc="left") == "difference: carpet minus tiles"
    assert below.get_xlabel() == "difference over half its 90 % interval [-]"
    assert clear.get_label().endswith("zero outside")
    assert unclear.get_label().endswith("zero inside")


@pytest.mark.parametrize("letters", [30, 120])
def test_long_names_of_runs_stay_inside_the_picture(letters):
    path = Poses(T, np.column_stack([T, T]), 0 * T)
    names = tuple(f"20200601T120000Z_walk_{end * letters}" for end in "ab")
    paths = (RunPaths(path, None), RunPaths(path, None))
    compared = replace(comparison(paths=paths), names=names)
    assert overhang(overlay(compared, APART, simulated=True)) <= 0
