# SPDX-License-Identifier: MIT
"""Picture of a comparison: overlaid curves or paths, and differences."""

import textwrap
from collections.abc import Sequence

import numpy as np
from matplotlib.axes import Axes
from matplotlib.figure import Figure

from model.metrics.difference import Difference
from zebro_lab.plots.sheet import (
    BLUE,
    RED,
    TRACTION_LABEL,
    legend_below,
    map_axes,
    new_figure,
    slip_label,
    styled,
)
from zebro_lab.validation.compare.values import Comparison, Curve, RunPaths

_COLOURS = (BLUE, RED)
_DOTS = (6.0, 3.5)  # points: a dot under another is seen as a ring
_SHOWN_DRAWS = 40
_TITLE_LETTERS = 70  # in a line of the title above the differences
_CLEAR = "90 % interval of a difference, zero outside"
_UNCLEAR = "90 % interval of a difference, zero inside"


@styled
def overlay(compared: Comparison, differences: Sequence[Difference], *, simulated: bool) -> Figure:
    """Draw both curves or paths overlaid, and differences over half their 90 % intervals.

    The differences are below curves, and right of paths.

    Args:
        compared: The comparison.
        differences: Difference of each quantity of the comparison, in the same order.
        simulated: Whether to append "(simulated)" to the title.

    Returns:
        The figure.
    """
    title = f"{compared.names[0]} and {compared.names[1]}"
    n = len(compared.quantities)
    if compared.curves:
        figure = new_figure(title, simulated, width=9.0, height=4.6 + 0.25 * n)
        columns = len(compared.curves)
        grid = figure.add_gridspec(2, columns, height_ratios=(3.6, 0.6 + 0.25 * n))
        panels = [figure.add_subplot(grid[0, i]) for i in range(columns)]
        for axes, curve in zip(panels, compared.curves, strict=True):
            _draw_curve(axes, curve, _marked(compared))
            axes.set_xlabel(slip_label(compared.definition))
        panels[0].set_ylabel(TRACTION_LABEL)
        below, letters = figure.add_subplot(grid[1, :]), _TITLE_LETTERS
    else:
        figure = new_figure(title, simulated, width=9.0, height=5.2)
        above, below = figure.subplots(1, 2, width_ratios=(1.4, 1.0))
        _draw_paths(above, compared.paths, compared.names)
        letters = _TITLE_LETTERS // 2
    _draw_differences(below, compared, differences, letters=letters)
    legend_below(figure, columns=4)
    return figure


def _marked(compared: Comparison) -> list[str]:
    """Return the names of both calibrations, with a mark on one that is not trustworthy."""
    return [
        f"{name} (NOT TRUSTWORTHY)" if doubted else name
        for name, doubted in zip(compared.names, compared.doubted, strict=True)
    ]


def _draw_curve(axes: Axes, curve: Curve, names: Sequence[str]) -> None:
    for (low, median, high), colour, name in zip(curve.bands, _COLOURS, names, strict=True):
        axes.plot(curve.slip, median, color=colour, lw=1.2, label=f"{name}: median")
        axes.fill_between(
            curve.slip, low, high, color=colour, alpha=0.25, lw=0, label=f"{name}: 90 % of curves"
        )
    axes.set_title(f"load {curve.load:.3g} N", loc="left")
    axes.grid(color="0.92", lw=0.6)


def _draw_paths(axes: Axes, runs: Sequence[RunPaths], names: Sequence[str]) -> None:
    for run, colour, name, dot in zip(runs, _COLOURS, names, _DOTS, strict=True):
        if run.band is not None:
            for position in run.band.position[:_SHOWN_DRAWS]:
                axes.plot(*position.T, color=colour, lw=0.5, alpha=0.2)
            axes.plot([], [], color=colour, lw=1.0, label=f"{name}, predicted")
        if run.track is not None:
            axes.plot(
                *run.track.position.T, ls="none", marker="o", ms=dot, color=colour,
                label=f"{name}, tracked",
            )  # fmt: skip
    map_axes(axes)
    axes.set_xlabel("x from the start [m]")


def _draw_differences(
    axes: Axes, compared: Comparison, differences: Sequence[Difference], *, letters: int
) -> None:
    """Draw each difference, a row per quantity, over half the width of its 90 % interval."""
    for i, each in enumerate(differences):
        half = 0.5 * (each.high - each.low) or 1.0
        ends = np.array([each.low, each.high]) / half
        colour, label = ("black", _CLEAR) if each.clear else ("0.6", _UNCLEAR)
        axes.plot(ends, [i, i], color=colour, lw=2.0, label=label)
        axes.plot(
            each.median / half, i, ls="none", marker="o", ms=4, color="black", label="its median"
        )
    axes.axvline(0, color="0.5", lw=0.6)
    axes.set_yticks(range(len(differences)), [q.name for q in compared.quantities])
    axes.invert_yaxis()
    title = f"difference: {compared.names[1]} minus {compared.names[0]}"
    axes.set_title(textwrap.fill(title, letters), loc="left", parse_math=False)
    axes.set_xlabel("difference over half its 90 % interval [-]")
