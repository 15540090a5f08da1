# SPDX-License-Identifier: MIT
"""Plot a leg of either side from the side, at touchdown and at lift-off."""

from dataclasses import replace

import numpy as np
from matplotlib.axes import Axes
from matplotlib.figure import Figure

from model.arrays import Array
from model.gait.cyclic import CyclicReference
from model.leg import hip_height, wrap_angle
from model.robot import N_LEGS, Robot
from zebro_lab.plots.sheet import BLUE, RED, legend_below, new_figure, styled
from zebro_lab.plots.walk_robot import leg_arcs

_APART = 1.9  # diameters of the leg between its two positions


@styled
def stances(gait: CyclicReference, robot: Robot, *, title: str) -> Figure:
    """Draw leg 1 and leg 2 from the side at touchdown and lift-off (Fig. 2-5, 2-6, 5-9).

    Args:
        gait: The gait.
        robot: The robot, for the shape of its legs.
        title: Title of the figure; "(simulated)" is appended.

    Returns:
        The figure: a panel for each side, walking to the right, on level ground under a level body;
        hips, whose heights are written, are dots.
    """
    figure = new_figure(title, True, width=7.5, height=3.7)
    panels = figure.subplots(1, 2, sharex=True, sharey=True)
    for leg, (axes, side) in enumerate(zip(panels, ("left", "right"), strict=True)):
        inner = ", inner" if leg in gait.inner else ", outer" if gait.inner else ""
        axes.set_title(f"{side} legs{inner}", loc="left")
        axes.axhline(0, color="0.4", lw=0.8)
        angles = {"touchdown": (gait.touchdown[leg], BLUE), "lift-off": (gait.liftoff[leg], RED)}
        for place, (name, (theta, colour)) in enumerate(angles.items()):
            start = place * _APART * 2 * robot.leg_radius
            _draw_leg(axes, robot, float(theta), start, label=name, colour=colour)
        highest = 3.1 * robot.leg_radius  # with room for what is written above a hip
        axes.set(xlabel="x [m]", aspect="equal", ylim=(-0.3 * robot.leg_radius, highest))
        axes.margins(x=0.1)
    panels[0].set_ylabel("z [m]")
    legend_below(figure, columns=2)
    return figure


def _draw_leg(
    axes: Axes, robot: Robot, theta: float, start: float, *, label: str, colour: str
) -> None:
    """Draw a leg with its hip at x = start [m] and its lowest point on the ground."""
    height = _height(robot, theta)
    arc = leg_arcs(replace(robot, hips=np.zeros((N_LEGS, 3))), np.full(N_LEGS, theta))[0]
    x, z = arc[:, 0] + start, arc[:, 2] + height
    axes.plot(x, z, color=colour, lw=2.2, solid_capstyle="round", label=label)
    axes.plot([x[0], x[-1]], [z[0], z[-1]], color=colour, lw=0.7, ls=":")
    axes.plot(start, height, marker="o", ms=5, color=colour)
    axes.annotate(
        f"{np.degrees(theta):.1f}°\n{1000 * height:.1f} mm", (start, height), xytext=(0, 6),
        textcoords="offset points", ha="center", va="bottom", color=colour,
        bbox={"facecolor": "white", "alpha": 0.7, "lw": 0, "pad": 1.0},
    )  # fmt: skip


def _height(robot: Robot, theta: float) -> float:
    """Compute the hip height of a leg that stands on the ground at angle theta, level body [m]."""
    phi: Array | float = np.asarray(wrap_angle(np.pi / 2 - theta))
    return float(hip_height(phi, robot.leg_radius, robot.toe_beyond))
