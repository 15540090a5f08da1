# SPDX-License-Identifier: MIT
"""A slip law drawn without data."""

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
