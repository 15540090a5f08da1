# SPDX-License-Identifier: MIT
import numpy as np
import pytest

from model.walk.ground import FLAT, ground_at, with_slope
from zebro_lab.plots.scene_ground import ground_lines, heights_along

HILL = with_slope(FLAT, 0.2, -0.1)
LOW, HIGH = np.array([-0.2, 0.0]), np.array([0.3, 0.4])


@pytest.mark.parametrize("ground", [FLAT, HILL])
def test_lines_lie_on_the_ground_and_within_the_view(ground):
    lines = ground_lines(ground, LOW, HIGH)
    assert len(lines) == 10 + 8
    for x, y, z in np.concatenate(lines):
        assert z == pytest.approx(ground_at(ground, x, y)[0])
        assert -0.2 <= x <= 0.3 + 1e-9
        assert 0.0 <= y <= 0.4 + 1e-9


def test_places_have_the_height_of_the_ground():
    (found,) = heights_along(HILL, np.array([[0.5, 1.0]]))
    np.testing.assert_allclose(found, [0.5, 1.0, 0.5 * np.tan(0.2) - np.tan(0.1)])
