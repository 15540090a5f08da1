# SPDX-License-Identifier: MIT
"""Plot a walk: path from above with snapshots, position and orientation of the body over time."""

from collections.abc import Mapping, Sequence

import numpy as np
from matplotlib import colormaps
from matplotlib.axes import Axes
from matplotlib.colors import LinearSegmentedColormap
from matplotlib.figure import Figure

from model.arrays import Array
from model.robot import Robot
from model.walk.ground import FLAT, Ground, heights_on, is_level
from model.walk.path import WalkPath
from zebro_lab.plots import sheet
from zebro_lab.plots.walk_legs import time_grid
from zebro_lab.plots.walk_robot import outline, to_world

_SAMPLES = 400  # along the longer side
_LEVELS = 8
_SHADES = LinearSegmentedColormap.from_list("ground", ["#f7f3ea", "#d9c39a", "#9c7b48"])


def draw_ground(axes: Axes, ground: Ground, low: Array, high: Array) -> None:
    """Draw heights of the ground on a map, below all else; level ground is not drawn.

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


_SNAPSHOTS = 6
_LONGEST_SIDE = 8.5  # inches
_NARROWEST, _LOWEST = 7.0, 2.6  # inches, for the title and for the axis labels
_WINDOW = 0.1  # s over which velocities are means: impacts take a hundredth of that
_MEAN = f"mean of {_WINDOW:g} s"
_TWICE = f"mean of that in {_WINDOW:g} s"
_MARGIN = 0.25  # of the body's length, around everything


def ground_axes(axes: Axes, ground: Ground, low: Array, high: Array) -> None:
    """Set labels, grid and limits of a map of a walk, and draw the ground as `draw_ground` does.

    Args:
        axes: The map, x to the right and y up, both to one scale [m].
        ground: The ground.
        low: Smallest x and y, shape (2,) [m].
        high: Largest x and y, shape (2,) [m].
    """
    axes.set(
        xlabel="x [m]", ylabel="y [m]", aspect="equal",
        xlim=(low[0], high[0]), ylim=(low[1], high[1]),
    )  # fmt: skip
    draw_ground(axes, ground, low, high)
    axes.grid(color="0.92", lw=0.6)
    axes.set_axisbelow(True)


@sheet.styled
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
    bodies = [body_outline(path, robot, int(shot)) for shot in shots]
    low, high = _extent(path, bodies, robot)
    width, height = _sides(high - low)
    figure = sheet.new_figure(title, True, width=width, height=height)
    axes = figure.add_subplot()
    colours = colormaps["viridis"](np.linspace(0, 0.9, len(shots)))
    for when, body, colour in zip(wanted, bodies, colours, strict=True):
        axes.fill(*body.T, facecolor=colour, alpha=0.18, lw=0, zorder=1)
        label = f"t = {round(when, 2):g} s"
        axes.plot(*body.T, color=colour, lw=1.2, zorder=2, label=label)
    axes.plot(*path.position[:, :2].T, color="black", lw=1.2, zorder=3, label="body's centre")
    if 2 <= t[-1] - t[0] <= 60:
        seconds = np.interp(np.arange(np.ceil(t[0]), t[-1] + 1e-9), t, np.arange(len(t)))
        dots = path.position[seconds.round().astype(int), :2]
        axes.plot(*dots.T, ls="none", marker="o", ms=2.4, color="black", zorder=3,
                  label="whole seconds")  # fmt: skip
    ground_axes(axes, ground, low, high)
    sheet.legend_below(figure, columns=8)
    return figure


def snapshot_times(t: Array, at: Sequence[float]) -> Array:
    """Return the times to draw the robot at: those asked for, else six from start to end [s].

    Args:
        t: Times of the walk, shape (n,) [s].
        at: Times asked for; empty for none [s].
    """
    return np.asarray(at, dtype=float) if len(at) else np.linspace(t[0], t[-1], _SNAPSHOTS)


@sheet.styled
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


@sheet.styled
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
    their axes.
    """
    rows = [values, mean_rate(t, values)]
    rows.append(mean_rate(t, rows[-1]))
    least = np.repeat(np.array(list(units.values()))[:, None], 3, axis=1)
    figure = time_grid(t, rows, names, least=least, cut=0.0, width=8.5, title=title)
    for row, unit in enumerate(units):
        figure.axes[3 * row].set_ylabel(unit)
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


def body_outline(path: WalkPath, robot: Robot, sample: int) -> Array:
    """Return the outline of the body at a sample of a path from above, shape (6, 2) [m]."""
    return to_world(outline(robot), path.position[sample], path.orientation[sample])[:, :2]


def _extent(path: WalkPath, bodies: Sequence[Array], robot: Robot) -> tuple[Array, Array]:
    """Return lowest and highest x, y of path and bodies with a margin, shape (2,) each [m]."""
    points = np.vstack([path.position[:, :2], *bodies])
    margin = _MARGIN * robot.body_size[0]
    return points.min(axis=0) - margin, points.max(axis=0) + margin


def _sides(extent: Array) -> tuple[float, float]:
    """Compute width and height [inch] of a figure with axes about of the shape of `extent` [m].

    The axes are 1 to 7.5 inches each way, the figure at least 7.0 by 2.6 inches.
    """
    scale = (_LONGEST_SIDE - 1.0) / float(max(extent[0], extent[1]))
    width, height = (float(np.clip(scale * side, 1.0, 7.5)) for side in extent)
    return max(width + 1.0, _NARROWEST), max(height + 1.6, _LOWEST)
