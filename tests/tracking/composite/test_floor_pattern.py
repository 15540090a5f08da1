# SPDX-License-Identifier: MIT
"""What a floor's neighbours do not foretell is white."""

import numpy as np
import pytest

from support.drawn_grain import WIDTH, grain
from tracking.composite.floor_pattern import FloorPattern
from tracking.errors import CompositeError


def correlation(picture, dy, dx):
    """Correlate a picture with itself so many pixels away."""
    here, there = picture[: -dy or None, : -dx or None], picture[dy:, dx:]
    return float(np.corrcoef(here.ravel(), there.ravel())[0, 1])


def test_what_is_left_of_a_floor_is_white():
    floor, other = grain(np.random.default_rng(0)), grain(np.random.default_rng(1))
    pattern = FloorPattern.of(floor, np.ones(floor.shape[:2], bool), width=WIDTH)
    left = pattern.prediction_error(pattern.flat(other))[10:-10, 10:-10]
    assert correlation(other, 0, 1) > 0.9
    for dy, dx in ((0, 1), (1, 0), (1, 1), (0, 2), (2, 0)):
        assert abs(correlation(left, dy, dx)) < 0.1
    assert left.std() == pytest.approx(1.0, rel=0.1)


def test_layers_are_foretold_as_each_picture_alone():
    floor = grain(np.random.default_rng(2))
    pattern = FloorPattern.of(floor, np.ones(floor.shape[:2], bool), width=WIDTH)
    layers = np.stack((floor, 2 * floor, floor[::-1]), axis=-1)
    together = pattern.prediction_error(layers)
    for k in range(3):
        np.testing.assert_allclose(
            together[..., k],
            pattern.prediction_error(np.ascontiguousarray(layers[..., k])),
            atol=1e-4,
        )


def test_pixels_that_may_show_the_robot_do_not_count_to_the_floor():
    floor = grain(np.random.default_rng(3))
    shown = np.ones(floor.shape[:2], bool)
    shown[100:200, 100:200] = False
    robot = floor.copy()
    robot[110:190, 110:190] += 200 * np.sign(np.sin(np.arange(80)))[:, None, None]
    flat = FloorPattern.of(floor, shown, width=5.0)
    np.testing.assert_allclose(
        FloorPattern.of(robot, shown, width=5.0).filters, flat.filters, atol=0.05
    )


def test_a_picture_without_floor_between_the_exposures_is_refused():
    floor = grain(np.random.default_rng(4))
    with pytest.raises(CompositeError, match="7 by 7 px of floor"):
        FloorPattern.of(floor, np.zeros(floor.shape[:2], bool), width=WIDTH)
