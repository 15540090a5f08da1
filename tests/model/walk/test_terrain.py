# SPDX-License-Identifier: MIT
import numpy as np
import pytest

from model.errors import DomainError
from model.walk.ground import FLAT, with_slope
from model.walk.slip import Slip
from model.walk.terrain import LEVEL, SlipArea, Terrain
from model.walk.traction import VelocityCoulomb

ICE = Slip(VelocityCoulomb(0.05), "assumed")
CORNERS = np.array([[0.0, 0.0], [1.0, 0.0], [0.0, 1.0]])


def test_only_level_ground_of_one_law_is_alike_everywhere():
    assert LEVEL.is_alike_everywhere
    assert not Terrain(with_slope(FLAT, 0.1, 0.0)).is_alike_everywhere
    assert not Terrain(areas=(SlipArea(CORNERS, ICE),)).is_alike_everywhere


def test_laws_of_areas_are_tabulated_with_their_polygons():
    (area,) = Terrain(areas=(SlipArea(CORNERS, ICE),)).tabulated(weight=30.0, toe="saturated")
    np.testing.assert_array_equal(area.polygon, CORNERS)
    assert area.table.toe[0] == 0.05


def test_corners_that_enclose_nothing_are_refused():
    with pytest.raises(DomainError, match="lie on one line"):
        SlipArea(np.array([[0.0, 0.0], [1.0, 1.0], [3.0, 3.0]]), ICE)
