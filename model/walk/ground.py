# SPDX-License-Identifier: MIT
"""The ground under a walk: a plane, and heights on a grid, which add up."""

from typing import NamedTuple

import numpy as np

from model.arrays import Array
from model.compiled import compiled, inlined
from model.errors import DomainError


class Ground(NamedTuple):
    """Height of the ground: a plane, and a square grid with bilinear interpolation.

    Both heights add up. Beyond the grid the height of its edge continues. It is a named tuple
    because numba accepts one directly.

    Attributes:
        x: Position of the grid's first row [m].
        y: Position of the grid's first column [m].
        step: Distance between neighbours [m].
        height: Heights, rows along x, columns along y, shape (m, n); (1, 1) for a constant [m].
        highest: The largest height of the grid [m].
        slope_x: Rise of the plane, which is zero at the origin, for each metre of x [-].
        slope_y: Rise of the plane for each metre of y [-].
    """

    x: float
    y: float
    step: float
    height: Array
    highest: float
    slope_x: float = 0.0
    slope_y: float = 0.0


FLAT = Ground(0.0, 0.0, 1.0, np.zeros((1, 1)), 0.0)


def is_level(ground: Ground) -> bool:
    """Return whether the ground is a level plane, on which a walk depends on no place or heading.

    Args:
        ground: The ground.
    """
    return ground.height.size == 1 and ground.slope_x == 0 and ground.slope_y == 0


def highest_near(ground: Ground, x: float, y: float, far: float) -> float:
    """Return an upper bound on the height of the ground within a square about a place [m].

    Where the square goes beyond the grid, the grid's edge counts.

    Args:
        ground: The ground.
        x: x of the place [m].
        y: y of the place [m].
        far: Half the side of the square [m].
    """
    if is_level(ground):
        return float(ground.height[0, 0])
    m, n = ground.height.shape
    i = (np.array([x - far, x + far]) - ground.x) / ground.step
    j = (np.array([y - far, y + far]) - ground.y) / ground.step
    i0, i1 = np.clip([np.floor(i[0]), np.ceil(i[1])], 0, m - 1).astype(int)
    j0, j1 = np.clip([np.floor(j[0]), np.ceil(j[1])], 0, n - 1).astype(int)
    near = ground.height[i0 : i1 + 1, j0 : j1 + 1]
    plane = ground.slope_x * x + ground.slope_y * y
    plane += far * (abs(ground.slope_x) + abs(ground.slope_y))
    return float(near.max()) + plane


def with_slope(ground: Ground, angle_x: float, angle_y: float) -> Ground:
    """Return the ground on a plane through the origin, tilted so that it rises along x and y.

    Args:
        ground: The ground.
        angle_x: Angle of the plane's section along x, positive where it rises [rad].
        angle_y: The same along y [rad].

    Raises:
        DomainError: An angle is not between -45 and 45 degrees: contacts are found from above.
    """
    for name, angle in (("x", angle_x), ("y", angle_y)):
        if not abs(angle) <= np.pi / 4:
            raise DomainError(
                f"the slope along {name} is {np.degrees(angle):g} degrees; expected -45 to 45"
            )
    return ground._replace(slope_x=float(np.tan(angle_x)), slope_y=float(np.tan(angle_y)))


def beyond_grid(ground: Ground, x: Array, y: Array) -> Array:
    """Return whether places lie beyond the grid, shape as x.

    Args:
        ground: The ground; on one without a grid no place lies beyond.
        x: x of the places [m].
        y: y of the places [m].
    """
    m, n = ground.height.shape
    if ground.height.size == 1:
        return np.zeros(np.shape(x), dtype=bool)
    at_x, at_y = (x - ground.x) / ground.step, (y - ground.y) / ground.step
    return (at_x < 0) | (at_x > m - 1) | (at_y < 0) | (at_y > n - 1)


@compiled
def heights_on(ground: Ground, x: Array, y: Array) -> Array:
    """Compute the heights of the ground on a grid of places, shape (m, n) [m].

    Args:
        ground: The ground.
        x: x of the rows, shape (m,) [m].
        y: y of the columns, shape (n,) [m].
    """
    height = np.empty((len(x), len(y)))
    for i in range(len(x)):
        for j in range(len(y)):
            height[i, j] = height_and_slopes(ground, x[i], y[j])[0]
    return height


@inlined
def is_even(ground):
    """Return whether the ground is a plane, level or not.

    Args:
        ground: The ground.
    """
    return ground.height.size == 1


@inlined
def ground_at(ground, x, y):
    """Compute height and unit normal of the ground at a place.

    Beyond the grid height is that of the edge, and slope across the edge that of the plane alone.

    Args:
        ground: The ground.
        x: x of the place [m].
        y: y of the place [m].

    Returns:
        Height [m] and the normal's components nx, ny, nz [-].
    """
    h, sx, sy = height_and_slopes(ground, x, y)
    size = np.sqrt(1 + sx * sx + sy * sy)
    return h, -sx / size, -sy / size, 1 / size


@inlined
def height_and_slopes(ground, x, y):
    """Compute height of the ground at a place and its derivatives along x and y.

    Args:
        ground: The ground.
        x: x of the place [m].
        y: y of the place [m].

    Returns:
        Height [m], slope along x and slope along y [-].
    """
    h, sx, sy = _on_grid(ground, x, y)
    return h + ground.slope_x * x + ground.slope_y * y, sx + ground.slope_x, sy + ground.slope_y


@inlined
def _on_grid(ground, x, y):
    """Interpolate height [m] and slopes along x and y [-] on the grid, bilinearly."""
    height = ground.height
    if height.size == 1:
        return height[0, 0], 0.0, 0.0
    m, n = height.shape
    at_x, at_y = (x - ground.x) / ground.step, (y - ground.y) / ground.step
    fx = min(max(at_x, 0.0), m - 1.000001)  # within the last cell, for its far neighbours
    fy = min(max(at_y, 0.0), n - 1.000001)
    i, j = int(fx), int(fy)
    a, b = fx - i, fy - j
    h00, h10, h01, h11 = height[i, j], height[i + 1, j], height[i, j + 1], height[i + 1, j + 1]
    h = (1 - a) * ((1 - b) * h00 + b * h01) + a * ((1 - b) * h10 + b * h11)
    sx = ((1 - b) * (h10 - h00) + b * (h11 - h01)) / ground.step
    sy = ((1 - a) * (h01 - h00) + a * (h11 - h10)) / ground.step
    if at_x < 0 or at_x > m - 1:  # beyond the edge its height continues, with zero slope
        sx = 0.0
    if at_y < 0 or at_y > n - 1:
        sy = 0.0
    return h, sx, sy
