# SPDX-License-Identifier: MIT
"""Plot slip ratio, normal force, traction and contact of each leg over time."""

from collections.abc import Mapping

import numpy as np
from matplotlib.axes import Axes
from matplotlib.figure import Figure
from numpy.typing import NDArray

from model.arrays import Array
from model.robot import LEFT, N_LEGS
from model.walk.path import WalkPath
from zebro_lab.plots.beyond import limits_without_tips, mark_beyond
from zebro_lab.plots.sheet import (
    BLUE,
    GREEN,
    RED,
    few_ticks,
    legend_below,
    new_figure,
    styled,
    time_axis,
)

_NAMES = ("left front", "right front", "left middle", "right middle", "left rear", "right rear")
_STANCE = "0.93"
_PALE_BLUE = "#56B4E9"
_HALF = 0.05  # s, before and after a sample, over which a leg's speed is taken
_AT_REST = np.radians(3.0)  # rad/s; a slower leg rests, and its slip ratio is 0/0


@styled
def slip_ratios(path: WalkPath, *, title: str) -> Figure:
    """Draw the longitudinal slip ratio of each leg over time (Fig. 5-16).

    Args:
        path: Part of a walk to draw.
        title: Title of the figure, which names the model; "(simulated)" is appended.

    Returns:
        The figure: a panel for each leg, arranged as on the robot; contact is shaded. A leg in the
        air, or on its toe, which does not roll, may have no ratio, and one at rest has none that
        means anything. The limits leave out 3 % of the ratios in contact at either end, marked: a
        leg dragged while it hardly turns has very large ones.
    """
    ratio = np.where(_turning(path.t, path.theta), path.slip_ratio, np.nan)
    limits = leg_limits(ratio[path.contact], least=0.02, cut=0.03)
    lines = {"slip ratio; none on the toe and at rest": ratio}
    return leg_panels(
        path.t, path.contact, lines, limits, label="slip ratio of the model", unit="-", title=title
    )


@styled
def normal_forces(path: WalkPath, *, title: str) -> Figure:
    """Draw the normal force on each leg over time (Fig. 5-17).

    Args:
        path: Part of a walk to draw.
        title: Title of the figure, which names the model; "(simulated)" is appended.

    Returns:
        The figure: a panel for each leg, arranged as on the robot; contact is shaded. The largest
        1 % may lie beyond the limits, which is marked.
    """
    return load_panels(path, {"normal force": path.normal_force}, title=title)


@styled
def traction_forces(path: WalkPath, *, title: str) -> Figure:
    """Draw the traction force of the ground on each leg over time (Fig. 5-18).

    Args:
        path: Part of a walk to draw.
        title: Title of the figure, which names the model; "(simulated)" is appended.

    Returns:
        The figure: a panel for each leg, arranged as on the robot, with the components forward and
        to the left of the heading; contact is shaded. 1 % at either end may exceed the limits,
        which is marked.
    """
    return draw_traction(path.t, path.traction_force, path.contact, title, label="traction force")


@styled
def leg_angles(path: WalkPath, *, title: str) -> Figure:
    """Draw the angle of each leg over time, modulo a turn (Fig. 2-2).

    Args:
        path: Part of a walk to draw.
        title: Title of the figure, which names the model; "(simulated)" is appended.

    Returns:
        The figure: a panel for each leg, arranged as on the robot; contact is shaded. At 90 degrees
        a leg points down, at 0 ahead.
    """
    return turn_panels(
        path, path.theta, "angle; 0 ahead, 90 down", label="leg angle", least=0, title=title
    )


