# SPDX-License-Identifier: MIT
"""Plot slip ratio, normal force, traction and contact of each leg over time."""

from collections.abc import Iterator

import numpy as np
from matplotlib.axes import Axes
from matplotlib.figure import Figure
from matplotlib.ticker import MaxNLocator
from numpy.typing import NDArray

from model.robot import LEFT, N_LEGS
from model.slip.law import Array
from model.walk.path import WalkPath
from model.walk.thesis.traction import paired_sum
from zebro_lab.plots.sheet import BLUE, RED, legend_below, new_figure, styled

_NAMES = ("left front", "right front", "left middle", "right middle", "left rear", "right rear")
_STANCE = "0.93"


@styled
def slip_ratios(path: WalkPath, *, title: str, simulated: bool) -> Figure:
    """Draw the longitudinal slip ratio of each leg over time (Fig. 5-16).

    Args:
        path: The stretch of walk to draw.
        title: Title of the figure; name the model.
        simulated: Whether to append "(simulated)" to the title.

    Returns:
        The figure: a panel for each leg, arranged as on the robot; contact is shaded. A leg on its
        toe does not roll and may have no ratio. Limits leave out the largest few percent: a leg
        that is dragged while it hardly turns has very large ones.
    """
    figure, panels = _leg_panels(title, simulated)
    limits = _limits(path.slip_ratio[path.contact], least=0.02, cut=0.03)
    for leg, axes in panels:
        _shade(axes, path.t, path.contact[:, leg])
        axes.plot(path.t, path.slip_ratio[:, leg], color=BLUE, lw=0.9)
        axes.set_ylim(limits)
    _label(figure, "slip ratio, the model's own [-]", path.slip_ratio)
    return figure


@styled
def normal_forces(path: WalkPath, *, title: str, simulated: bool) -> Figure:
    """Draw the normal force on each leg over time (Fig. 5-17).

    Args:
        path: The stretch of walk to draw.
        title: Title of the figure; name the model.
        simulated: Whether to append "(simulated)" to the title.

    Returns:
        The figure: a panel for each leg, arranged as on the robot; contact is shaded.
    """
    figure, panels = _leg_panels(title, simulated)
    _, high = _limits(path.normal_force[path.contact], least=1.0)
    for leg, axes in panels:
        _shade(axes, path.t, path.contact[:, leg])
        axes.plot(path.t, path.normal_force[:, leg], color=BLUE, lw=0.9)
        axes.set_ylim(0, high)
    _label(figure, "normal force [N]", path.normal_force)
    return figure


@styled
def traction_forces(path: WalkPath, *, title: str, simulated: bool) -> Figure:
    """Draw the traction force of the ground on each leg over time (Fig. 5-18).

    Args:
        path: The stretch of walk to draw.
        title: Title of the figure; name the model.
        simulated: Whether to append "(simulated)" to the title.

    Returns:
        The figure: a panel for each leg, arranged as on the robot, forward and to the left of the
        heading; contact is shaded.
    """
    return _draw_traction(path.t, path.traction_force, path.contact, title, simulated)


@styled
def paired_traction(path: WalkPath, *, title: str, simulated: bool) -> Figure:
    """Draw the sums of consecutive pairs of traction forces of each leg over time (Fig. 5-19).

    The thesis's traction changes sign from step to step; this is what it calls the net force.

    Args:
        path: The stretch of walk to draw.
        title: Title of the figure; name the model.
        simulated: Whether to append "(simulated)" to the title.

    Returns:
        The figure, as `traction_forces` draws it.
    """
    net = paired_sum(path.traction_force)
    first = slice(1, 2 * len(net), 2)
    return _draw_traction(path.t[first], net, path.contact[first], title, simulated)


