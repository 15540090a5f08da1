# SPDX-License-Identifier: MIT
"""Plot a walk: path from above with snapshots, position and orientation of the body over time."""

from collections.abc import Mapping, Sequence

import numpy as np
from matplotlib import colormaps
from matplotlib.figure import Figure

from model.arrays import Array
from model.robot import Robot
from model.walk.ground import FLAT, Ground
from model.walk.path import WalkPath
from zebro_lab.plots.beyond import limits_without_tips
from zebro_lab.plots.ground import draw_ground
from zebro_lab.plots.sheet import (
    BLUE,
    few_ticks,
    legend_below,
    new_figure,
    styled,
    time_axis,
    time_texts,
)
from zebro_lab.plots.walk_robot import outline, to_world

_SNAPSHOTS = 6
_LONGEST_SIDE = 8.5  # inches
_NARROWEST, _LOWEST = 7.0, 2.6  # inches, for the title and for the axis labels
_WINDOW = 0.1  # s over which velocities are means: impacts take a hundredth of that
_MEAN = f"mean of {_WINDOW:g} s"
_TWICE = f"mean of that in {_WINDOW:g} s"
_MARGIN = 0.25  # of the body's length, around everything


@styled
def path_with_snapshots(
    path: WalkPath,
    robot: Robot,
    *,
    title: str,
    at: Sequence[float] = (),
    ground: Ground = FLAT,
) -> Figure:
    """Draw the path of the body's centre from above, with the body at some times (Fig. 5-11).

    Args:
        path: The walk.
        robot: The robot, for the size of its body.
        title: Title of the figure, which names the model; "(simulated)" is appended.
        at: Times at which the body is drawn [s]; empty for six, evenly spaced from start to end.
        ground: The ground, whose heights are shaded.

    Returns:
        The figure, x to the right and y up, both to one scale. Dots along the path are at whole
        seconds, in walks of 2 s to a minute.
    """
    t = path.t
    wanted = snapshot_times(t, at)
    shots = np.abs(t[:, None] - wanted).argmin(axis=0)
    bodies = [_body(path, robot, int(shot)) for shot in shots]
    low, high = _extent(path, bodies, robot)
    width, height = _sides(high - low)
    figure = new_figure(title, True, width=width, height=height)
    axes = figure.add_subplot()
    colours = colormaps["viridis"](np.linspace(0, 0.9, len(shots)))
    for when, body, colour in zip(time_texts(wanted), bodies, colours, strict=True):
        axes.fill(*body[:, :2].T, facecolor=colour, alpha=0.18, lw=0, zorder=1)
        axes.plot(*body[:, :2].T, color=colour, lw=1.2, zorder=2, label=f"t = {when} s")
    axes.plot(*path.position[:, :2].T, color="black", lw=1.2, zorder=3, label="body's centre")
    if 2 <= t[-1] - t[0] <= 60:
        seconds = np.interp(np.arange(np.ceil(t[0]), t[-1] + 1e-9), t, np.arange(len(t)))
        dots = path.position[seconds.round().astype(int), :2]
        axes.plot(*dots.T, ls="none", marker="o", ms=2.4, color="black", zorder=3,
                  label="whole seconds")  # fmt: skip
    axes.set(
        xlabel="x [m]", ylabel="y [m]", aspect="equal",
        xlim=(low[0], high[0]), ylim=(low[1], high[1]),
    )  # fmt: skip
    draw_ground(axes, ground, low, high)
    axes.grid(color="0.92", lw=0.6)
    axes.set_axisbelow(True)
    legend_below(figure, columns=8)
    return figure


def snapshot_times(t: Array, at: Sequence[float]) -> Array:
    """Return the times to draw the robot at: those asked for, else six from start to end [s].

    Args:
        t: Times of the walk, shape (n,) [s].
        at: Times asked for; empty for none [s].
    """
    return np.asarray(at, dtype=float) if len(at) else np.linspace(t[0], t[-1], _SNAPSHOTS)


