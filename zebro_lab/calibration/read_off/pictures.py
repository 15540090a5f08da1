# SPDX-License-Identifier: MIT
"""Picture of the curves that coefficients were read off."""

import math
from collections.abc import Sequence

import numpy as np
from matplotlib.figure import Figure

from model.slip.load_curves import LoadCurve
from model.slip.magic_formula import magic_formula, peak_slip
from model.slip.read_off import ReadOff
from zebro_lab.plots.sheet import (
    BLUE,
    RED,
    TRACTION_LABEL,
    legend_below,
    new_figure,
    plain,
    slip_grid,
    slip_label,
    styled,
)


@styled
def read_curves(
    curves: Sequence[tuple[LoadCurve, str, ReadOff | None]], *, definition: str, simulated: bool
) -> Figure:
    """Draw the points of each curve and the Magic Formula that was read off them.

    Args:
        curves: Points, side and coefficients of each curve; None where it gave none.
        definition: Slip definition of the points.
        simulated: Whether to append "(simulated)" to the title.

    Returns:
        The figure, a panel for each curve.
    """
    columns = min(2, len(curves))
    rows = math.ceil(len(curves) / columns)
    figure = new_figure(
        "Coefficients read off slip curves", simulated, width=4.5 * columns, height=1.2 + 2.5 * rows
    )
    for index, (curve, side, found) in enumerate(curves):
        axes = figure.add_subplot(rows, columns, index + 1)
        slip, force = curve.slip, curve.force
        said = "nothing read off"
        axes.plot(slip, force, ls="none", marker="o", ms=3, color="0.35", label="points")
        if found is not None:
            B, C, D, E = found.B, found.C, found.D, found.E
            pairs = zip("BCDE", (B, C, D, E), strict=True)
            said = ", ".join(f"{name} {plain(value)}" for name, value in pairs)
            grid = slip_grid(np.append(slip, 0.0), 300)
            label = "formula read off"
            axes.plot(grid, magic_formula(grid, B, C, D, E), color=BLUE, lw=1.3, label=label)
            axes.plot(
                float(peak_slip(B, C, E)), D, ls="none", marker="D", ms=5, color=RED, label="peak"
            )
        axes.set_title(f"{plain(curve.load)} N, {side}: {said}", loc="left", fontsize=9)
        axes.set_ylim(bottom=min(0.0, float(force.min())))
        if index + columns >= len(curves):
            axes.set_xlabel(slip_label(definition))
        if index % columns == 0:
            axes.set_ylabel(TRACTION_LABEL)
    legend_below(figure, columns=3)
    return figure
