# SPDX-License-Identifier: MIT
"""Lines of the ground in 3-D: a grid that lies on it."""

import numpy as np

from model.arrays import Array
from model.walk.ground import Ground, height_and_slopes, is_level

_GRID = 0.05  # distance of the lines on the ground [m]
_FINE = 0.01  # distance of points of a line on ground that is not level [m]


def heights_along(ground: Ground, position: Array) -> Array:
    """Return places with the height of the ground there, shape (n, 3) [m].

    Args:
        ground: The ground.
        position: x and y of the places, shape (n, 2) [m].
    """
    if is_level(ground):
        height = np.full(len(position), ground.height[0, 0])
    else:
        height = np.array([height_and_slopes(ground, x, y)[0] for x, y in position])
    return np.column_stack([position, height])


def ground_lines(ground: Ground, low: Array, high: Array) -> list[Array]:
    """Return lines along x and y that lie on the ground, shape (m, 3) each [m].

    Args:
        ground: The ground.
        low: Smallest x and y, shape (2,) [m].
        high: Largest x and y, shape (2,) [m].
    """
    lines = []
    for axis in (0, 1):
        along = np.array([low[1 - axis], high[1 - axis]])
        if not is_level(ground):
            along = np.linspace(along[0], along[1], round(float(np.ptp(along)) / _FINE) + 1)
        for at in np.arange(np.ceil(low[axis] / _GRID), high[axis] / _GRID) * _GRID:
            place = np.empty((len(along), 2))
            place[:, axis], place[:, 1 - axis] = at, along
            lines.append(heights_along(ground, place))
    return lines
