# SPDX-License-Identifier: MIT
import numpy as np

from model.slip.load_curves import LoadCurve
from model.slip.magic_formula import magic_formula
from model.slip.read_off import read_off
from zebro_lab.calibration.read_off.pictures import read_curves


def test_each_curve_has_a_panel_with_points_and_the_formula_if_there_is_one():
    slip = np.linspace(0, 1, 62)
    force = magic_formula(slip, 34.34, 1.564, 4.84, 0.797)
    curve = LoadCurve(12.75, slip, force)
    curves = [
        (curve, "driving", read_off(slip, force)),
        (curve, "braking", None),
    ]
    figure = read_curves(curves, definition="material", simulated=True)
    driving, braking = figure.axes
    assert [line.get_label() for line in driving.lines] == ["points", "formula read off", "peak"]
    assert [line.get_label() for line in braking.lines] == ["points"]
    assert "B 34.3" in driving.get_title(loc="left")
    assert "nothing read off" in braking.get_title(loc="left")
    np.testing.assert_allclose(driving.lines[2].get_data(), [[0.08415], [4.84]], rtol=1e-2)
    assert "(simulated)" in figure.get_suptitle()
