# SPDX-License-Identifier: MIT
"""Plot a predicted path with its track and the baselines, and their errors over time."""

from collections.abc import Mapping

import numpy as np
from matplotlib.figure import Figure

from model.metrics.path_errors import pose_errors
from model.poses import Poses
from zebro_lab.plots.sheet import BLUE, CYCLE, draw_band, legend_below, map_and_panels, styled

_PANELS = ("ahead [mm]", "to the left [mm]", "yaw [deg]")


@styled
def path_validation(
    paths: Mapping[str, Poses],
    track: Poses,
    *,
    band: Poses | None,
    title: str,
    simulated: bool,
) -> Figure:
    """Draw paths and track from above, and errors ahead, to the left and of yaw over time.

    Args:
        paths: Prediction and baselines by name, in the track's frame and covering its times; at
            most eight are drawn, none that stands still.
        track: Tracked poses.
        band: Draws of the prediction, of which 60 are drawn, in the same frame; None without draws.
        title: Name of the walk.
        simulated: Whether to append "(simulated)" to the title.

    Returns:
        The figure; errors are predicted minus tracked, ahead and to the left of the track's
        direction of travel [mm, mm, deg].

    Raises:
        DomainError: A tracked time lies outside the times of a path.
    """
    figure, above, panels = map_and_panels(
        f"Prediction and track: {title}", simulated=simulated, height=5.8, names=_PANELS
    )
    draw_band(above, band, label="draws of the prediction", color=BLUE, lw=0.5, alpha=0.15)
    moving = {name: path for name, path in paths.items() if np.ptp(path.position, axis=0).any()}
    for (name, path), colour in zip(moving.items(), CYCLE, strict=False):
        above.plot(*path.position.T, color=colour, lw=1.2, label=name)
        errors = pose_errors(path.at(track.t), track)
        values = (1000 * errors.along, 1000 * errors.cross, np.degrees(errors.rotation))
        for axes, value in zip(panels, values, strict=True):
            axes.plot(track.t, value, color=colour, lw=1.0, marker=".", ms=3, label=name)
    above.plot(*track.position.T, ls="none", marker="o", ms=4, color="black", label="track")
    for axes in panels:
        axes.axhline(0, color="0.5", lw=0.6)
    panels[0].set_title("error: predicted minus tracked", loc="left")
    legend_below(figure, columns=6)
    return figure
