# SPDX-License-Identifier: MIT
"""Plot a predicted path with its track and the baselines, and their errors over time."""

from collections.abc import Mapping

import numpy as np
from matplotlib.figure import Figure

from model.metrics.path_errors import pose_errors
from model.poses import Poses
from zebro_lab.plots.sheet import BLUE, CYCLE, draw_band, legend_below, map_and_panels, styled

_MOST_DOTS = 200  # of a track; of more poses the dots would hide the paths


@styled
def path_validation(
    paths: Mapping[str, Poses],
    track: Poses,
    *,
    band: Poses | None,
    title: str,
    simulated: bool,
    of: str = "Prediction and track",
    plane: str = "xy",
    timed: bool = True,
) -> Figure:
    """Draw paths and track from above, and errors ahead, to the left and of yaw over time.

    Args:
        paths: Prediction and baselines by name, in the track's frame and covering its times; at
            most eight are drawn, none that stands still.
        track: Tracked poses.
        band: Draws of the prediction, of which 60 are drawn, in the same frame; None without draws.
        title: Name of the walk.
        simulated: Whether to append "(simulated)" to the title.
        of: What paths and track are; begins the title, its last word names the track.
        plane: Names of the axes.
        timed: Whether poses have times, else numbers.

    Returns:
        The figure; errors are those of the paths against the track, ahead and to the left of the
        track's direction of travel, in metres if one is over a metre, else in millimetres [deg].

    Raises:
        DomainError: A tracked time lies outside the times of a path.
    """
    moving = {name: path for name, path in paths.items() if np.ptp(path.position, axis=0).any()}
    errors = {name: pose_errors(path.at(track.t), track) for name, path in moving.items()}
    far = max((np.abs(each.translation).max() for each in errors.values()), default=0.0)
    scale, unit = (1.0, "m") if far > 1 else (1e3, "mm")
    figure, above, panels = map_and_panels(
        f"{of}: {title}", simulated=simulated, height=5.8,
        names=(f"ahead [{unit}]", f"to the left [{unit}]", "yaw [deg]"),
    )  # fmt: skip
    draw_band(above, band, label="draws of the prediction", color=BLUE, lw=0.5, alpha=0.15)
    dots = {"marker": ".", "ms": 3} if len(track) <= _MOST_DOTS else {}
    for (name, path), colour in zip(moving.items(), CYCLE, strict=False):
        above.plot(*path.position.T, color=colour, lw=1.2, label=name)
        each = errors[name]
        values = (scale * each.along, scale * each.cross, np.degrees(each.rotation))
        for axes, value in zip(panels, values, strict=True):
            axes.plot(track.t, value, color=colour, lw=1.0, label=name, **dots)
    tracked = {"ls": "none", "marker": "o", "ms": 4} if dots else {"lw": 1.2, "ls": "--"}
    above.plot(*track.position.T, color="black", label=of.split()[-1], **tracked)
    above.set(xlabel=f"{plane[0]} [m]", ylabel=f"{plane[1]} [m]")
    for axes in panels:
        axes.axhline(0, color="0.5", lw=0.6)
    panels[0].set_title(f"error: {of.split()[0].lower()} minus {of.split()[-1]}", loc="left")
    panels[-1].set_xlabel("time [s]" if timed else "number of the pose")
    legend_below(figure, columns=6)
    return figure
