# SPDX-License-Identifier: MIT
"""A slip law drawn without data."""

from dataclasses import replace

import numpy as np
import pytest

from model.slip.thesis import thesis_curve
from support.figure_extents import overhang
from zebro_lab.plots.slip_law import THESIS_LOADS, slip_law


def test_the_thesis_s_curve_is_drawn_at_its_four_loads_with_its_peaks():
    figure = slip_law(thesis_curve(), title="thesis", simulated=False)
    assert overhang(figure) <= 0
    assert figure.get_suptitle() == "thesis"
    curves = [line for line in figure.axes[0].lines if len(line.get_xdata()) > 1]
    for load, curve in zip(THESIS_LOADS, curves, strict=True):
        slip, force = curve.get_data()
        assert force.max() == pytest.approx(0.3798 * load, rel=1e-3)
        assert slip[np.argmax(force)] == pytest.approx(0.0066 * load, abs=0.003)


def test_a_curve_tested_at_other_loads_is_drawn_at_four_of_them():
    curve = replace(thesis_curve(), load_range=(20.0, 50.0))
    figure = slip_law(curve, title="other", simulated=True)
    labels = [text.get_text() for text in figure.legends[0].get_texts()]
    assert labels == [f"load {load} N" for load in (20, 30, 40, 50)]
    assert figure.get_suptitle() == "other (simulated)"
