# SPDX-License-Identifier: MIT
"""Plot two ways to each of some goals from above."""

from collections.abc import Mapping, Sequence
from dataclasses import dataclass

import numpy as np
from matplotlib.axes import Axes
from matplotlib.figure import Figure

from model.robot import Robot
from model.walk.ground import FLAT, Ground
from model.walk.path import WalkPath
from zebro_lab.plots.sheet import BLUE, RED, legend_below, new_figure, styled
from zebro_lab.plots.walk_path import body_outline, ground_axes

_COLOURS = (BLUE, RED)
_COLUMNS = 3
_PANEL = 3.6  # inches
_NARROWEST = 7.0  # inches, for title and legend
_MARGIN = 0.05  # of the longer side, around everything


@dataclass(frozen=True)
class DrawnGoal:
    """A goal with the ways to it.

    Attributes:
        title: Title of its panel.
        place: x and y [m].
        heading: Heading there; None for any [rad].
        paths: The walk of each way by its name, at most two.
    """

    title: str
    place: tuple[float, float]
    heading: float | None
    paths: Mapping[str, WalkPath]


@styled
def ways_to_goals(
    goals: Sequence[DrawnGoal], robot: Robot, *, title: str, ground: Ground = FLAT
) -> Figure:
    """Draw the paths of the body's centre, with the body at the start and at each end.

    Args:
        goals: The goals, a panel each.
        robot: The robot, for the size of its body.
        title: Title of the figure, which names the model; "(simulated)" is appended.
        ground: The ground, whose heights are shaded.

    Returns:
        The figure, x to the right and y up, both to one scale in each panel.
    """
    columns = min(_COLUMNS, len(goals))
    rows = -(-len(goals) // columns)
    figure = new_figure(
        title, True, width=max(_NARROWEST, _PANEL * columns), height=_PANEL * rows + 0.9
    )
    axes = figure.subplots(rows, columns, squeeze=False).ravel()
    for panel, goal in zip(axes, goals, strict=False):
        _draw_goal(panel, goal, robot, ground)
    for panel in axes[len(goals) :]:
        panel.set_axis_off()
    legend_below(figure, columns=5)
    return figure


def _draw_goal(axes: Axes, goal: DrawnGoal, robot: Robot, ground: Ground) -> None:
    """Draw a goal and the ways to it; they are told apart by colour and by dashes."""
    corners = [np.array(goal.place)[None]]
    for (name, path), colour, dashes in zip(
        goal.paths.items(), _COLOURS, ("-", "--"), strict=False
    ):
        end = body_outline(path, robot, -1)
        axes.plot(*path.position[:, :2].T, color=colour, ls=dashes, lw=1.5, label=name, zorder=4)
        axes.fill(*end.T, facecolor=colour, alpha=0.15, lw=0, zorder=2)
        axes.plot(*end.T, color=colour, ls=dashes, lw=1.0, zorder=3)
        corners += [path.position[:, :2], end]
    start = body_outline(next(iter(goal.paths.values())), robot, 0)
    axes.plot(*start.T, color="0.5", lw=1.0, label="start", zorder=1)
    points = np.concatenate([*corners, start])
    middle = (points.min(axis=0) + points.max(axis=0)) / 2
    half = (0.5 + _MARGIN) * float(np.ptp(points, axis=0).max())
    low, high = middle - half, middle + half
    _mark_goal(axes, goal, arrow=0.12 * float(high[0] - low[0]))
    axes.set_title(goal.title, loc="left")
    ground_axes(axes, ground, low, high)


def _mark_goal(axes: Axes, goal: DrawnGoal, *, arrow: float) -> None:
    """Mark a goal by a cross, and the heading asked for by an arrow of a length [m]."""
    x, y = goal.place
    axes.plot(x, y, ls="none", marker="x", ms=8, mew=2.0, color="black", label="goal", zorder=5)
    if goal.heading is not None:
        to = (x + arrow * np.cos(goal.heading), y + arrow * np.sin(goal.heading))
        axes.annotate(
            "", xy=to, xytext=(x, y), arrowprops={"arrowstyle": "->", "lw": 1.5}, zorder=5
        )