@styled
def gantt(path: WalkPath, *, title: str, simulated: bool) -> Figure:
    """Draw when each leg was in contact (Fig. 2-1).

    Args:
        path: The stretch of walk to draw.
        title: Title of the figure; name the model.
        simulated: Whether to append "(simulated)" to the title.

    Returns:
        The figure: a row for each leg, leg 1 on top; bars are contact, left legs darker.
    """
    figure = new_figure(title, simulated, width=7.5, height=3.0)
    axes = figure.add_subplot()
    for leg in range(N_LEGS):
        bars = [(start, end - start) for start, end in stances(path.t, path.contact[:, leg])]
        colour = BLUE if leg in LEFT else "#56B4E9"
        axes.broken_barh(bars, (leg + 0.6, 0.8), facecolors=colour, lw=0)
    axes.set(
        xlabel="time [s]", xlim=(path.t[0], path.t[-1]), ylim=(N_LEGS + 0.7, 0.3),
        yticks=range(1, N_LEGS + 1),
        yticklabels=[f"{leg}  {name}" for leg, name in enumerate(_NAMES, start=1)],
    )  # fmt: skip
    axes.tick_params(axis="y", length=0)
    axes.grid(axis="x", color="0.9", lw=0.6)
    axes.set_axisbelow(True)
    return figure


def stances(t: Array, contact: NDArray[np.bool_]) -> list[tuple[float, float]]:
    """Compute the intervals in which a leg was in contact.

    Args:
        t: Times, shape (n,) [s].
        contact: Whether the leg pressed on the ground, shape (n,).

    Returns:
        First and last time of each stretch of contact; a stretch ends with the sample that is
        without, or the last one [s].

    >>> stances(np.arange(5.0), np.array([True, True, False, False, True]))
    [(0.0, 2.0), (4.0, 4.0)]
    """
    edges = np.flatnonzero(np.diff(np.concatenate([[False], contact, [False]]).astype(int)))
    last = len(t) - 1
    return [
        (float(t[start]), float(t[min(end, last)]))
        for start, end in zip(edges[::2], edges[1::2], strict=True)
    ]


def _draw_traction(
    t: Array, force: Array, contact: NDArray[np.bool_], title: str, simulated: bool
) -> Figure:
    figure, panels = _leg_panels(title, simulated)
    limits = _limits(force[contact], least=0.5)
    for leg, axes in panels:
        _shade(axes, t, contact[:, leg])
        axes.plot(t, force[:, leg, 0], color=BLUE, lw=0.9, label="forward")
        axes.plot(t, force[:, leg, 1], color=RED, lw=0.9, label="to the left")
        axes.set_ylim(limits)
    _label(figure, "traction force [N]", force)
    legend_below(figure, columns=2)
    return figure


def _leg_panels(title: str, simulated: bool) -> tuple[Figure, Iterator[tuple[int, Axes]]]:
    """Return a figure and its panels, laid out as the legs are seen from above."""
    figure = new_figure(title, simulated, width=8.0, height=6.2)
    panels = figure.subplots(3, 2, sharex=True, sharey=True).ravel()
    for leg, axes in enumerate(panels):
        axes.set_title(f"leg {leg + 1}, {_NAMES[leg]}", loc="left")
        axes.yaxis.set_major_locator(MaxNLocator(5))
    return figure, iter(enumerate(panels))


def _shade(axes: Axes, t: Array, contact: NDArray[np.bool_]) -> None:
    for start, end in stances(t, contact):
        axes.axvspan(start, end, color=_STANCE, lw=0, zorder=0)
    axes.axhline(0, color="0.6", lw=0.5, zorder=1)
    axes.set_xlim(t[0], t[-1])


def _limits(values: Array, *, least: float, cut: float = 0.01) -> tuple[float, float]:
    """Return limits that hold zero and all values but a share `cut` at either end.

    Impacts of a few samples would flatten all else. Limits are not closer than `least`.
    """
    finite = values[np.isfinite(values)]
    low, high = np.quantile(finite, (cut, 1 - cut)) if len(finite) else (0.0, 0.0)
    low, high = min(float(low), 0.0), max(float(high), 0.0)
    margin = 0.1 * max(high - low, least)
    return low - margin, high + margin


def _label(figure: Figure, what: str, values: Array) -> None:
    """Label the axes; add a note if the model does not compute the quantity."""
    figure.supylabel(what, fontsize=9.0)
    for axes in figure.axes[-2:]:
        axes.set_xlabel("time [s]")
        axes.xaxis.set_major_locator(MaxNLocator(5))
    if not np.isfinite(values).any():
        for axes in figure.axes:
            axes.text(
                0.5, 0.7, "this model computes none", ha="center", color="0.4",
                transform=axes.transAxes,
            )  # fmt: skip
