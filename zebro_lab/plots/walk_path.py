# SPDX-License-Identifier: MIT
"""Plot a walk: path from above with snapshots, position and orientation of the body over time."""

from collections.abc import Sequence

import numpy as np
from matplotlib import colormaps
from matplotlib.figure import Figure
from matplotlib.ticker import MaxNLocator

from model.robot import Robot
from model.slip.law import Array
from model.walk.path import WalkPath
from zebro_lab.plots.sheet import BLUE, new_figure, styled
from zebro_lab.plots.walk_robot import outline, to_world

_SNAPSHOTS = 6
_LONGEST_SIDE = 8.5  # inches
_NARROWEST, _LOWEST = 7.0, 3.4  # inches, for the title and for the axis labels
_MARGIN = 0.25  # of the body's length, around everything


@styled
def path_with_snapshots(path: WalkPath, robot: Robot, *, title: str) -> Figure:
    """Draw the path of the body's centre from above, with the body at six times (Fig. 5-11).

    Args:
        path: The walk.
        robot: The robot, for the size of its body.
        title: Title of the figure, which names the model; "(simulated)" is appended.

    Returns:
        The figure, x to the right and y up, both to one scale; the six times are evenly spaced from
        start to end. Dots along the path are at whole seconds, in walks of 2 s to a minute.
    """
    t = path.t
    shots = np.abs(t[:, None] - np.linspace(t[0], t[-1], _SNAPSHOTS)).argmin(axis=0)
    bodies = [_body(path, robot, int(shot)) for shot in shots]
    low, high = _extent(path, bodies, robot)
    width, height = _sides(high - low)
    figure = new_figure(title, True, width=width, height=height)
    axes = figure.add_subplot()
    colours = colormaps["viridis"](np.linspace(0, 0.9, len(shots)))
    for shot, body, colour in zip(shots, bodies, colours, strict=True):
        axes.fill(*body[:, :2].T, facecolor=colour, alpha=0.18, lw=0, zorder=1)
        axes.plot(*body[:, :2].T, color=colour, lw=1.2, zorder=2, label=f"t = {t[shot]:.3g} s")
    axes.plot(*path.position[:, :2].T, color="black", lw=1.2, zorder=3)
    if 2 <= t[-1] - t[0] <= 60:
        seconds = np.interp(np.arange(np.ceil(t[0]), t[-1] + 1e-9), t, np.arange(len(t)))
        dots = path.position[seconds.round().astype(int), :2]
        axes.plot(*dots.T, ls="none", marker="o", ms=2.4, color="black", zorder=3, label="seconds")
    axes.set(
        xlabel="x [m]", ylabel="y [m]", aspect="equal",
        xlim=(low[0], high[0]), ylim=(low[1], high[1]),
    )  # fmt: skip
    axes.grid(color="0.92", lw=0.6)
    axes.set_axisbelow(True)
    figure.legend(loc="outside lower center", ncols=min(len(shots) + 1, 7))
    return figure


@styled
def motion(path: WalkPath, *, title: str) -> Figure:
    """Draw position, velocity and acceleration of the body's centre over time (Fig. 5-2, 5-7).

    Args:
        path: The walk.
        title: Title of the figure, which names the model; "(simulated)" is appended.

    Returns:
        The figure: a column for each of x, y, z in the inertial frame. Velocity and acceleration
        are differences of the positions; where the tips of impacts would flatten all else, they are
        cut off there.
    """
    names = ("x", "y", "z")
    units = ("position [m]", "velocity [m/s]", "acceleration [m/s²]")
    return _over_time(path.t, path.position, names, units, title)


@styled
def orientation(path: WalkPath, *, title: str) -> Figure:
    """Draw roll, pitch and yaw with their rates and accelerations over time (Fig. 5-7, 5-23).

    Args:
        path: The walk.
        title: Title of the figure, which names the model; "(simulated)" is appended.

    Returns:
        The figure: a column for each angle, in degrees. Rates and accelerations are differences of
        the angles; where the tips of impacts would flatten all else, they are cut off there.
    """
    names = ("roll (left side up)", "pitch (nose down)", "yaw (to the left)")
    units = ("angle [deg]", "rate [deg/s]", "acceleration [deg/s²]")
    angles = np.degrees(path.orientation)
    return _over_time(path.t, angles, names, units, title)


def _over_time(
    t: Array, values: Array, names: Sequence[str], units: Sequence[str], title: str
) -> Figure:
    """Draw the columns of `values`, shape (n, 3), over time, below them their two derivatives.

    `units` are the labels of the rows: values, first and second derivative.
    """
    figure = new_figure(title, True, width=8.5, height=6.0)
    panels = figure.subplots(3, 3, sharex=True)
    rows = [values]
    for _ in range(2):
        rows.append(np.gradient(rows[-1], t, axis=0) if len(t) > 1 else np.zeros_like(values))
    for row, (each, unit) in enumerate(zip(rows, units, strict=True)):
        for column, name in enumerate(names):
            axes = panels[row, column]
            axes.plot(t, each[:, column], color=BLUE, lw=0.9)
            axes.yaxis.set_major_locator(MaxNLocator(5))
            axes.grid(color="0.92", lw=0.6)
            if row == 0:
                axes.set_title(name, loc="left")
            else:
                axes.set_ylim(_mostly(each[:, column]))
        panels[row, 0].set_ylabel(unit)
    for axes in panels[-1]:
        axes.set_xlabel("time [s]")
        axes.xaxis.set_major_locator(MaxNLocator(6))
        axes.set_xlim(t[0], t[-1])
    figure.align_ylabels(panels[:, 0])
    return figure


def _mostly(values: Array) -> tuple[float, float]:
    """Compute limits: 1 and 99 % quantile with 30 % of their range as margin on both sides."""
    low, high = np.quantile(values, (0.01, 0.99))
    margin = 0.3 * (high - low) or 1e-6
    return float(low - margin), float(high + margin)


def _body(path: WalkPath, robot: Robot, index: int) -> Array:
    return to_world(outline(robot), path.position[index], path.orientation[index])


def _extent(path: WalkPath, bodies: Sequence[Array], robot: Robot) -> tuple[Array, Array]:
    points = np.vstack([path.position[:, :2], *(body[:, :2] for body in bodies)])
    margin = _MARGIN * robot.body_size[0]
    return points.min(axis=0) - margin, points.max(axis=0) + margin


def _sides(extent: Array) -> tuple[float, float]:
    """Compute width and height [inch] of a figure with axes about of the shape of `extent` [m].

    The axes are 2 to 7.5 inches each way, the figure at least 7.0 by 3.4 inches.
    """
    scale = (_LONGEST_SIDE - 1.0) / float(max(extent[0], extent[1]))
    width, height = (float(np.clip(scale * side, 2.0, 7.5)) for side in extent)
    return max(width + 1.0, _NARROWEST), max(height + 1.3, _LOWEST)
