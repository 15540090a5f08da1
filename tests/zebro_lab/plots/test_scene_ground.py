# SPDX-License-Identifier: MIT
import numpy as np
import pytest

from model.walk.ground import FLAT, ground_at, with_slope
from model.walk.slip import Slip
from model.walk.terrain import LEVEL, SlipArea, Terrain
from model.walk.traction import VelocityCoulomb
from zebro_lab.plots.scene_ground import area_lines, ground_lines, heights_along

HILL = with_slope(FLAT, 0.2, -0.1)
LOW, HIGH = np.array([-0.2, 0.0]), np.array([0.3, 0.4])
SQUARE = np.array([[0.0, 0.1], [0.1, 0.1], [0.1, 0.2], [0.0, 0.2]])
ICE = Terrain(HILL, (SlipArea(SQUARE, Slip(VelocityCoulomb(0.05), "assumed")),))


@pytest.mark.parametrize("ground", [FLAT, HILL])
def test_lines_lie_on_the_ground_and_within_the_view(ground):
    lines = ground_lines(ground, LOW, HIGH)
    assert len(lines) == 10 + 8
    for x, y, z in np.concatenate(lines):
        assert z == pytest.approx(ground_at(ground, x, y)[0])
        assert -0.2 <= x <= 0.3 + 1e-9
        assert 0.0 <= y <= 0.4 + 1e-9


def test_areas_are_hatched_inside_only():
    points = np.concatenate(area_lines(ICE, LOW, HIGH))
    assert np.all((points[:, :2] > [-0.001, 0.099]) & (points[:, :2] < [0.101, 0.201]))
    assert np.ptp(points[:, 0]) > 0.07
    assert not area_lines(LEVEL, LOW, HIGH)


def test_places_have_the_height_of_the_ground():
    (found,) = heights_along(HILL, np.array([[0.5, 1.0]]))
    np.testing.assert_allclose(found, [0.5, 1.0, 0.5 * np.tan(0.2) - np.tan(0.1)])
