# SPDX-License-Identifier: MIT
"""A reading resamples a picture on the plane of the robot's top, where floor or robot is seen."""

from dataclasses import replace

import numpy as np
import pytest

from support.drawn_board import PRIOR, SIZE, TOP, composite, level_plane, likeness
from tracking.camera import project
from tracking.composite.reading import CELLS, BodyRaster, Reading

AT = np.array([0.05, 0.0, 0.3])


@pytest.fixture(scope="module")
def known():
    return likeness(composite(AT[None]), AT, reach=0.3)


def test_the_raster_is_as_fine_as_asked_and_lies_at_the_height_of_the_robots_top(known):
    for cells in (16, 32):
        reading = Reading.of(known, cells=cells)
        plane = reading.plane
        assert plane.cell == pytest.approx(SIZE[0] / cells)
        assert reading.picture.shape == (*plane.seen_px.shape[:2], 3)
        xy = plane.xy_at(3, 5)
        world = np.array([[*xy, PRIOR.height + TOP]])
        np.testing.assert_allclose(
            plane.seen_px[3, 5], project(known.camera, known.view, world)[0], atol=1e-9
        )
    assert reading.length == SIZE[0]
    assert Reading.of(known).plane.cell == pytest.approx(SIZE[0] / CELLS)


def test_points_are_used_that_show_floor_or_robot_in_the_picture(known):
    reading = Reading.of(known)
    column, row = np.moveaxis(reading.plane.seen_px, -1, 0)
    outside = (column < 0) | (row < 0) | (column > 639) | (row > 399)
    assert outside.any()
    np.testing.assert_array_equal(reading.used, ~outside)
    hidden = known.hidden.copy()
    hidden[150:250, 200:300] = True
    used = Reading.of(replace(known, hidden=hidden)).used
    within = (row > 150) & (row < 249) & (column > 200) & (column < 299)
    around = (row > 140) & (row < 260) & (column > 190) & (column < 310)
    assert within.any()
    assert not used[within].any()
    np.testing.assert_array_equal(used[~around], ~outside[~around])


def test_a_layer_is_read_at_the_points_of_the_robot():
    plane = level_plane()
    body = BodyRaster.over(plane, SIZE)
    rows, columns = plane.seen_px.shape[:2]
    row, column = np.indices((rows, columns))
    xy = np.stack((plane.low[0] + column * plane.cell, plane.high[1] - row * plane.cell), axis=-1)
    x, y, yaw = pose = np.array([0.1, -0.05, 0.7])
    seen = body.read(xy.astype(np.float32), pose)
    c, s = np.cos(yaw), np.sin(yaw)
    np.testing.assert_allclose(seen[..., 0], x + c * body.x - s * body.y, atol=1e-4)
    np.testing.assert_allclose(seen[..., 1], y + s * body.x + c * body.y, atol=1e-4)
    assert body.thinned().x.shape == tuple(side // 2 for side in body.x.shape)
