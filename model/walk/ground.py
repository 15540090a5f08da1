# SPDX-License-Identifier: MIT
"""The ground under a walk: flat, or a height function sampled on a grid."""

from collections.abc import Callable
from typing import NamedTuple

import numpy as np

from model.errors import DomainError
from model.slip.law import Array


class Ground(NamedTuple):
    """Heights on a square grid, with bilinear interpolation; constant if the grid has one height.

    It is a named tuple because numba accepts one directly.

    Attributes:
        x: Position of the grid's first row [m].
        y: Position of the grid's first column [m].
        step: Distance between neighbours [m].
        height: Heights, rows along x, columns along y, shape (m, n) [m].
        highest: The largest of them [m].
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
    """Sample a height function; beyond the area the height of its edge continues.

    Args:
        height: Height at x and y, arrays of one shape [m].
        x: First and last x; the last sample lies there, or less than a step beyond [m].
        y: First and last y [m].
        step: Distance between samples, well below a leg's radius [m].

    Raises:
        DomainError: The area is empty or a height is not finite.
    """
    if not (x[1] - x[0] > step > 0 and y[1] - y[0] > step):
        raise DomainError(f"ground from x {x} to y {y} in steps of {step:g} m has no area")
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
    first, last = ends
    return first + step * np.arange(np.ceil((last - first) / step - 1e-9) + 1)
