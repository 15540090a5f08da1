# SPDX-License-Identifier: MIT
"""The floor's colours are distinguished from the robot's, in shadow too."""

import cv2
import numpy as np
import pytest

from support.drawn_board import composite, exposure, floor
from tracking.composite.colours import FloorColours


def test_a_floor_in_shadow_is_still_the_floor_and_the_robot_is_not():
    picture = composite(np.array([[0.0, 0.0, 0.3]])).astype(np.float32)
    _, mask = exposure(np.array([0.0, 0.0, 0.3]), np.random.default_rng(0), picture)
    look = FloorColours.of(picture, np.ones(mask.shape, bool), width=80, noise=3.0)
    far = cv2.dilate(mask.astype(np.uint8), np.ones((9, 9))) == 0
    assert look.shows(picture)[far].mean() > 0.99
    assert look.shows(0.6 * picture)[far].mean() > 0.95
    assert look.shows(picture)[mask].mean() < 0.1


def test_a_robot_on_the_floor_does_not_change_how_the_floor_looks():
    rng = np.random.default_rng(3)
    picture = (floor(rng) + rng.normal(0, 1, (400, 640, 3))).astype(np.float32)
    used = np.ones(picture.shape[:2], bool)
    bare = FloorColours.of(picture, used, width=60, noise=0.5)
    picture[100:220, 100:220] = (120, 60, 30)
    with_robot = FloorColours.of(picture, used, width=60, noise=0.5)
    white = bare.whitening.T @ with_robot.covariance @ bare.whitening
    np.testing.assert_allclose(white, np.eye(3), atol=0.2)
    far = with_robot.floor_distance(picture)
    assert far[130:190, 130:190].min() > 30
    assert np.median(far[300:]) == pytest.approx(
        np.median(bare.floor_distance(picture)[300:]), rel=0.1
    )
