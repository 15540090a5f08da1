# SPDX-License-Identifier: MIT
"""Geometry of a square marker: its corners, its picture and its homography.

The order of corners is OpenCV's: top left, top right, bottom right, bottom left of the marker as
printed.
"""

from functools import lru_cache

import numpy as np
from numpy.typing import ArrayLike

from model.arrays import Array
from tracking.markers.dictionaries import marker_family

UNIT_SQUARE: Array = np.array([[0.0, 0.0], [1.0, 0.0], [1.0, 1.0], [0.0, 1.0]])
"""Corners in the marker's own coordinates: across to the right, down, side 1."""


def marker_corners(side: float, position: ArrayLike = (0.0, 0.0, 0.0), yaw: float = 0.0) -> Array:
    """Compute the corners of a marker that lies flat, face up.

    Args:
        side: Side of the black square [m].
        position: Centre of the marker, shape (3,) [m].
        yaw: Direction from the left to the right edge of the print, counter-clockwise from x
            [rad]. A marker whose top points along x has yaw = -pi/2.

    Returns:
        Corners in OpenCV's order, shape (4, 3) [m].
    """
    across, up = UNIT_SQUARE[:, 0] - 0.5, 0.5 - UNIT_SQUARE[:, 1]
    c, s = np.cos(yaw), np.sin(yaw)
    flat = side * np.column_stack((c * across - s * up, s * across + c * up, np.zeros(4)))
    return flat + np.asarray(position, dtype=float)


@lru_cache(maxsize=64)
def marker_picture(dictionary: str, marker_id: int, cell_px: int) -> Array:
    """Draw a marker with a margin one cell wide: white, or black where its border is white.

    Args:
        dictionary: Name of the dictionary.
        marker_id: Number of the marker in the dictionary.
        cell_px: Side of a cell [px].

    Returns:
        Brightness, 0 black and 1 white, shape (n, n), n = `cell_px` times cells with border and
        margin. Cached and read-only.

    Raises:
        MarkerError: When there is no such dictionary.
        cv2.error: When the dictionary has no such number.
    """
    cells = marker_family(dictionary).cells_of(marker_id)
    picture = np.kron(cells, np.ones((cell_px, cell_px), dtype=np.float32))
    picture.setflags(write=False)
    return picture


def square_homography(corners: ArrayLike) -> Array:
    """Compute the homography from the unit square to four corners.

    The formula is written out because OpenCV's function accepts single precision only.

    Args:
        corners: Images of the corners of `UNIT_SQUARE`, in its order, shape (..., 4, 2).

    Returns:
        H with (x, y, 1) ~ H (u, v, 1), shape (..., 3, 3), H[2, 2] = 1; (u, v) in the square.

    Raises:
        LinAlgError: The last three corners lie exactly on a line.

    >>> (square_homography([[3, 4], [5, 4], [5, 7], [3, 7]]) + 0.0).round(9).tolist()
    [[2.0, 0.0, 3.0], [0.0, 3.0, 4.0], [0.0, 0.0, 1.0]]
    """
    p0, p1, p2, p3 = np.moveaxis(np.asarray(corners, dtype=float), -2, 0)
    # Heckbert 1989, section 2.2.3: the square's own corners make most coefficients 0 or 1.
    sides = np.stack((p1 - p2, p3 - p2), axis=-1)
    gh = np.linalg.solve(sides, (p0 - p1 + p2 - p3)[..., None])[..., 0]
    H = np.ones((*p0.shape[:-1], 3, 3))
    H[..., :2, 0] = p1 - p0 + gh[..., :1] * p1
    H[..., :2, 1] = p3 - p0 + gh[..., 1:] * p3
    H[..., :2, 2], H[..., 2, :2] = p0, gh
    return H


def apply_homography(H: Array, points: ArrayLike) -> Array:
    """Apply a homography to points.

    Args:
        H: Homography, shape (3, 3).
        points: x and y, shape (n, 2).

    Returns:
        Transformed points, shape (n, 2).
    """
    x = np.asarray(points, dtype=float) @ H[:, :2].T + H[:, 2]
    return x[:, :2] / x[:, 2:]


def edge_growth(corners: ArrayLike) -> Array:
    """Compute how the corners of a marker move when each of its edges moves outwards by one pixel.

    Sharpening, exposure, compression and resampling move the border between black and white by a
    fraction of a pixel, in the picture, whatever the distance of the marker.

    Args:
        corners: Corners in their order around the marker, shape (..., 4, 2) [px].

    Returns:
        Movement of the corners, shape (..., 4, 2) [px per px].

    Raises:
        LinAlgError: Three successive corners lie on a line.

    >>> edge_growth([[0, 0], [10, 0], [10, 10], [0, 10]]).tolist()
    [[-1.0, -1.0], [1.0, -1.0], [1.0, 1.0], [-1.0, 1.0]]
    """
    at = np.asarray(corners, dtype=float)
    along = np.roll(at, -1, axis=-2) - at
    along /= np.linalg.norm(along, axis=-1, keepdims=True)
    normal = np.stack((along[..., 1], -along[..., 0]), axis=-1)
    away = at - at.mean(axis=-2, keepdims=True)
    # Outwards, whichever way round the corners go.
    normal *= np.sign((normal * away).sum(axis=(-2, -1)))[..., None, None]
    both = np.stack((normal, np.roll(normal, 1, axis=-2)), axis=-2)
    return np.linalg.solve(both, np.ones((*both.shape[:-1], 1)))[..., 0]
