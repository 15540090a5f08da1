# SPDX-License-Identifier: MIT
"""Lines of the ground in 3-D: a grid that lies on it, and hatching of its areas."""

import numpy as np
from matplotlib.path import Path

from model.arrays import Array
from model.walk.ground import Ground, height_and_slopes, is_level
from model.walk.terrain import Terrain

AREA = "#7a9cc6"
_GRID = 0.05  # distance of the lines on the ground [m]
_HATCH = 0.02  # distance of the lines on an area [m]
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


def area_lines(terrain: Terrain, low: Array, high: Array) -> list[Array]:
    """Return lines along x, on the ground, in the parts of areas between two corners, (m, 3) each.

    Args:
        terrain: The ground and its areas.
        low: Smallest x and y, shape (2,) [m].
        high: Largest x and y, shape (2,) [m].
    """
    lines = []
    x = np.arange(np.ceil(low[0] / _FINE), high[0] / _FINE) * _FINE
    for area in terrain.areas:
        polygon = Path(area.polygon)
        for y in np.arange(np.ceil(low[1] / _HATCH), high[1] / _HATCH) * _HATCH:
            place = np.column_stack([x, np.full_like(x, y)])
            inside = np.flatnonzero(polygon.contains_points(place))
            runs = np.split(inside, np.flatnonzero(np.diff(inside) > 1) + 1)
            lines += [heights_along(terrain.ground, place[run]) for run in runs if len(run) > 1]
    return lines