@styled
def gantt(path: WalkPath, *, title: str) -> Figure:
    """Draw when each leg was in contact as a bar chart over time (Fig. 2-1).

    Args:
        path: Part of a walk to draw.
        title: Title of the figure, which names the model; "(simulated)" is appended.

    Returns:
        The figure: a row for each leg, leg 1 on top; bars are contact, left legs darker. Times
        without any contact are shaded, those with the body on the ground hatched.
    """
    figure = new_figure(title, True, width=7.5, height=3.0)
    axes = figure.add_subplot()
    for start, end in stances(path.t, path.in_flight):
        axes.axvspan(start, end, color=RED, alpha=0.2, lw=0, label="flight")
    for start, end in stances(path.t, path.on_body):
        axes.axvspan(
            start, end, facecolor="none", edgecolor="0.6", hatch="////", lw=0,
            label="body on the ground",
        )  # fmt: skip
    for leg in range(N_LEGS):
        bars = [(start, end - start) for start, end in stances(path.t, path.contact[:, leg])]
        colour, side = (BLUE, "left") if leg in LEFT else (_PALE_BLUE, "right")
        axes.broken_barh(
            bars, (leg + 0.6, 0.8), facecolors=colour, lw=0, label=f"{side} leg on the ground"
        )
    axes.set(
        ylim=(N_LEGS + 0.7, 0.3),
        yticks=range(1, N_LEGS + 1),
        yticklabels=[f"{leg}  {name}" for leg, name in enumerate(_NAMES, start=1)],
    )  # fmt: skip
    time_axis(axes, path.t)
    axes.tick_params(axis="y", length=0)
    axes.grid(axis="x", color="0.9", lw=0.6)
    axes.set_axisbelow(True)
    legend_below(figure, columns=2)
    return figure


def stances(t: Array, contact: NDArray[np.bool_]) -> list[tuple[float, float]]:
    """Compute the intervals in which a leg was in contact.

    Args:
        t: Times, shape (n,) [s].
        contact: Whether the leg pressed on the ground, shape (n,).

    Returns:
        Start and end of each interval [s]: time of the first sample in contact, and of the next
        sample without contact or, if there is none, of the last sample.

    >>> stances(np.arange(5.0), np.array([True, True, False, False, True]))
    [(0.0, 2.0), (4.0, 4.0)]
    """
    edges = np.flatnonzero(np.diff(np.concatenate([[False], contact, [False]]).astype(int)))
    last = len(t) - 1
    return [
        (float(t[start]), float(t[min(end, last)]))
        for start, end in zip(edges[::2], edges[1::2], strict=True)
    ]


def _turning(t: Array, theta: Array) -> NDArray[np.bool_]:
    """Return whether each leg turns both before and after each sample, shape (n, 6).

    Args:
        t: Times, shape (n,) [s].
        theta: Leg angles, shape (n, 6) [rad].
    """
    turns = np.ones(theta.shape, dtype=bool)
    for half in (-_HALF, _HALF):
        there = np.clip(t + half, t[0], t[-1])
        moved = np.column_stack([np.interp(there, t, each) for each in theta.T]) - theta
        whole = np.abs(there - t) > 0.5 * _HALF  # else the walk begins or ends here
        turns &= (np.abs(moved) >= _AT_REST * np.abs(there - t)[:, None]) | ~whole[:, None]
    return turns


def draw_traction(
    t: Array, force: Array, contact: NDArray[np.bool_], title: str, *, label: str
) -> Figure:
    """Draw traction of each leg forward and to the left over time.

    Args:
        t: Times, shape (n,) [s].
        force: Traction forces, shape (n, 6, 2) [N].
        contact: Which legs are on the ground, shape (n, 6).
        title: Title of the figure; "(simulated)" is appended.
        label: What the force is, without its unit.
    """
    lines = {"forward": force[..., 0], "to the left": force[..., 1]}
    limits = leg_limits(force[contact], least=0.5)
    return leg_panels(t, contact, lines, limits, label=label, unit="N", title=title)


