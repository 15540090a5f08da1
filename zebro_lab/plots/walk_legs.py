# SPDX-License-Identifier: MIT
"""Plot slip ratio, normal force, traction and angle of each leg over time."""

from collections.abc import Mapping, Sequence

import numpy as np
from matplotlib.axes import Axes
from matplotlib.figure import Figure
from numpy.typing import NDArray

from model.arrays import Array
from model.walk.path import WalkPath
from zebro_lab.plots import sheet
from zebro_lab.plots.walk_contacts import NAMES, stances

_APART = 0.01  # of the time shown; excursions closer than this share a mark


def limits_without_tips(
    values: Array, *, cut: float, margin: float, least: float
) -> tuple[float, float]:
    """Compute axis limits that leave out the tips of impacts, which would flatten all else.

    Args:
        values: Values to draw, any shape; those that are not finite do not count.
        cut: Share of the values left out at either end; 0 for none [-].
        margin: Margin at either end, as a share of the range [-].
        least: Least range of the limits, so that rounding errors look like zero [unit of values].

    Returns:
        Lower and upper limit; around zero if no value is finite.
    """
    finite = values[np.isfinite(values)]
    low, high = np.quantile(finite, (cut, 1 - cut)) if len(finite) else (0.0, 0.0)
    wider = max(margin * (high - low), 0.5 * (least - (high - low)))
    return float(low - wider), float(high + wider)


def mark_beyond(
    axes: Axes, t: Array, values: Array, limits: tuple[float, float], *, label: str
) -> None:
    """Draw a triangle at the edge of the axes for each excursion of a curve beyond its limits.

    Excursions closer to each other than a hundredth of the time shown share a triangle.

    Args:
        axes: Axes with the curve.
        t: Times, shape (n,) [s].
        values: Values of the curve, shape (n,).
        limits: Limits of the vertical axis; they are set.
        label: Label of the marks in a legend.
    """
    axes.set_ylim(limits)
    for outside, edge, shape in ((values < limits[0], 0.0, "v"), (values > limits[1], 1.0, "^")):
        at = t[outside]
        if not len(at):
            continue
        begins = at[np.diff(at, prepend=-np.inf) > _APART * (t[-1] - t[0])]
        axes.plot(
            begins, np.full(len(begins), edge), transform=axes.get_xaxis_transform(),
            ls="none", marker=shape, ms=3.5, color="0.25", mew=0, clip_on=False, zorder=5,
            label=label,
        )  # fmt: skip


_STANCE = "0.93"
_HALF = 0.05  # s, before and after a sample, over which a leg's speed is taken
_AT_REST = np.radians(3.0)  # rad/s; a slower leg rests, and its slip ratio is 0/0


@sheet.styled
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


@sheet.styled
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


@sheet.styled
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


@sheet.styled
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