@styled
def motion(path: WalkPath, *, title: str) -> Figure:
    """Draw position, velocity and acceleration of the body's centre over time (Fig. 5-2, 5-7).

    Args:
        path: The walk.
        title: Title of the figure, which names the model; "(simulated)" is appended.

    Returns:
        The figure: a column for each of x, y, z in the inertial frame. Velocity and acceleration
        are means, see `mean_rate`: the peaks of impacts would flatten all else.
    """
    names = ("x", "y", "z")
    units = {"position [m]": 0.002, f"velocity [m/s],\n{_MEAN}": 0.01,
             f"acceleration [m/s²],\n{_TWICE}": 0.1}  # fmt: skip
    return _over_time(path.t, path.position, names, units, title)


@styled
def orientation(path: WalkPath, *, title: str) -> Figure:
    """Draw roll, pitch and yaw with their rates and accelerations over time (Fig. 5-7, 5-23).

    Args:
        path: The walk.
        title: Title of the figure, which names the model; "(simulated)" is appended.

    Returns:
        The figure: a column for each angle, in degrees. Rates and accelerations are means, see
        `mean_rate`: the peaks of impacts would flatten all else.
    """
    names = ("roll (left side up)", "pitch (nose down)", "yaw (to the left)")
    units = {"angle [deg]": 0.1, f"rate [deg/s],\n{_MEAN}": 1.0,
             f"acceleration [deg/s²],\n{_TWICE}": 10.0}  # fmt: skip
    angles = np.degrees(path.orientation)
    return _over_time(path.t, angles, names, units, title)


def _over_time(
    t: Array, values: Array, names: Sequence[str], units: Mapping[str, float], title: str
) -> Figure:
    """Draw the columns of `values`, shape (n, 3), over time, below them their two derivatives.

    `units` are the labels of the rows, values, first and second derivative, with the least range of
    their axes: what the solver leaves of a quantity that is zero is not blown up.
    """
    figure = new_figure(title, True, width=8.5, height=6.2)
    panels = figure.subplots(3, 3, sharex=True)
    rows = [values]
    for _ in range(2):
        rows.append(mean_rate(t, rows[-1]))
    for row, (each, (unit, least)) in enumerate(zip(rows, units.items(), strict=True)):
        for axes, column in zip(panels[row], each.T, strict=True):
            axes.plot(t, column, color=BLUE, lw=0.9)
            axes.set_ylim(limits_without_tips(column, cut=0.0, margin=0.05, least=least))
            axes.yaxis.set_major_locator(few_ticks(5))
            axes.grid(color="0.92", lw=0.6)
        panels[row, 0].set_ylabel(unit)
    for top, bottom, name in zip(panels[0], panels[-1], names, strict=True):
        top.set_title(name, loc="left")
        time_axis(bottom, t)
    figure.align_ylabels(panels[:, 0])
    return figure


def mean_rate(t: Array, values: Array) -> Array:
    """Compute the mean derivative of values over 0.1 s around each time, shape (n, k) [1/s].

    It is the difference between the values 0.05 s later and earlier over the time between, in the
    first and last 0.05 s over the time that there is; 0 for a single time.

    Args:
        t: Times, increasing, shape (n,) [s].
        values: Values, shape (n, k).
    """
    ends = [np.clip(t + half, t[0], t[-1]) for half in (-_WINDOW / 2, _WINDOW / 2)]
    early, late = (np.column_stack([np.interp(end, t, each) for each in values.T]) for end in ends)
    time = np.where(len(t) > 1, ends[1] - ends[0], 1.0)
    return (late - early) / time[:, None]


def _body(path: WalkPath, robot: Robot, index: int) -> Array:
    return to_world(outline(robot), path.position[index], path.orientation[index])


def _extent(path: WalkPath, bodies: Sequence[Array], robot: Robot) -> tuple[Array, Array]:
    points = np.vstack([path.position[:, :2], *(body[:, :2] for body in bodies)])
    margin = _MARGIN * robot.body_size[0]
    return points.min(axis=0) - margin, points.max(axis=0) + margin


def _sides(extent: Array) -> tuple[float, float]:
    """Compute width and height [inch] of a figure with axes about of the shape of `extent` [m].

    The axes are 1 to 7.5 inches each way, the figure at least 7.0 by 2.6 inches.
    """
    scale = (_LONGEST_SIDE - 1.0) / float(max(extent[0], extent[1]))
    width, height = (float(np.clip(scale * side, 1.0, 7.5)) for side in extent)
    return max(width + 1.0, _NARROWEST), max(height + 1.6, _LOWEST)
