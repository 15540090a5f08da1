# SPDX-License-Identifier: MIT
"""Plot the slip surface: traction over slip and load."""

from typing import cast

import numpy as np
from matplotlib.figure import Figure
from mpl_toolkits.mplot3d import Axes3D
from numpy.typing import ArrayLike

from model.arrays import Array
from model.bayes.averaging.blocks import SlipBlocks
from model.slip.law import SlipLaw
from zebro_lab.plots.sheet import (
    few_ticks,
    legend_below,
    new_figure,
    point_alpha,
    slip_grid,
    slip_label,
    styled,
)


@styled
def slip_surface(blocks: SlipBlocks, law: SlipLaw, *, values: ArrayLike, simulated: bool) -> Figure:
    """Draw traction over slip and load as a surface, with the block means (compare Fig. 4-15).

    Args:
        blocks: Block means of slip ratio and forces.
        law: Slip law to evaluate.
        values: Parameter values of the law, shape (k,).
        simulated: Whether to append "(simulated)" to the title.

    Returns:
        The figure. The surface covers the tested slip and load; loads within a tenth of the largest
        get a margin of a fifth either side, to have a surface at all. Points behind it show
        through.
    """
    load_low, load_high = float(blocks.normal_force.min()), float(blocks.normal_force.max())
    if load_high - load_low < 0.1 * load_high:
        load_low, load_high = 0.8 * load_low, 1.2 * load_high
    slip, load = np.meshgrid(slip_grid(blocks.slip, 60), np.linspace(load_low, load_high, 25))
    force = law.force(slip, load, np.asarray(values, dtype=float))
    figure = new_figure("Slip surface", simulated, width=7.0, height=5.0)
    axes = surface_axes(figure, 111, slip, load, force, definition=str(blocks.definition))
    for row in range(0, len(load), 4):
        axes.plot(slip[row], load[row], force[row], color="0.2", lw=0.5, label="law at one load")
    axes.plot(
        blocks.slip, blocks.normal_force, blocks.traction_force, ls="none", marker="o", ms=2.8,
        mew=0.2, mec="white", color="black", alpha=point_alpha(len(blocks.slip)),
        label="block means",
    )  # fmt: skip
    legend_below(figure, columns=2)
    return figure


def surface_axes(
    figure: Figure, place: int, slip: Array, load: Array, force: Array, *, definition: str
) -> Axes3D:
    """Add axes with traction over slip and load as a surface.

    Args:
        figure: The figure.
        place: Place of the axes, as of `Figure.add_subplot`.
        slip: Slip ratios, shape (m, n) [-].
        load: Normal forces, shape (m, n) [N].
        force: Traction forces, shape (m, n) [N].
        definition: Slip definition.
    """
    axes = cast("Axes3D", figure.add_subplot(place, projection="3d", computed_zorder=False))
    axes.plot_surface(
        slip, load, force, cmap="viridis", linewidth=0, antialiased=False, rstride=1, cstride=1
    )
    axes.set_xlabel(slip_label(definition), labelpad=8)
    axes.set_ylabel("normal force [N]", labelpad=6)
    axes.set_zlabel("traction force, also as colour [N]", labelpad=8)
    axes.zaxis.set_tick_params(pad=5)
    for axis in (axes.xaxis, axes.yaxis, axes.zaxis):
        axis.set_major_locator(few_ticks(5))
    axes.view_init(elev=24, azim=-125)
    # matplotlib's default makes checkers think zoom an int
    axes.set_box_aspect((1.25, 1.0, 0.75), zoom=1.06)  # pyright: ignore[reportArgumentType]
    return axes
