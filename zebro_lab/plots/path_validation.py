# SPDX-License-Identifier: MIT
"""A predicted path beside the tracked one, with the baselines."""

from collections.abc import Mapping

import numpy as np
from matplotlib.figure import Figure

from model.metrics.path_errors import pose_errors
from model.poses import Poses
from zebro_lab.plots.sheet import CYCLE, legend_below, new_figure, styled

_SHOWN_DRAWS = 60
_BAND = "#0072B2"


@styled
def path_validation(
    paths: Mapping[str, Poses],
    track: Poses,
    *,
    band: Poses | None,
    title: str,
    simulated: bool,
) -> Figure:
    """Draw paths and track from above, and errors along, across and of yaw over time.

    Args:
        paths: The prediction and the baselines, by name, all in the track's frame.
        track: The tracked poses.
        band: The prediction's draws, in the same frame; None without draws.
        title: Name of the walk.
        simulated: Whether to append "(simulated)" to the title.

    Returns:
        The figure.
    """
    figure = new_figure(f"Prediction and track: {title}", simulated, width=9.0, height=5.8)
    grid = figure.add_gridspec(3, 2, width_ratios=(1.2, 1.0))
    above = figure.add_subplot(grid[:, 0])
    if band is not None:
        for position in band.position[:_SHOWN_DRAWS]:
            above.plot(*position.T, color=_BAND, lw=0.5, alpha=0.15)
    panels = [figure.add_subplot(grid[i, 1]) for i in range(3)]
    moving = {name: path for name, path in paths.items() if path.length > 0}
    for (name, path), colour in zip(moving.items(), CYCLE, strict=False):
        above.plot(*path.position.T, color=colour, lw=1.2, label=name)
        errors = pose_errors(path.at(track.t), track)
        values = (1000 * errors.along, 1000 * errors.cross, np.degrees(errors.rotation))
        for axes, value in zip(panels, values, strict=True):
            axes.plot(track.t, value, color=colour, lw=1.0, marker=".", ms=3, label=name)
    above.plot(*track.position.T, ls="none", marker="o", ms=4, color="black", label="track")
    above.set(xlabel="x [m]", ylabel="y [m]", aspect="equal")
    above.set_adjustable("datalim")
    above.grid(color="0.92", lw=0.6)
    names = ("ahead [mm]", "to the left [mm]", "yaw [deg]")
    for axes, name in zip(panels, names, strict=True):
        axes.set_ylabel(name)
        axes.axhline(0, color="0.5", lw=0.6)
        axes.grid(color="0.92", lw=0.6)
    panels[0].set_title("error: predicted minus tracked", loc="left")
    panels[-1].set_xlabel("time [s]")
    legend_below(figure, columns=5)
    return figure
