# SPDX-License-Identifier: MIT
"""Photographs from above with the robot drawn at its predicted pose (Fig. 5-3, 5-24, 5-25)."""

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np
from matplotlib.axes import Axes
from matplotlib.figure import Figure
from numpy.typing import NDArray

from model.arrays import Array
from model.robot import Robot
from zebro_lab.plots import sheet
from zebro_lab.plots.walk_robot import leg_arcs, outline, to_world

_COLUMN = 1.75  # inches: the text of four columns is legible at the width of a page
_DPI = 220  # for the photographs
_IN_AIR = "0.55"


@dataclass(frozen=True)
class Shot:
    """A photograph and the predicted robot at one instant.

    Attributes:
        t: Time of the photograph, in the prediction's time base [s].
        picture: The photograph rectified to straight above, BGR, shape (height, width, 3).
        extent: Lowest x, highest x, lowest y, highest y of the picture on the floor [m].
        tracked: Tracked x, y [m] and yaw [rad], shape (3,).
        position: Predicted position of the body's centre in the floor frame, shape (3,) [m].
        orientation: Predicted roll, pitch and yaw, shape (3,) [rad].
        theta: Leg angles, shape (6,) [rad].
        contact: Whether each leg is on the ground, shape (6,).
    """

    t: float
    picture: NDArray[np.uint8]
    extent: tuple[float, float, float, float]
    tracked: Array
    position: Array
    orientation: Array
    theta: Array
    contact: NDArray[np.bool_]


@sheet.styled
def photos_beside_poses(
    shots: Sequence[Shot], robot: Robot, *, title: str, simulated_photos: bool
) -> Figure:
    """Draw photographs in a row, and below each the robot as predicted, at the same scale.

    Args:
        shots: Photographs and predicted poses, one or more.
        robot: The robot, for the size of body and legs.
        title: Name of the walk.
        simulated_photos: Whether the photographs are simulated too; predictions always are.

    Returns:
        The figure: photographs above; predicted robots below, with the tracked outline, the
        distance from it [mm], and yaw predicted minus tracked [deg].
    """
    figure = sheet.new_figure(
        f"Photographs and predicted poses: {title}", False,
        width=max(_COLUMN * len(shots) + 0.6, 5.0), height=2 * _COLUMN + 1.4,
    )  # fmt: skip
    figure.set_dpi(_DPI)
    panels = figure.subplots(2, len(shots), squeeze=False)
    taken = "simulated photograph" if simulated_photos else "photograph"
    for (photograph, drawn), shot in zip(panels.T, shots, strict=True):
        photograph.imshow(shot.picture[:, :, ::-1], extent=shot.extent, interpolation="antialiased")
        photograph.set_title(f"t = {shot.t:.2f} s", loc="left", fontsize=8)
        _draw_robot(drawn, shot, robot)
        off = 1e3 * np.linalg.norm(shot.position[:2] - shot.tracked[:2])
        turned = np.degrees(np.angle(np.exp(1j * (shot.orientation[2] - shot.tracked[2]))))
        error = sheet.with_minus(f"{off:.0f} mm, {turned:+.1f} deg")
        drawn.set_title(f"off {error}", loc="left", fontsize=8)
        for axes in (photograph, drawn):
            axes.set(xlim=shot.extent[:2], ylim=shot.extent[2:], aspect="equal")
            axes.tick_params(labelsize=7)
            axes.xaxis.set_major_locator(sheet.few_ticks(4))
            axes.yaxis.set_major_locator(sheet.few_ticks(4))
        drawn.set_xlabel("x [m]")
    panels[0, 0].set_ylabel(f"{taken}\ny [m]")
    panels[1, 0].set_ylabel("predicted (simulated)\ny [m]")
    sheet.legend_below(figure, columns=4)
    return figure


def _draw_robot(axes: Axes, shot: Shot, robot: Robot) -> None:
    """Draw the predicted body and legs from above, and the tracked outline of the body."""
    body = to_world(outline(robot), shot.position, shot.orientation)
    legs = to_world(leg_arcs(robot, shot.theta), shot.position, shot.orientation)
    for leg, stands in zip(legs, shot.contact, strict=True):
        colour, label = (sheet.RED, "leg on the ground") if stands else (_IN_AIR, "leg in the air")
        axes.plot(*leg[:, :2].T, color=colour, lw=3.0, solid_capstyle="butt", label=label)
    axes.fill(*body[:, :2].T, facecolor=sheet.BLUE, alpha=0.3, lw=0)
    axes.plot(*body[:, :2].T, color=sheet.BLUE, lw=1.2, label="predicted body")
    x, y, yaw = shot.tracked
    seen = to_world(outline(robot), np.array([x, y, 0.0]), np.array([0.0, 0.0, yaw]))
    axes.plot(*seen[:, :2].T, color="black", ls="--", lw=1.0, label="tracked body")
    axes.grid(color="0.9", lw=0.6)
    axes.set_axisbelow(True)
