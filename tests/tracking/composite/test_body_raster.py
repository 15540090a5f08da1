# SPDX-License-Identifier: MIT
"""The points of a robot are those of the plane below it, wherever it stands."""

import numpy as np
import pytest

from support.drawn_board import SIZE, level_plane
from tracking.composite.body_raster import BodyRaster


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


def test_the_template_is_as_large_as_the_body():
    body = BodyRaster.over(level_plane(), SIZE)
    template = body.template(np.zeros((*body.x.shape, 3), np.float32), 0.03)
    assert (template.plate.length, template.plate.width) == pytest.approx(SIZE, abs=body.cell)
    assert template.points_body[..., 2] == pytest.approx(0.03)
