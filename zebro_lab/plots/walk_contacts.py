# SPDX-License-Identifier: MIT
"""Plot the contact states of a walk over time, by one rule or two, one below the other."""

from collections.abc import Sequence
from typing import NamedTuple

import numpy as np
from matplotlib.axes import Axes
from matplotlib.figure import Figure
from numpy.typing import NDArray

from model.arrays import Array
from model.contact.sequence import ContactState, named_legs
from model.robot import LEFT, N_LEGS
from zebro_lab.plots.sheet import BLUE, new_figure, styled, time_axis
from zebro_lab.plots.walk_legs import stances

_PALE_BLUE = "#56B4E9"
_WIDTH = 9.0  # in
_LABEL = 0.13  # in, of a label's width on the page
_DRAWN = 0.9  # of the figure's width


class DrawnContacts(NamedTuple):
    """Contacts by one rule, to draw.

    Attributes:
        rule: What decides contact, in words.
        t: Times, shape (n,) [s].
        contact: Which legs are on the ground, shape (n, 6).
        states: The contact states, short ones joined.
    """

    rule: str
    t: Array
    contact: NDArray[np.bool_]
    states: Sequence[ContactState]


@styled
def contact_states_chart(
    drawn: Sequence[DrawnContacts], span: tuple[float, float], *, title: str
) -> Figure:
    """Draw contact states over time, Eq. (3-33), above the legs' bars as in Fig. 2-1.

    Args:
        drawn: Contacts by each rule; a panel each.
        span: Begin and end of the time to draw [s].
        title: Title of the figure, which names the model; "(simulated)" is appended.

    Returns:
        The figure: in a panel a row for each leg, leg 1 on top, left legs darker, and above it the
        legs of each state that is wide enough for its label.
    """
    figure = new_figure(title, True, width=_WIDTH, height=0.7 + 2.6 * len(drawn))
    panels = np.atleast_1d(figure.subplots(len(drawn), 1, sharex=True))
    for axes, each in zip(panels, drawn, strict=True):
        _draw_legs(axes, each)
        _draw_states(axes, each.states, span)
        axes.set_title(f"by {each.rule}", loc="left")
    time_axis(panels[-1], np.array(span))
    panels[-1].set_xlim(span)
    return figure


def _draw_legs(axes: Axes, drawn: DrawnContacts) -> None:
    """Draw a bar for each contact of each leg."""
    for leg in range(N_LEGS):
        bars = [(begin, end - begin) for begin, end in stances(drawn.t, drawn.contact[:, leg])]
        colour = BLUE if leg in LEFT else _PALE_BLUE
        axes.broken_barh(bars, (leg + 0.65, 0.7), facecolors=colour, lw=0)
    axes.set(ylim=(N_LEGS + 0.6, -2.2), yticks=range(1, N_LEGS + 1), ylabel="leg; left darker")
    axes.tick_params(axis="y", length=0)


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
