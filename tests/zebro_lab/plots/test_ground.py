# SPDX-License-Identifier: MIT
import numpy as np
import pytest
from matplotlib.figure import Figure
from matplotlib.patches import Polygon

from model.walk.ground import FLAT, with_slope, with_steps
from model.walk.slip import Slip
from model.walk.terrain import LEVEL, SlipArea, Terrain
from model.walk.traction import VelocityCoulomb
from zebro_lab.plots.ground import draw_ground

ICE = Slip(VelocityCoulomb(0.05), "assumed")
CORNERS = np.array([[0.0, 0.0], [1.0, 0.0], [0.0, 1.0]])
LOW, HIGH = np.array([-0.5, -0.2]), np.array([1.0, 0.3])


def drawn(terrain):
    axes = Figure().add_subplot()
    axes.set(xlim=(-0.1, 0.2), ylim=(0.0, 0.1))
    draw_ground(axes, terrain, LOW, HIGH)
    assert axes.get_xlim() == (-0.1, 0.2)
    assert axes.get_ylim() == (0.0, 0.1)
    return axes


def test_level_ground_is_not_drawn():
    axes = drawn(LEVEL)
    assert not axes.images
    assert not axes.patches


def test_heights_are_shaded_in_millimetres_where_they_are():
    axes = drawn(Terrain(with_slope(with_steps(FLAT, np.array([0.5]), np.array([0.01])), 0.1, 0.0)))
    (shading,) = axes.images
    height = np.asarray(shading.get_array())
    left, right, bottom, top = shading.get_extent()
    assert (left, bottom) == pytest.approx(LOW, abs=0.01)
    assert (right, top) == pytest.approx(HIGH, abs=0.01)
    expected = 1000 * np.tan(0.1) * np.array([-0.5, 1.0]) + np.array([0.0, 10.0])
    np.testing.assert_allclose(height[3, [0, -1]], expected, atol=0.5)
    assert axes.figure.axes[1].get_ylabel() == "height of the ground [mm]"


def test_areas_are_hatched_alike_where_their_slip_is_named_alike():
    areas = [SlipArea(CORNERS + i, ICE, name) for i, name in enumerate(("ice", "sand", "ice"))]
    patches = drawn(Terrain(areas=tuple(areas))).patches
    first, second, third = (each for each in patches if isinstance(each, Polygon))
    assert first.get_hatch() == third.get_hatch() != second.get_hatch()
    assert first.get_label() == "area of slip ice"
    np.testing.assert_array_equal(first.get_xy()[:3], CORNERS)
