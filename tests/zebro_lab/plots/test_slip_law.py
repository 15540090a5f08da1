# SPDX-License-Identifier: MIT
"""A slip law drawn without data."""

import numpy as np
import pytest

from model.slip.thesis_curve import thesis_curve
from support.figure_extents import overhang
from zebro_lab.plots.slip_law import THESIS_LOADS, slip_law


def test_the_surface_is_the_law_over_tested_slip_and_load(rig):
    (axes,) = rig.picture("surface").axes
    assert axes.get_zlabel() == "traction force [N]"
    ridges = [line.get_data_3d() for line in axes.lines[:-1]]
    for slip, load, force in ridges:
        np.testing.assert_allclose(force, rig.law.force(slip, load, rig.truth))
    loads = [load[0] for _, load, _ in ridges]
    assert loads[0] == rig.blocks.normal_force.min()
    assert loads[-1] == pytest.approx(rig.blocks.normal_force.max())
    points = np.array(axes.lines[-1].get_data_3d())
    blocks = rig.blocks
    expected = [blocks.slip, blocks.normal_force, blocks.traction_force]
    np.testing.assert_array_equal(points, expected)


def test_the_thesis_s_curve_is_drawn_at_its_four_loads_with_its_peaks():
    figure = slip_law(thesis_curve(), title="thesis", simulated=False)
    assert overhang(figure) <= 0
    assert figure.get_suptitle() == "thesis"
    curves = [line for line in figure.axes[0].lines if len(line.get_xdata()) > 1]
    for load, curve in zip(THESIS_LOADS, curves, strict=True):
        slip, force = curve.get_data()
        assert force.max() == pytest.approx(0.3798 * load, rel=1e-3)
        assert slip[np.argmax(force)] == pytest.approx(0.0066 * load, abs=0.003)
