# SPDX-License-Identifier: MIT
"""The band of a path is drawn at its quantiles."""

import numpy as np
import pytest

from model.poses import Poses
from zebro_lab.plots.path_band import path_band

T = np.linspace(0.0, 2.0, 21)
SHIFTS = np.linspace(-1.0, 1.0, 101)


@pytest.fixture
def draws() -> Poses:
    """Return 101 draws of a path along x, evenly to the left and right of it."""
    position = np.zeros((len(SHIFTS), len(T), 2))
    position[..., 0], position[..., 1] = T, SHIFTS[:, None] * T
    return Poses(T, position, np.radians(10.0) * SHIFTS[:, None] * T)


def test_bands_hold_half_and_nine_tenths_of_the_draws(draws):
    figure = path_band(draws, title="A walk")
    assert figure.get_suptitle() == "A walk (simulated)"
    above, x, y, yaw = figure.axes
    assert len(above.lines) == 60 + 1
    np.testing.assert_allclose(above.lines[-1].get_xydata(), np.column_stack([T, 0 * T]), atol=1e-9)
    for axes, end in ((y, 2.0), (yaw, 20.0)):
        reach = [band.get_paths()[0].get_extents().ymax for band in axes.collections]
        assert reach == pytest.approx([0.9 * end, 0.5 * end])
    np.testing.assert_allclose(x.lines[0].get_xydata(), np.column_stack([T, T]))
    labels = [axes.get_ylabel() for axes in (above, x, y, yaw)]
    assert labels == ["y [m]", "x [m]", "y [m]", "yaw [deg]"]
    assert yaw.get_xlabel() == "time [s]"
