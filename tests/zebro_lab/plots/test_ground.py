# SPDX-License-Identifier: MIT
import numpy as np
import pytest
from matplotlib.figure import Figure

from model.walk.ground import FLAT, with_slope
from support.grounds import sample_ground
from zebro_lab.plots.ground import draw_ground

LOW, HIGH = np.array([-0.5, -0.2]), np.array([1.0, 0.3])


def drawn(ground):
    axes = Figure().add_subplot()
    axes.set(xlim=(-0.1, 0.2), ylim=(0.0, 0.1))
    draw_ground(axes, ground, LOW, HIGH)
    assert axes.get_xlim() == (-0.1, 0.2)
    assert axes.get_ylim() == (0.0, 0.1)
    return axes


def test_level_ground_is_not_drawn():
    axes = drawn(FLAT)
    assert not axes.images


def test_heights_are_shaded_in_millimetres_where_they_are():
    step = sample_ground(lambda x, y: 0.01 * (x > 0.5) + 0 * y, x=(-1, 2), y=(-1, 1))
    axes = drawn(with_slope(step, 0.1, 0.0))
    (shading,) = axes.images
    height = np.asarray(shading.get_array())
    left, right, bottom, top = shading.get_extent()
    assert (left, bottom) == pytest.approx(LOW, abs=0.01)
    assert (right, top) == pytest.approx(HIGH, abs=0.01)
    expected = 1000 * np.tan(0.1) * np.array([-0.5, 1.0]) + np.array([0.0, 10.0])
    np.testing.assert_allclose(height[3, [0, -1]], expected, atol=0.5)
    assert axes.figure.axes[1].get_ylabel() == "height of the ground [mm]"
