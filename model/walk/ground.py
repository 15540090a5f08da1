# SPDX-License-Identifier: MIT
"""The ground under a walk: flat, or a height function sampled on a grid."""

from collections.abc import Callable
from typing import NamedTuple

import numpy as np

from model.compiled import inlined
from model.errors import DomainError
from model.slip.law import Array


class Ground(NamedTuple):
    """Heights on a square grid, with bilinear interpolation; constant if the grid has one height.

    Beyond the grid the height of its edge continues. It is a named tuple because numba accepts one
    directly.

    Attributes:
        x: Position of the grid's first row [m].
        y: Position of the grid's first column [m].
        step: Distance between neighbours [m].
        height: Heights, rows along x, columns along y, shape (m, n) [m].
        highest: The largest of the heights [m].
    """

    x: float
    y: float
    step: float
    height: Array
    highest: float


FLAT = Ground(0.0, 0.0, 1.0, np.zeros((1, 1)), 0.0)


def sample_ground(
    height: Callable[[Array, Array], Array],
    *,
    x: tuple[float, float],
    y: tuple[float, float],
    step: float = 0.005,
) -> Ground:
    """Sample a height function on a grid; beyond the area the height of its edge continues.

    Args:
        height: Function from arrays x and y [m] of one shape to heights of that shape [m].
        x: First and last x; the last sample lies there, or less than a step beyond [m].
        y: First and last y, likewise [m].
        step: Distance between samples, well below a leg's radius [m].

    Raises:
        DomainError: The area is no wider than a step, the step is not positive, or the heights have
            another shape than the positions or are not finite.
    """
    if not (x[1] - x[0] > step > 0 and y[1] - y[0] > step):
        raise DomainError(f"ground x {x}, y {y} is not wider than a positive step, {step:g} m")
    grid = np.meshgrid(_samples(x, step), _samples(y, step), indexing="ij")
    heights = np.asarray(height(*grid), dtype=float)
    if heights.shape != grid[0].shape:
        raise DomainError(
            f"the height function gave shape {heights.shape} for positions of shape "
            f"{grid[0].shape}; expected one height for each position"
        )
    if not np.isfinite(heights).all():
        i, j = np.argwhere(~np.isfinite(heights))[0]
        raise DomainError(
            f"the ground's height is {heights[i, j]:g} m at x {grid[0][i, j]:g}, "
            f"y {grid[1][i, j]:g} m; expected a finite one"
        )
    return Ground(float(x[0]), float(y[0]), step, heights, float(heights.max()))


def _samples(ends: tuple[float, float], step: float) -> Array:
    """Return positions from the first end in equal steps to the last end or just beyond [m]."""
    first, last = ends
    return first + step * np.arange(np.ceil((last - first) / step - 1e-9) + 1)


@inlined
def ground_at(ground, x, y):
    """Interpolate height and unit normal of the ground at a place, bilinearly.

    Beyond the grid height is that of the edge, and slope across the edge zero.

    Args:
        ground: The ground.
        x: x of the place [m].
        y: y of the place [m].

    Returns:
        Height [m] and the normal's components nx, ny, nz [-].
    """
    height = ground.height
    if height.size == 1:
        return height[0, 0], 0.0, 0.0, 1.0
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
    size = np.sqrt(1 + sx * sx + sy * sy)
    return h, -sx / size, -sy / size, 1 / size


@inlined
def plane_under(ground, x, y, reach):
    """Compute the unit normal of the mean plane of the ground within reach of a place.

    A leg stands on what its arc spans. The normal at a single point would tilt the leg at every
    edge of the ground.

    Args:
        ground: The ground.
        x: x of the place [m].
        y: y of the place [m].
        reach: Distance to either side over which slopes are taken [m].

    Returns:
        Components nx, ny, nz of the normal [-].
    """
    if ground.height.size == 1:
        return 0.0, 0.0, 1.0
    sx = ground_at(ground, x + reach, y)[0] - ground_at(ground, x - reach, y)[0]
    sy = ground_at(ground, x, y + reach)[0] - ground_at(ground, x, y - reach)[0]
    sx, sy = sx / (2 * reach), sy / (2 * reach)
    size = np.sqrt(1 + sx * sx + sy * sy)
    return -sx / size, -sy / size, 1 / size
