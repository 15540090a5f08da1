# SPDX-License-Identifier: MIT
"""Grounds of walks from functions of height."""

from collections.abc import Callable

import numpy as np

from model.arrays import Array
from model.walk.ground import Ground


def sample_ground(
    height: Callable[[Array, Array], Array],
    *,
    x: tuple[float, float],
    y: tuple[float, float],
    step: float = 0.005,
) -> Ground:
    """Sample a height function on a grid from first to last x and y [m]."""
    places = [first + step * np.arange(np.ceil((last - first) / step - 1e-9) + 1)
              for first, last in (x, y)]  # fmt: skip
    heights = np.asarray(height(*np.meshgrid(*places, indexing="ij")), dtype=float)
    return Ground(x[0], y[0], step, heights, float(heights.max()))
