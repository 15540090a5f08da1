# SPDX-License-Identifier: MIT
"""Plot when the legs of a walk are on the ground, and its contact states, over time."""

from collections.abc import Sequence

import numpy as np
from matplotlib.axes import Axes
from matplotlib.figure import Figure
from numpy.typing import NDArray

from model.arrays import Array
from model.contact.sequence import ContactState, named_legs
from model.robot import LEFT, N_LEGS
from model.walk.path import WalkPath
from zebro_lab.plots.sheet import BLUE, PALE_BLUE, RED, legend_below, new_figure, styled, time_axis

NAMES = ("left front", "right front", "left middle", "right middle", "left rear", "right rear")
"""Names of the legs in their order."""
_WIDTH = 9.0  # in
_LABEL = 0.13  # in, of a label's width on the page
_DRAWN = 0.9  # of the figure's width


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
    _draw_bars(axes, path, path.t)
    axes.set(ylim=(N_LEGS + 0.7, 0.3))
    axes.set_yticks(range(1, N_LEGS + 1), [f"{i}  {name}" for i, name in enumerate(NAMES, 1)])
    axes.grid(axis="x", color="0.9", lw=0.6)
    axes.set_axisbelow(True)
    legend_below(figure, columns=2)
    return figure


@styled
def contact_states_chart(
    path: WalkPath, states: Sequence[ContactState], span: tuple[float, float], *, title: str
) -> Figure:
    """Draw contact states over time, Eq. (3-33), above the legs' bars as in Fig. 2-1.

    Args:
        path: The walk.
        states: Its contact states, in which short states are joined to the next.
        span: Begin and end of the time to draw [s].
        title: Title of the figure, which names the model; "(simulated)" is appended.

    Returns:
        The figure: a row for each leg, leg 1 on top, left legs darker, and above them the legs of
        each state that is wide enough for its label.
    """
    figure = new_figure(title, True, width=_WIDTH, height=3.3)
    axes = figure.subplots()
    _draw_bars(axes, path, np.array(span))
    axes.set(ylim=(N_LEGS + 0.6, -2.2), yticks=range(1, N_LEGS + 1), ylabel="leg; left darker")
    _draw_states(axes, states, span)
    axes.set_xlim(span)
    return figure


def _draw_bars(axes: Axes, path: WalkPath, t: Array) -> None:
    """Draw a bar in the row of each leg while it is on the ground; the axis of time shows `t`."""
    for leg in range(N_LEGS):
        bars = [(start, end - start) for start, end in stances(path.t, path.contact[:, leg])]
        colour, side = (BLUE, "left") if leg in LEFT else (PALE_BLUE, "right")
        axes.broken_barh(
            bars, (leg + 0.6, 0.8), facecolors=colour, lw=0, label=f"{side} leg on the ground"
        )
    axes.tick_params(axis="y", length=0)
    time_axis(axes, t)


def _draw_states(axes: Axes, states: Sequence[ContactState], span: tuple[float, float]) -> None:
    """Draw a line where each state begins, and its legs where there is room."""
    room = (span[1] - span[0]) * _LABEL / (_DRAWN * _WIDTH)
    for state in states:
        begin, end = max(state.start, span[0]), min(state.end, span[1])
        if end <= begin:
            continue
        if state.start > span[0]:
            axes.axvline(state.start, color="0.75", lw=0.6, zorder=0)
        if end - begin >= room:
            axes.text(
                (begin + end) / 2, 0.4, named_legs(state.legs), rotation=90, ha="center",
                va="bottom", fontsize=7.0,
            )  # fmt: skip


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
