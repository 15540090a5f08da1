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
    NARROW,
    RED,
    TRACTION_LABEL,
    legend_below,
    map_axes,
    new_figure,
    point_alpha,
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
    if compared.curves:
        figure, below = _curve_panels(title, compared, simulated=simulated)
        letters = _TITLE_LETTERS
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


def _curve_panels(title: str, compared: Comparison, *, simulated: bool) -> tuple[Figure, Axes]:
    """Draw a panel for each load, and one below it of small slips if a peak lies there.

    Returns the figure and empty axes for the differences below.
    """
    n, columns = len(compared.quantities), len(compared.curves)
    narrow = any(_has_narrow_peak(curve) for curve in compared.curves)
    below = 0.6 + 0.25 * n
    heights = (3.6, 3.0, below) if narrow else (3.6, below)
    figure = new_figure(
        title, simulated, width=max(9.0, 3.2 * columns), height=1.0 + 0.95 * sum(heights)
    )
    grid = figure.add_gridspec(len(heights), columns, height_ratios=heights)
    for i, curve in enumerate(compared.curves):
        panels = [figure.add_subplot(grid[0, i])]
        _draw_curve(panels[0], curve, _marked(compared), compared.band)
        panels[0].set_title(f"load {curve.load:.3g} N", loc="left")
        if narrow:
            panels.append(figure.add_subplot(grid[1, i]))
            _draw_curve(panels[1], _narrowed(curve), _marked(compared), compared.band)
        panels[-1].set_xlabel(slip_label(compared.definition))
        if i == 0:
            for axes in panels:
                axes.set_ylabel(TRACTION_LABEL)
    return figure, figure.add_subplot(grid[-1, :])


def _has_narrow_peak(curve: Curve) -> bool:
    at = np.abs(curve.slip[np.nanargmax(np.abs(curve.bands[:, 1]), axis=1)])
    return bool(np.any(at < NARROW * np.abs(curve.slip).max()))


def _narrowed(curve: Curve) -> Curve:
    """Return the part of a curve at small slips."""
    reach = NARROW * np.abs(curve.slip).max()
    kept, near = np.abs(curve.slip) <= reach, np.abs(curve.points[0]) <= reach
    return Curve(curve.slip[kept], curve.load, curve.bands[..., kept], curve.points[:, near])


def _draw_curve(axes: Axes, curve: Curve, names: Sequence[str], band: str) -> None:
    """Draw block means and both curves; one without uncertainty is a line without a band."""
    if curve.points.size:
        axes.plot(
            *curve.points, ls="none", marker="o", ms=3, mew=0, color="0.35", zorder=1.5,
            alpha=point_alpha(curve.points.shape[1]), label="block means, load within 10 %",
        )  # fmt: skip
    for (low, median, high), colour, name in zip(curve.bands, _COLOURS, names, strict=True):
        is_line = np.array_equal(low, high, equal_nan=True)
        axes.plot(curve.slip, median, color=colour, lw=1.2, label=name if is_line else
                  f"{name}: median")  # fmt: skip
        if not is_line:
            axes.fill_between(
                curve.slip, low, high, color=colour, alpha=0.25, lw=0, label=f"{name}: {band}"
            )
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
