# SPDX-License-Identifier: MIT
"""Plot the band of a predicted path, from above and over time, with an optional track."""

import numpy as np
from matplotlib.figure import Figure

from model.path_draws import quantiles
from model.poses import Poses
from zebro_lab.plots.sheet import BLUE, RED, legend_below, new_figure, styled

_SHOWN_DRAWS = 60
_LEVELS = (0.05, 0.25, 0.5, 0.75, 0.95)


@styled
def path_band(paths: Poses, *, title: str, simulated: bool, track: Poses | None = None) -> Figure:
    """Draw the draws of a path from above, and quantiles of x, y and yaw over time.

    Args:
        paths: The draws.
        title: Title of the figure.
        simulated: Whether to append "(simulated)" to the title.
        track: Tracked poses in the same time base and frame.

    Returns:
        The figure; bands hold 50 and 90 % of the draws at each time.
    """
    figure = new_figure(title, simulated, width=9.0, height=5.6)
    grid = figure.add_gridspec(3, 2, width_ratios=(1.2, 1.0))
    above = figure.add_subplot(grid[:, 0])
    for position in paths.position[:_SHOWN_DRAWS]:
        above.plot(*position.T, color=BLUE, lw=0.6, alpha=0.2)
    low, q25, median, q75, high = quantiles(paths, _LEVELS)
    above.plot(median[:, 0], median[:, 1], color="black", lw=1.2)
    above.set(xlabel="x [m]", ylabel="y [m]", aspect="equal")
    above.set_adjustable("datalim")
    above.grid(color="0.92", lw=0.6)
    scale = np.array([1.0, 1.0, 180 / np.pi])
    panels = [figure.add_subplot(grid[i, 1]) for i in range(3)]
    names = ("x [m]", "y [m]", "yaw [deg]")
    for i, (axes, name) in enumerate(zip(panels, names, strict=True)):
        axes.fill_between(
            paths.t, low[:, i] * scale[i], high[:, i] * scale[i], color=BLUE, alpha=0.2, lw=0,
            label="90 %",
        )  # fmt: skip
        axes.fill_between(
            paths.t, q25[:, i] * scale[i], q75[:, i] * scale[i], color=BLUE, alpha=0.35, lw=0,
            label="50 %",
        )  # fmt: skip
        axes.plot(paths.t, median[:, i] * scale[i], color="black", lw=1.0, label="median")
        if track is not None:
            seen = track.states[:, i] * scale[i]
            axes.plot(track.t, seen, ls="none", marker="o", ms=3, color=RED, label="track")
        axes.set_ylabel(name)
        axes.grid(color="0.92", lw=0.6)
    panels[-1].set_xlabel("time [s]")
    if track is not None:
        above.plot(*track.position.T, ls="none", marker="o", ms=3, color=RED, label="track")
    legend_below(figure, columns=4)
    return figure
