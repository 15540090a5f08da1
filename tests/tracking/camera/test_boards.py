# SPDX-License-Identifier: MIT
"""Corners of a board are found, in part too, or none are."""

import cv2
import numpy as np

from tracking.camera import CharucoBoard, Checkerboard, find_board
from tracking.markers.dictionaries import dictionary_named


def test_a_charuco_board_is_found_in_part():
    board = CharucoBoard(7, 5, 0.04, 0.03, "4x4_50")
    target = cv2.aruco.CharucoBoard((7, 5), 0.04, 0.03, dictionary_named("4x4_50"))
    picture = np.full((600, 800), 255, np.uint8)
    picture[100:500, 100:660] = target.generateImage((560, 400))
    whole = find_board(picture, board)
    picture[:, 400:] = 255
    part = find_board(picture, board)
    assert whole is not None
    assert part is not None
    assert len(whole.points) == 24
    assert 6 <= len(part.points) < 24
    # 80 px a square, first inner corner one square in; the edge lies between two pixels.
    expected = whole.points[:, :2] / 0.04 * 80 + 100 - 0.5
    np.testing.assert_allclose(whole.corners_px, expected, atol=0.1)


def test_no_board_is_no_view():
    empty = np.full((300, 400), 128, np.uint8)
    assert find_board(empty, Checkerboard(9, 6, 0.03)) is None
    assert find_board(empty, CharucoBoard(7, 5, 0.04, 0.03, "4x4_50")) is None
