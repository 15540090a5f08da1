# SPDX-License-Identifier: MIT
"""Plot the band of a predicted path, from above and over time."""

import numpy as np
from matplotlib.figure import Figure

from model.path_draws import quantiles
from model.poses import Poses
from model.walk.ground import FLAT, Ground, is_level
from zebro_lab.plots.ground import draw_ground
from zebro_lab.plots.sheet import BLUE, draw_band, legend_below, map_and_panels, styled, tint

_LEVELS = (0.05, 0.25, 0.5, 0.75, 0.95)


@styled
def path_band(paths: Poses, *, title: str, ground: Ground = FLAT) -> Figure:
    """Draw a predicted path's band from above, and quantiles of x, y and yaw over time.

    Args:
        paths: Draws of the predicted path.
        title: Title of the figure; "(simulated)" is appended.
        ground: The ground, drawn below the paths as `draw_ground` does.

    Returns:
        The figure: the first 60 draws and the median of all from above; over time the median and
        the central 50 and 90 % of the draws.
    """
    names = ("x [m]", "y [m]", "yaw [deg]")
    figure, above, panels = map_and_panels(title, simulated=True, height=5.6, names=names)
    draw_band(above, paths, label="draws", color=BLUE, lw=0.6, alpha=0.2)
    bands = quantiles(paths, _LEVELS) * [1.0, 1.0, 180 / np.pi]
    above.plot(*bands[2, :, :2].T, color="black", lw=1.2)
    if not is_level(ground):
        low, high = paths.position.min(axis=(0, 1)), paths.position.max(axis=(0, 1))
        beyond = 0.6 * float(max(high - low))  # axes of one scale show more than the paths
        draw_ground(above, ground, low - beyond, high + beyond)
    for axes, (low, lower, median, upper, high) in zip(
        panels, bands.transpose(2, 0, 1), strict=True
    ):
        axes.fill_between(paths.t, low, high, color=tint(0.2), lw=0, label="90 % of draws")
        axes.fill_between(paths.t, lower, upper, color=tint(0.5), lw=0, label="50 % of draws")
        axes.plot(paths.t, median, color="black", lw=1.0, label="median")
    legend_below(figure, columns=4)
    return figure
