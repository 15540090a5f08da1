# SPDX-License-Identifier: MIT
"""Plot a predicted path: its band, errors against a track, roll and pitch beside an IMU's."""

from collections.abc import Mapping

import numpy as np
from matplotlib.figure import Figure

from model.arrays import Array
from model.metrics.path_errors import pose_errors
from model.path_draws import quantiles
from model.poses import Poses
from model.walk.ground import FLAT, Ground, is_level
from zebro_lab.plots import sheet
from zebro_lab.plots.walk_path import draw_ground

_LEVELS = (0.05, 0.25, 0.5, 0.75, 0.95)


@sheet.styled
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
    figure, above, panels = sheet.map_and_panels(title, simulated=True, height=5.6, names=names)
    sheet.draw_band(above, paths, label="draws", lw=0.6, alpha=0.2)
    bands = quantiles(paths, _LEVELS) * [1.0, 1.0, 180 / np.pi]
    above.plot(*bands[2, :, :2].T, color="black", lw=1.2)
    if not is_level(ground):
        low, high = paths.position.min(axis=(0, 1)), paths.position.max(axis=(0, 1))
        beyond = 0.6 * float(max(high - low))  # axes of one scale show more than the paths
        draw_ground(above, ground, low - beyond, high + beyond)
    for axes, (low, lower, median, upper, high) in zip(
        panels, bands.transpose(2, 0, 1), strict=True
    ):
        axes.fill_between(paths.t, low, high, color=sheet.tint(0.2), lw=0, label="90 % of draws")
        axes.fill_between(paths.t, lower, upper, color=sheet.tint(0.5), lw=0, label="50 % of draws")
        axes.plot(paths.t, median, color="black", lw=1.0, label="median")
    sheet.legend_below(figure, columns=4)
    return figure


_MOST_DOTS = 200  # of a track; of more poses the dots would hide the paths


@sheet.styled
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
        track's direction of travel, in metres if one is over a metre, else in millimetres; errors
        of yaw in degrees.

    Raises:
        DomainError: A tracked time lies outside the times of a path.
    """
    moving = {name: path for name, path in paths.items() if np.ptp(path.position, axis=0).any()}
    errors = {name: pose_errors(path.at(track.t), track) for name, path in moving.items()}
    far = max((np.abs(each.translation).max() for each in errors.values()), default=0.0)
    scale, unit = (1.0, "m") if far > 1 else (1e3, "mm")
    figure, above, panels = sheet.map_and_panels(
        f"{of}: {title}", simulated=simulated, height=5.8,
        names=(f"ahead [{unit}]", f"to the left [{unit}]", "yaw [deg]"),
    )  # fmt: skip
    sheet.draw_band(above, band, label="draws of the prediction", lw=0.5, alpha=0.15)
    dots = {"marker": ".", "ms": 3} if len(track) <= _MOST_DOTS else {}
    for (name, path), colour in zip(moving.items(), sheet.CYCLE, strict=False):
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
    sheet.legend_below(figure, columns=6)
    return figure


_SHOWN = 6.0  # s: longer, and the strides run into each other


@sheet.styled
def tilt(t: Array, predicted: Array, measured: Array, *, title: str, simulated: bool) -> Figure:
    """Draw predicted and measured roll and pitch [deg] over the middle 6 s of a walk.

    Args:
        t: Times, increasing, shape (n,) [s].
        predicted: Predicted roll and pitch, shape (n, 2) [rad].
        measured: Measured roll and pitch, shape (n, 2) [rad].
        title: Name of the walk.
        simulated: Whether to append "(simulated)" to the title.

    Returns:
        The figure; the IMU's bias is not removed.
    """
    figure = sheet.new_figure(f"Roll and pitch: {title}", simulated, width=8.5, height=4.6)
    middle = 0.5 * (t[0] + t[-1])
    shown = np.abs(t - middle) <= _SHOWN / 2
    names = ("roll [deg]\n(left side up)", "pitch [deg]\n(nose down)")
    panels = figure.subplots(2, 1, sharex=True)
    for axes, name, expected, seen in zip(panels, names, predicted.T, measured.T, strict=True):
        axes.plot(t[shown], np.degrees(seen[shown]), color="0.6", lw=0.9, label="IMU")
        axes.plot(
            t[shown], np.degrees(expected[shown]), color=sheet.BLUE, lw=1.2, label="predicted"
        )
        axes.set_ylabel(name)
        axes.grid(color="0.92", lw=0.6)
    part = "" if shown.all() else f", the middle {_SHOWN:g} s of the walk"
    panels[-1].set_xlabel(f"time [s]{part}")
    figure.align_ylabels(panels)
    sheet.legend_below(figure, columns=2)
    return figure
