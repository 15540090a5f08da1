# SPDX-License-Identifier: MIT
"""What is laid on a plane is read again."""

import cv2
import numpy as np

from support.drawn_board import SIZE, level_plane
from tracking.composite.body_raster import BodyRaster


def test_what_is_laid_on_a_plane_is_read_again():
    plane = level_plane()
    body = BodyRaster.over(plane, SIZE)
    rng = np.random.default_rng(1)
    values = cv2.GaussianBlur(rng.normal(0, 1, (*body.x.shape, 3)).astype(np.float32), (0, 0), 3)
    pose = np.array([0.1, -0.05, 0.7])
    layer = np.zeros((*plane.seen_px.shape[:2], 3), np.float32)
    window, laid = body.laid(values, pose)
    layer[window] = laid
    inner = (slice(3, -3), slice(3, -3))
    np.testing.assert_allclose(
        body.read(layer, pose)[inner], values[inner], atol=0.1 * values.std()
    )
