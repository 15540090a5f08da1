# SPDX-License-Identifier: MIT
"""The slip surface spans what was tested."""

import numpy as np
import pytest


def test_the_surface_is_the_law_over_tested_slip_and_load(rig):
    (axes,) = rig.picture("surface").axes
    assert axes.get_zlabel() == "traction force, also as colour [N]"
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
