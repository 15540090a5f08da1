# SPDX-License-Identifier: MIT
"""Picture of a comparison: overlaid slip curves, or overlaid tracks."""

from collections.abc import Sequence

import numpy as np
from matplotlib.axes import Axes
from matplotlib.figure import Figure

from zebro_lab.plots import sheet
from zebro_lab.validation.compare.values import Comparison, Curve

_COLOURS = (sheet.BLUE, sheet.RED)
_DOTS = (6.0, 3.5)  # points: a dot under another is seen as a ring


@sheet.styled
def overlay(compared: Comparison, *, simulated: bool) -> Figure:
    """Draw both slip curves overlaid, a panel for each load, or both tracks in one panel.

    If any curve peaks at a slip of less than `sheet.NARROW` of the largest, a second row of panels
    enlarges these small slips at every load.

    Args:
        compared: The comparison.
        simulated: Whether to append "(simulated)" to the title.

    Returns:
        The figure.
    """
    columns = max(1, len(compared.curves))
    rows = 1 + any(_has_narrow_peak(curve) for curve in compared.curves)
    title = f"{compared.names[0]} and {compared.names[1]}"
    figure = sheet.new_figure(
        title, simulated, width=max(6.0, 3.2 * columns), height=1.0 + 3.4 * rows
    )
    grid = figure.subplots(rows, columns, squeeze=False)
    for i, curve in enumerate(compared.curves):
        for axes in grid[:, i]:
            _draw_curve(axes, curve, compared.names)
        grid[0, i].set_title(f"load {curve.load:.3g} N", loc="left")
        if rows > 1:
            near = sheet.NARROW * np.abs(curve.slip).max()
            grid[1, i].set_xlim(max(-near, float(curve.slip[0])), near)
        grid[-1, i].set_xlabel(sheet.slip_label(compared.definition))
    for axes in grid[:, 0]:
        axes.set_ylabel(sheet.TRACTION_LABEL)
    for i, track in enumerate(compared.paths):
        label = f"{compared.names[i]}, tracked"
        grid[0, 0].plot(*track.position.T, "o", ms=_DOTS[i], color=_COLOURS[i], label=label)
        sheet.map_axes(grid[0, 0])
        grid[0, 0].set_xlabel("x from the start [m]")
    sheet.legend_below(figure, columns=4)
    return figure


def _has_narrow_peak(curve: Curve) -> bool:
    """Return whether either mean curve peaks at less than `sheet.NARROW` of the largest slip."""
    means = np.abs(curve.bands[:, 1])
    at = np.abs(curve.slip[np.nanargmax(means[np.isfinite(means).any(axis=1)], axis=1)])
    return bool(np.any(at < sheet.NARROW * np.abs(curve.slip).max()))


def _draw_curve(axes: Axes, curve: Curve, names: Sequence[str]) -> None:
    """Draw block means and both curves; one without uncertainty is a line without a band."""
    if curve.points.size:
        axes.plot(
            *curve.points, ls="none", marker="o", ms=3, mew=0, color="0.35", zorder=1.5,
            alpha=sheet.point_alpha(curve.points.shape[1]), label="block means, load within 10 %",
        )  # fmt: skip
    for (low, mean, high), colour, name in zip(curve.bands, _COLOURS, names, strict=True):
        axes.plot(curve.slip, mean, color=colour, lw=1.2, label=name)
        if not np.array_equal(low, high, equal_nan=True):
            label = f"{name}: band of 90 % of whole curves"
            axes.fill_between(curve.slip, low, high, color=colour, alpha=0.25, lw=0, label=label)
    axes.grid(color="0.92", lw=0.6)
