# SPDX-License-Identifier: MIT
"""Plot the contact states of a walk over time."""

from collections.abc import Sequence

import numpy as np
from matplotlib.axes import Axes
from matplotlib.figure import Figure

from model.contact.sequence import ContactState, named_legs
from model.robot import LEFT, N_LEGS
from model.walk.path import WalkPath
from zebro_lab.plots.sheet import BLUE, new_figure, styled, time_axis
from zebro_lab.plots.walk_legs import stances

_PALE_BLUE = "#56B4E9"
_WIDTH = 9.0  # in
_LABEL = 0.13  # in, of a label's width on the page
_DRAWN = 0.9  # of the figure's width


@styled
def contact_states_chart(
    path: WalkPath, states: Sequence[ContactState], span: tuple[float, float], *, title: str
) -> Figure:
    """Draw contact states over time, Eq. (3-33), above the legs' bars as in Fig. 2-1.

    Args:
        path: The walk.
        states: Its contact states, short ones joined.
        span: Begin and end of the time to draw [s].
        title: Title of the figure, which names the model; "(simulated)" is appended.

    Returns:
        The figure: a row for each leg, leg 1 on top, left legs darker, and above them the legs of
        each state that is wide enough for its label.
    """
    figure = new_figure(title, True, width=_WIDTH, height=3.3)
    axes = figure.subplots()
    for leg in range(N_LEGS):
        bars = [(begin, end - begin) for begin, end in stances(path.t, path.contact[:, leg])]
        colour = BLUE if leg in LEFT else _PALE_BLUE
        axes.broken_barh(bars, (leg + 0.65, 0.7), facecolors=colour, lw=0)
    axes.set(ylim=(N_LEGS + 0.6, -2.2), yticks=range(1, N_LEGS + 1), ylabel="leg; left darker")
    axes.tick_params(axis="y", length=0)
    _draw_states(axes, states, span)
    time_axis(axes, np.array(span))
    axes.set_xlim(span)
    return figure


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
