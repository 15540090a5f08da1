# SPDX-License-Identifier: MIT
"""A marker's corners are in OpenCV's order."""

import numpy as np
from hypothesis import given
from hypothesis import strategies as st

from tracking.markers import marker_corners, square_homography
from tracking.markers.square import UNIT_SQUARE, apply_homography


def test_a_marker_on_the_floor_has_opencvs_corner_order():
    expected = [[-0.5, 0.5, 0], [0.5, 0.5, 0], [0.5, -0.5, 0], [-0.5, -0.5, 0]]
    np.testing.assert_allclose(marker_corners(1.0), expected)
    ahead = marker_corners(1.0, yaw=-np.pi / 2)
    np.testing.assert_allclose(ahead[0], [0.5, 0.5, 0], atol=1e-12)


@given(st.lists(st.floats(-0.2, 0.2), min_size=8, max_size=8))
def test_the_homography_of_a_square_takes_its_corners_there(shifts):
    corners = UNIT_SQUARE + np.reshape(shifts, (4, 2))
    H = square_homography(corners)
    np.testing.assert_allclose(apply_homography(H, UNIT_SQUARE), corners, atol=1e-9)
