# SPDX-License-Identifier: MIT
"""Draw the ground of a walk on a map: heights shaded, with contours."""

import numpy as np
from matplotlib.axes import Axes
from matplotlib.colors import LinearSegmentedColormap

from model.arrays import Array
from model.walk.ground import Ground, heights_on, is_level

_SAMPLES = 400  # along the longer side
_LEVELS = 8
_SHADES = LinearSegmentedColormap.from_list("ground", ["#f7f3ea", "#d9c39a", "#9c7b48"])


def draw_ground(axes: Axes, ground: Ground, low: Array, high: Array) -> None:
    """Draw heights of the ground on a map, below all else; nothing of level ground.

    Limits of the axes are kept. Heights have a colour bar in millimetres.

    Args:
        axes: The map, x to the right and y up [m].
        ground: The ground.
        low: Smallest x and y to draw, shape (2,) [m].
        high: Largest x and y to draw, shape (2,) [m].
    """
    if is_level(ground):
        return
    limits = axes.get_xlim(), axes.get_ylim()
    step = float(max(high - low)) / _SAMPLES
    x, y = (np.arange(first, last + step, step) for first, last in zip(low, high, strict=True))
    height = 1000 * heights_on(ground, x, y).T
    edges = (x[0] - step / 2, x[-1] + step / 2, y[0] - step / 2, y[-1] + step / 2)
    shading = axes.imshow(
        height, origin="lower", extent=edges, cmap=_SHADES, aspect="equal", zorder=-2,
        interpolation="bilinear",
    )  # fmt: skip
    if np.ptp(height) > 0:
        axes.contour(x, y, height, levels=_LEVELS, colors="0.45", linewidths=0.4, zorder=-1)
    bar = axes.figure.colorbar(shading, ax=axes, fraction=0.03, pad=0.02, aspect=25)
    bar.set_label("height of the ground [mm]")
    axes.set(xlim=limits[0], ylim=limits[1])
