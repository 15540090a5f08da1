# SPDX-License-Identifier: MIT
"""Two are drawn over each other, and their differences with what zero is to them."""

import numpy as np

from model.metrics.difference import Difference
from model.poses import Poses
from zebro_lab.validation.compare.pictures import overlay
from zebro_lab.validation.compare.values import Comparison, Curve, Quantity, RunPaths

T = np.linspace(0.0, 1.0, 5)
APART = (Difference(1.0, 0.5, 1.5, 0.99), Difference(0.1, -0.9, 1.1, 0.6))
QUANTITIES = tuple(Quantity(name, "", (T, T)) for name in ("friction", "slope"))


def comparison(**content) -> Comparison:
    return Comparison(kind="x", names=("tiles", "carpet"), quantities=QUANTITIES, source="real",
                      files=(), **content)  # fmt: skip


def test_curves_have_a_panel_a_load_and_a_line_each():
    bands = np.array([[T, T + 1, T + 2], [T, T + 2, T + 3]])
    curves = tuple(Curve(T, load, bands) for load in (2.0, 7.5))
    figure = overlay(comparison(curves=curves, definition="travel"), APART, simulated=True)
    first, second, _ = figure.axes
    for axes, load in ((first, "2 N"), (second, "7.5 N")):
        assert axes.get_title(loc="left") == load
        tiles, carpet = axes.lines
        np.testing.assert_array_equal(tiles.get_ydata(), T + 1)
        np.testing.assert_array_equal(carpet.get_ydata(), T + 2)
    assert first.get_xlabel() == "slip ratio, travel definition [-]"
    assert first.get_ylabel() == "traction force [N]"
    assert figure.get_suptitle() == "tiles and carpet (simulated)"


def test_differences_are_black_where_zero_lies_outside():
    path = Poses(T, np.column_stack([T, T]), 0 * T)
    band = Poses(T, np.stack([path.position] * 50), np.zeros((50, len(T))))
    paths = (RunPaths(path, band), RunPaths(path, None))
    figure = overlay(comparison(paths=paths), APART, simulated=False)
    above, below = figure.axes
    assert len(above.lines) == 40 + 1 + 1 + 1  # draws, their name, two tracks
    assert above.get_xlabel() == "x from the start [m]"
    clear, middle, unclear, _, zero = below.lines
    np.testing.assert_allclose(clear.get_xdata(), [1.0, 3.0])
    np.testing.assert_allclose(middle.get_xdata(), 2.0)
    np.testing.assert_allclose(unclear.get_xdata(), [-0.9, 1.1])
    assert (clear.get_color(), unclear.get_color()) == ("black", "0.6")
    assert set(zero.get_xdata()) == {0}
    assert [label.get_text() for label in below.get_yticklabels()] == ["friction", "slope"]
    assert below.get_xlabel().startswith("carpet minus tiles")
