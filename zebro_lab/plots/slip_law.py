# SPDX-License-Identifier: MIT
"""Plot a slip law without data: curves at some loads, and the surface over slip and load."""

from typing import Final

import numpy as np
from matplotlib.figure import Figure

from model.slip.curve import SlipCurve
from zebro_lab.plots.sheet import (
    CYCLE,
    TRACTION_LABEL,
    legend_below,
    new_figure,
    plain,
    slip_grid,
    slip_label,
    styled,
)
from zebro_lab.plots.surface import surface_axes

THESIS_LOADS: Final = (2.13, 6.63, 8.13, 12.75)
"""Loads of Fig. 4-14 [N]."""


@styled
def slip_law(curve: SlipCurve, *, title: str, simulated: bool) -> Figure:
    """Draw traction over slip at four loads, and over slip and load (Fig. 4-14 to 4-16).

    Args:
        curve: The slip curve.
        title: Title of the figure.
        simulated: Whether to append "(simulated)" to the title.

    Returns:
        The figure: the loads are those of the thesis that were tested for this curve, or if these
        are fewer than two, four from the least to the largest tested one. Dots are the peaks.
    """
    loads = _loads(curve)
    figure = new_figure(title, simulated, width=10.0, height=4.4)
    axes = figure.add_subplot(1, 2, 1)
    slip = slip_grid(np.asarray(curve.slip_range), 400)
    for load, colour in zip(loads, CYCLE, strict=False):
        force = curve.force(slip, load, definition=curve.definition)
        peak = int(force.argmax())
        axes.plot(slip, force, color=colour, lw=1.3, label=f"load {load:.4g} N")
        axes.plot(slip[peak], force[peak], marker="o", ms=4, color=colour)
        axes.annotate(
            f"{plain(float(force[peak]))} N at {plain(float(slip[peak]))}",
            (slip[peak], force[peak]), xytext=(6, 3), textcoords="offset points", fontsize=8,
        )  # fmt: skip
    axes.set(xlabel=slip_label(curve.definition), ylabel=TRACTION_LABEL)
    axes.grid(color="0.92", lw=0.6)
    axes.margins(y=0.1)
    _draw_surface(figure, curve)
    legend_below(figure, columns=4)
    return figure


def _loads(curve: SlipCurve) -> tuple[float, ...]:
    low, high = curve.load_range
    inside = tuple(load for load in THESIS_LOADS if 0.99 * low <= load <= 1.01 * high)
    return inside if len(inside) > 1 else tuple(np.linspace(low, high, 4).tolist())


def _draw_surface(figure: Figure, curve: SlipCurve) -> None:
    slip, load = np.meshgrid(
        slip_grid(np.asarray(curve.slip_range), 60), np.linspace(*curve.load_range, 25)
    )
    force = curve.force(slip, load, definition=curve.definition)
    surface_axes(figure, 122, slip, load, force, definition=str(curve.definition))