def _turning(t: Array, theta: Array) -> NDArray[np.bool_]:
    """Return whether each leg turns both before and after each sample, shape (n, 6).

    It turns if its mean speed over `_HALF` before, and after, is `_AT_REST` or more. Where the walk
    has less than half of that time before or after a sample, nothing is required.

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

    A note is written in each panel if no value of a leg in contact is finite: the model computes
    none.

    Args:
        t: Times, shape (n,) [s].
        contact: Whether each leg is on the ground, which is shaded, shape (n, 6).
        lines: Values by label, shape (n, 6) each.
        limits: Limits of the vertical axes.
        label: What the vertical axes show.
        unit: Its unit.
        title: Title of the figure; "(simulated)" is appended.
    """
    figure = sheet.new_figure(title, True, width=8.0, height=6.4)
    for leg, axes in enumerate(figure.subplots(3, 2, sharex=True, sharey=True).ravel()):
        axes.set_title(f"leg {leg + 1}, {NAMES[leg]}", loc="left")
        axes.yaxis.set_major_locator(sheet.few_ticks(5))
        _shade(axes, t, contact[:, leg])
        for (name, values), colour in zip(
            lines.items(), (sheet.BLUE, sheet.RED, sheet.GREEN), strict=False
        ):
            axes.plot(t, values[:, leg], color=colour, lw=0.9, label=name)
            mark_beyond(axes, t, values[:, leg], limits, label="beyond the axes")
    drawn = contact if contact.any() else np.ones_like(contact)  # in the air forces are zero
    computed = any(np.isfinite(each[drawn]).any() for each in lines.values())
    _label(figure, t, f"{label} [{unit}]", computed=computed)
    sheet.legend_below(figure, columns=4)
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
        least: Lower limit of the vertical axes, which show one turn from there on [deg].
        title: Title of the figure; "(simulated)" is appended.
    """
    shown = (np.degrees(angle) - least) % 360 + least
    turned = np.abs(np.diff(shown, axis=0, prepend=shown[:1])) > 180
    lines = {name: np.where(turned, np.nan, shown)}  # no line where it jumps by a turn
    limits = float(least), float(least + 360)
    figure = leg_panels(
        path.t, path.contact, lines, limits, label=label, unit="deg", title=title
    )  # fmt: skip
    for axes in figure.axes:
        axes.set(ylim=limits, yticks=range(least, least + 361, 90))
    return figure


def _shade(axes: Axes, t: Array, contact: NDArray[np.bool_]) -> None:
    """Shade the times of contact over the full height of the axes, and draw a line at zero."""
    spans = [(start, end - start) for start, end in stances(t, contact)]
    axes.broken_barh(
        spans, (0, 1), transform=axes.get_xaxis_transform(), facecolors=_STANCE, lw=0, zorder=0,
        label="leg on the ground",
    )  # fmt: skip
    axes.axhline(0, color="0.6", lw=0.5, zorder=1)


def time_grid(
    t: Array, rows: Sequence[Array], titles: Sequence[str], *, least: Array, cut: float,
    width: float, title: str,
) -> Figure:  # fmt: skip
    """Draw each column over time in a panel, and below it that of further arrays, such as rates.

    Args:
        t: Times, shape (n,) [s].
        rows: Values, their rates and so on, shape (n, k) each.
        titles: Title of each column, k of them.
        least: Least range of each panel's axis, shape (len(rows), k): what the solver leaves of a
            quantity that is zero is not blown up.
        cut: Share of the values beyond the limits at either end, where they are marked; the first
            row has no value beyond its limits [-].
        width: Width of the figure [inch].
        title: Title of the figure; "(simulated)" is appended.
    """
    figure = sheet.new_figure(title, True, width=width, height=0.6 + 1.9 * len(rows))
    panels = figure.subplots(len(rows), len(titles), sharex=True)
    for (row, column), axes in np.ndenumerate(panels):
        values = rows[row][:, column]
        limits = limits_without_tips(
            values, cut=cut if row else 0.0, margin=0.05, least=float(least[row, column])
        )
        axes.plot(t, values, color=sheet.BLUE, lw=0.8)
        mark_beyond(axes, t, values, limits, label="beyond the axes")
        axes.yaxis.set_major_locator(sheet.few_ticks(5))
        axes.grid(color="0.92", lw=0.6)
    for top, bottom, name in zip(panels[0], panels[-1], titles, strict=True):
        top.set_title(name, loc="left")
        sheet.time_axis(bottom, t)
    figure.align_ylabels(panels[:, 0])
    sheet.legend_below(figure, columns=2)
    return figure


def leg_limits(values: Array, *, least: float, cut: float = 0.01) -> tuple[float, float]:
    """Compute axis limits that hold zero and all finite values but a share `cut` at either end."""
    low, high = limits_without_tips(values, cut=cut, margin=0.0, least=0.0)
    return limits_without_tips(
        np.array([min(low, 0.0), max(high, 0.0)]), cut=0.0, margin=0.1, least=1.2 * least
    )


def _label(figure: Figure, t: Array, what: str, *, computed: bool) -> None:
    """Label the axes; write a note in each panel if the model does not compute the quantity."""
    figure.supylabel(what)
    for axes in figure.axes[-2:]:
        sheet.time_axis(axes, t)
    for axes in () if computed else figure.axes:
        axes.text(
            0.5, 0.7, "this model computes none", ha="center", color="0.4",
            transform=axes.transAxes,
        )  # fmt: skip
