# SPDX-License-Identifier: MIT
"""Plot slip laws: the surface over slip and load, and the curves of a law without data."""

from typing import Any, Final, cast

import numpy as np
from matplotlib.figure import Figure
from mpl_toolkits.mplot3d import Axes3D
from numpy.typing import ArrayLike

from model.arrays import Array
from model.bayes.averaging.blocks import SlipBlocks
from model.slip.curve import SlipCurve
from model.slip.law import SlipLaw
from zebro_lab.plots import sheet


@sheet.styled
def slip_surface(
    blocks: SlipBlocks, law: SlipLaw, *, values: ArrayLike, page: sheet.Page
) -> Figure:
    """Draw traction over slip and load as a surface, with the block means (compare Fig. 4-15).

    Args:
        blocks: Block means of slip ratio and forces, corrected for what the fit estimated.
        law: Slip law to evaluate.
        values: Parameter values of the law, shape (k,).
        page: Whether data are simulated, and width of the figure.

    Returns:
        The figure. The surface covers the tested slip and load; loads within a tenth of the largest
        get a margin of a fifth either side, to have a surface at all. Points behind it show
        through.
    """
    load_low, load_high = float(blocks.normal_force.min()), float(blocks.normal_force.max())
    if load_high - load_low < 0.1 * load_high:
        load_low, load_high = 0.8 * load_low, 1.2 * load_high
    slip, load = np.meshgrid(sheet.slip_grid(blocks.slip, 60), np.linspace(load_low, load_high, 25))
    force = law.force(slip, load, np.asarray(values, dtype=float))
    width = page.width or 7.0
    height = 0.8 + 0.65 * width
    figure = sheet.new_figure("Slip surface", page.simulated, width=width, height=height)
    axes = surface_axes(figure, 111, slip, load, force, definition=str(blocks.definition))
    for row in range(0, len(load), 4):
        axes.plot(slip[row], load[row], force[row], color="0.2", lw=0.5, label="law at one load")
    axes.plot(
        blocks.slip, blocks.normal_force, blocks.traction_force, ls="none", marker="o", ms=2.8,
        mew=0.2, mec="white", color="black", alpha=sheet.point_alpha(len(blocks.slip)),
        label="block means, corrected",
    )  # fmt: skip
    sheet.legend_below(figure, columns=2)
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
    axes.set_xlabel(sheet.slip_label(definition), labelpad=0)
    axes.set_ylabel("normal force [N]", labelpad=3)
    axes.set_zlabel("traction force [N]", labelpad=2)
    for axis in (axes.xaxis, axes.yaxis, axes.zaxis):
        axis.set_tick_params(pad=1)
        axis.set_major_locator(sheet.few_ticks(3))
    axes.view_init(elev=24, azim=-125)
    # In a small figure the labels, which zoom does not shrink, need more of the room.
    zoom: Any = min(1.06, 0.68 + 0.05 * figure.get_figwidth())  # checkers take it for an int
    axes.set_box_aspect((1.25, 1.0, 0.75), zoom=zoom)
    return axes


THESIS_LOADS: Final = (2.13, 6.63, 8.13, 12.75)
"""Loads of Fig. 4-14 [N]."""


@sheet.styled
def slip_law(curve: SlipCurve, *, title: str, simulated: bool) -> Figure:
    """Draw traction over slip at two to four loads, and over slip and load (Fig. 4-14 to 4-16).

    Args:
        curve: The slip curve.
        title: Title of the figure.
        simulated: Whether to append "(simulated)" to the title.

    Returns:
        The figure: the loads are those of the thesis that were tested for this curve, or if these
        are fewer than two, four from the least to the largest tested one. Dots are at the largest
        forward force.
    """
    loads = _loads(curve)
    figure = sheet.new_figure(title, simulated, width=10.0, height=4.4)
    axes = figure.add_subplot(1, 2, 1)
    slip = sheet.slip_grid(np.asarray(curve.slip_range), 400)
    for load, colour in zip(loads, sheet.CYCLE, strict=False):
        force = curve.force(slip, load, definition=curve.definition)
        peak = int(force.argmax())
        axes.plot(slip, force, color=colour, lw=1.3, label=f"load {load:.4g} N")
        axes.plot(slip[peak], force[peak], marker="o", ms=4, color=colour)
        axes.annotate(
            f"{sheet.plain(float(force[peak]))} N at {sheet.plain(float(slip[peak]))}",
            (slip[peak], force[peak]), xytext=(6, 3), textcoords="offset points", fontsize=8,
        )  # fmt: skip
    axes.set(xlabel=sheet.slip_label(curve.definition), ylabel=sheet.TRACTION_LABEL)
    axes.grid(color="0.92", lw=0.6)
    axes.margins(y=0.1)
    _draw_surface(figure, curve)
    sheet.legend_below(figure, columns=4)
    return figure


def _loads(curve: SlipCurve) -> tuple[float, ...]:
    """Return the thesis's loads in the tested range, with a margin of 1 % [N].

    If they are fewer than two, four loads evenly spaced over the tested range are returned.
    """
    low, high = curve.load_range
    inside = tuple(load for load in THESIS_LOADS if 0.99 * low <= load <= 1.01 * high)
    return inside if len(inside) > 1 else tuple(np.linspace(low, high, 4).tolist())


def _draw_surface(figure: Figure, curve: SlipCurve) -> None:
    """Draw traction over the tested slips and loads as a surface, on the right of the figure."""
    slip, load = np.meshgrid(
        sheet.slip_grid(np.asarray(curve.slip_range), 60), np.linspace(*curve.load_range, 25)
    )
    force = curve.force(slip, load, definition=curve.definition)
    surface_axes(figure, 122, slip, load, force, definition=str(curve.definition))
