# SPDX-License-Identifier: MIT
"""Plot quantities of the thesis's model: coordinates, legs, speeds and loads over time."""

import numpy as np
from matplotlib.figure import Figure

from model.robot import LEFT, RIGHT
from model.thesis.path import ThesisPath
from model.thesis.traction import paired_sum
from zebro_lab.plots import sheet
from zebro_lab.plots.walk_legs import (
    draw_traction,
    leg_limits,
    leg_panels,
    load_panels,
    time_grid,
    turn_panels,
)

_COORDINATES = ("x", "y", "z", "roll", "pitch", "yaw")
_LEAST = np.array([[0.002, 0.01, 0.1], [0.1, 1.0, 10.0]])  # range of an axis: m, deg; rates of it


@sheet.styled
def coordinates(path: ThesisPath, *, title: str) -> Figure:
    """Draw the model's coordinates with rates and accelerations over time (Fig. 5-2, 5-5, 5-7).

    Args:
        path: Part of a walk to draw.
        title: Title of the figure, which names the model; "(simulated)" is appended.

    Returns:
        The figure: a column for each of x, y, z and the angles of Eq. (3-7), a row each for values,
        rates and accelerations of single steps, in which traction alternates; 1 % at either end
        may lie beyond the limits, which is marked. Of kinematics there are no accelerations.
    """
    values = np.column_stack([path.position, path.angles])
    rows = np.stack([values, path.rates, path.acceleration])[: 2 if path.is_kinematic else 3]
    rows[:, :, 3:] = np.degrees(rows[:, :, 3:])
    least = np.repeat(_LEAST, 3, axis=0).T
    figure = time_grid(
        path.t, list(rows), _COORDINATES, least=least, cut=0.01, width=13.0, title=title
    )
    for row, text in enumerate(("[{}]", "rate [{}/s]", "acceleration [{}/s²]")[: len(rows)]):
        for column, unit in ((0, "m"), (3, "deg")):
            figure.axes[6 * row + column].set_ylabel(text.format(unit))
    return figure


@sheet.styled
def lowest_angles(path: ThesisPath, *, title: str) -> Figure:
    """Draw the angle phi of the lowest point of each leg's circle over time (section 3-4).

    Args:
        path: Part of a walk to draw.
        title: Title of the figure, which names the model; "(simulated)" is appended.

    Returns:
        The figure: a panel for each leg, arranged as on the robot; contact is shaded. Above 0 a
        half-circle leg rolls, from 0 to -90 degrees it stands on its toe.
    """
    return turn_panels(
        path, path.phi, "angle of the lowest point; 0 at the toe", label="angle phi", least=-180,
        title=title,
    )  # fmt: skip


@sheet.styled
def hip_heights(path: ThesisPath, *, title: str) -> Figure:
    """Draw the hip heights by which contacts change, of each side over time (Table 3-1).

    Args:
        path: Part of a walk to draw.
        title: Title of the figure, which names the model; "(simulated)" is appended.

    Returns:
        The figure: a panel for each side with the mean height of its front and rear hips, which
        step together, and that of its middle hip; thick while these legs are on the ground. The
        legs on the ground change where the lines cross.
    """
    figure = sheet.new_figure(title, True, width=8.0, height=5.0)
    panels = figure.subplots(2, 1, sharex=True, sharey=True)
    for axes, legs, side in zip(panels, (LEFT, RIGHT), ("left", "right"), strict=True):
        front, middle, rear = legs
        height = 1000 * path.hip_height
        pair = height[:, [front, rear]].mean(axis=1)
        axes.set_title(f"{side} side", loc="left")
        for values, leg, colour, name in (
            (pair, front, sheet.BLUE, "front and rear legs, mean"),
            (height[:, middle], middle, sheet.RED, "middle leg"),
        ):
            axes.plot(path.t, values, color=colour, lw=0.8, label=name)
            down = np.where(path.contact[:, leg], values, np.nan)
            axes.plot(path.t, down, color=colour, lw=2.8, label=f"{name}, on the ground")
        axes.grid(color="0.92", lw=0.6)
        axes.set_ylabel("hip height [mm]")
    sheet.time_axis(panels[-1], path.t)
    sheet.legend_below(figure, columns=2)
    return figure


@sheet.styled
def contact_velocities(path: ThesisPath, *, title: str) -> Figure:
    """Draw the speeds that a leg's slip ratio compares over time, Eq. (4-31) and (4-36).

    Args:
        path: Part of a walk to draw.
        title: Title of the figure, which names the model; "(simulated)" is appended.

    Returns:
        The figure: a panel for each leg on the ground, arranged as on the robot; contact is shaded.
    """
    lines = {
        "of the body over the contact, v_C": path.contact_speed,
        "of the hip, v_H": path.hip_speed,
        "of the leg by its turning, v_R, v_T": path.leg_speed,
    }
    limits = leg_limits(np.stack(list(lines.values()))[:, path.contact], least=0.02)
    return leg_panels(
        path.t, path.contact, lines, limits, label="forward speed", unit="m/s", title=title
    )


@sheet.styled
def static_loads(path: ThesisPath, *, title: str) -> Figure:
    """Draw each leg's normal force and its load in static equilibrium over time, section 4-4.

    Args:
        path: Part of a walk to draw.
        title: Title of the figure, which names the model; "(simulated)" is appended.

    Returns:
        The figure: a panel for each leg, arranged as on the robot; contact is shaded.
    """
    lines = {
        "normal force, Eq. (4-22)": path.normal_force,
        "in static equilibrium, Eq. (4-18)": path.static_load,
    }
    return load_panels(path, lines, title=title)


@sheet.styled
def paired_traction(path: ThesisPath, *, title: str) -> Figure:
    """Draw the sum of traction force over pairs of time steps, of each leg over time (Fig. 5-19).

    In the thesis's model the traction changes sign from time step to time step; the thesis calls
    this sum the net force. It is a sum, not a mean: where the traction is steady, twice the force.

    Args:
        path: Part of a walk to draw.
        title: Title of the figure, which names the model; "(simulated)" is appended.

    Returns:
        The figure, as `traction_forces` draws it; time and contact are those of a pair's first
        step.
    """
    net = paired_sum(path.traction_force)
    first = slice(1, 2 * len(net), 2)
    return draw_traction(
        path.t[first], net, path.contact[first], title, label="sum of two steps' traction force"
    )
