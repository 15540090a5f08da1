# SPDX-License-Identifier: MIT
"""Synthetic pictures of markers on a floor."""

import cv2
import numpy as np

from tracking.markers import marker_picture, square_homography
from tracking.markers.square import UNIT_SQUARE

SIZE = 200


def random_quad(rng: np.random.Generator, side: float) -> np.ndarray:
    angle = rng.uniform(0, 2 * np.pi)
    turn = np.array([[np.cos(angle), -np.sin(angle)], [np.sin(angle), np.cos(angle)]])
    flat = (UNIT_SQUARE - 0.5) @ turn.T * [side, 0.75 * side]
    return flat + SIZE / 2 + rng.uniform(-1, 1, 2) + 0.03 * side * rng.uniform(-1, 1, (4, 2))


def photograph(corners, rng, *, blur=0.7, noise=2.0, contrast=0.8, quality=None, number=0):
    """Draw a marker with a white margin at corners whose pixel centres are integers."""
    drawn = marker_picture("4x4_50", number, 32)
    inner = drawn.shape[0] - 64
    own = np.array([[1, 0, 0.5 - 32], [0, 1, 0.5 - 32], [0, 0, inner]]) / inner
    fine = np.array([[6, 0, 2.5], [0, 6, 2.5], [0, 0, 1.0]])
    picture = cv2.warpPerspective(
        drawn * 255, fine @ square_homography(corners) @ own, (6 * SIZE, 6 * SIZE), borderValue=180
    )
    picture = cv2.resize(picture, (SIZE, SIZE), interpolation=cv2.INTER_AREA)
    picture = cv2.GaussianBlur(picture.astype(float), (0, 0), blur) * contrast + 8
    picture += noise * rng.standard_normal(picture.shape)
    grey = np.clip(picture, 0, 255).astype(np.uint8)
    if quality is not None:
        coded = cv2.imencode(".jpg", grey, [cv2.IMWRITE_JPEG_QUALITY, quality])[1]
        grey = cv2.imdecode(coded, cv2.IMREAD_GRAYSCALE)
    return grey