def leg_panels(
    t: Array, contact: NDArray[np.bool_], lines: Mapping[str, Array],
    limits: tuple[float, float], *, label: str, unit: str, title: str,
) -> Figure:  # fmt: skip
    """Draw one to three lines over time in a panel per leg, arranged as on the robot from above.

    Args:
        t: Times, shape (n,) [s].
        contact: Whether each leg is on the ground, which is shaded, shape (n, 6).
        lines: Values by label, shape (n, 6) each.
        limits: Limits of the vertical axes.
        label: What the vertical axes show.
        unit: Its unit.
        title: Title of the figure; "(simulated)" is appended.
    """
    figure = new_figure(title, True, width=8.0, height=6.4)
    for leg, axes in enumerate(figure.subplots(3, 2, sharex=True, sharey=True).ravel()):
        axes.set_title(f"leg {leg + 1}, {_NAMES[leg]}", loc="left")
        axes.yaxis.set_major_locator(few_ticks(5))
        _shade(axes, t, contact[:, leg])
        for (name, values), colour in zip(lines.items(), (BLUE, RED, GREEN), strict=False):
            axes.plot(t, values[:, leg], color=colour, lw=0.9, label=name)
            mark_beyond(axes, t, values[:, leg], limits, label="beyond the axes")
    drawn = contact if contact.any() else np.ones_like(contact)  # in the air forces are zero
    computed = any(np.isfinite(each[drawn]).any() for each in lines.values())
    _label(figure, t, f"{label} [{unit}]", computed=computed)
    legend_below(figure, columns=4)
    return figure


def load_panels(path: WalkPath, lines: Mapping[str, Array], *, title: str) -> Figure:
    """Draw normal forces over time in a panel per leg as `leg_panels` does.

    Args:
        path: Part of a walk to draw; the limits hold all but 1 % of its normal forces.
        lines: Forces by label, shape (n, 6) each [N].
        title: Title of the figure; "(simulated)" is appended.
    """
    limits = 0.0, leg_limits(path.normal_force[path.contact], least=1.0)[1]
    return leg_panels(
        path.t, path.contact, lines, limits, label="normal force", unit="N", title=title
    )


def turn_panels(
    path: WalkPath, angle: Array, name: str, *, label: str, least: int, title: str
) -> Figure:
    """Draw an angle over time, modulo a turn, in a panel per leg as `leg_panels` does.

    Args:
        path: Part of a walk to draw.
        angle: The angle, shape (n, 6) [rad].
        name: Name of the line.
        label: What the vertical axes show.
        least: Lower limit of the vertical axes, which show a turn [deg].
        title: Title of the figure; "(simulated)" is appended.
    """
    shown = (np.degrees(angle) - least) % 360 + least
    turned = np.abs(np.diff(shown, axis=0, prepend=shown[:1])) > 180
    lines = {name: np.where(turned, np.nan, shown)}
    limits = float(least), float(least + 360)
    figure = leg_panels(
        path.t, path.contact, lines, limits, label=label, unit="deg", title=title
    )  # fmt: skip
    for axes in figure.axes:
        axes.set(ylim=limits, yticks=range(least, least + 361, 90))
    return figure


def _shade(axes: Axes, t: Array, contact: NDArray[np.bool_]) -> None:
    spans = [(start, end - start) for start, end in stances(t, contact)]
    axes.broken_barh(
        spans, (0, 1), transform=axes.get_xaxis_transform(), facecolors=_STANCE, lw=0, zorder=0,
        label="leg on the ground",
    )  # fmt: skip
    axes.axhline(0, color="0.6", lw=0.5, zorder=1)


def leg_limits(values: Array, *, least: float, cut: float = 0.01) -> tuple[float, float]:
    """Compute axis limits that hold zero and all finite values but a share `cut` at either end."""
    low, high = limits_without_tips(values, cut=cut, margin=0.0, least=0.0)
    return limits_without_tips(
        np.array([min(low, 0.0), max(high, 0.0)]), cut=0.0, margin=0.1, least=1.2 * least
    )


def _label(figure: Figure, t: Array, what: str, *, computed: bool) -> None:
    """Label the axes; write a note in each panel if the model does not compute the quantity."""
    figure.supylabel(what, fontsize=9.0)
    for axes in figure.axes[-2:]:
        time_axis(axes, t)
    for axes in () if computed else figure.axes:
        axes.text(
            0.5, 0.7, "this model computes none", ha="center", color="0.4",
            transform=axes.transAxes,
        )  # fmt: skip
