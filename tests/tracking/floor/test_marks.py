# SPDX-License-Identifier: MIT
"""Marks of a floor are laid down once."""

from dataclasses import replace

import numpy as np
import pytest

from support.drawn_floor import FLOOR
from tracking.errors import FloorError
from tracking.floor import FloorMap, FloorMarker, FloorPoint


def test_a_mark_laid_down_twice_is_refused():
    with pytest.raises(FloorError, match="marker 10 more than once"):
        FloorMap("4x4_50", (FLOOR.markers[0], FLOOR.markers[0]))


@pytest.mark.parametrize(
    "mark", [FloorMarker(10, 0.1, 0.3, -0.4, 0.7), FloorPoint("door", 0.3, -0.4, 0.01)]
)
def test_derivatives_agree_with_finite_differences(mark):
    for k, sd in enumerate(mark.prior_sd):
        step = np.zeros(len(mark.prior_sd))
        step[k] = 1e-6
        slope = (mark.moved(step).points - mark.moved(-step).points) / 2e-6
        np.testing.assert_allclose(mark.derivative[:, :, k], slope, atol=1e-6)
        assert sd > 0


def test_a_map_mirrored_twice_is_the_map():
    floor = replace(FLOOR, points=(FloorPoint("door", 1.0, 0.5),))
    assert floor.mirrored().mirrored() == floor
    assert floor.mirrored().marks["door"].points[0].tolist() == [1.0, -0.5, 0.0]
    assert floor.with_marks({}) == floor
