# SPDX-License-Identifier: MIT
"""Plot several slip laws over the same data, one row for each tested load."""

from collections.abc import Mapping

import numpy as np
from matplotlib.axes import Axes
from matplotlib.figure import Figure
from matplotlib.ticker import FixedLocator
from numpy.typing import ArrayLike

from model.arrays import Array
from model.bayes.averaging.blocks import SlipBlocks
from model.bayes.likelihood import at_load
from model.slip.law import SlipLaw
from zebro_lab.plots import sheet

_BINS = 16  # of slip at each load, whose means are drawn beside the differences of the laws
_TICKS = (-1.0, -0.3, -0.1, -0.03, 0.0, 0.03, 0.1, 0.3, 1.0)
_STYLES = ("-", "--", "-.", ":")


@sheet.styled
def slip_laws(
    blocks: SlipBlocks,
    laws: Mapping[str, tuple[SlipLaw, Array]],
    *,
    reference: str,
    load_levels: ArrayLike,
    page: sheet.Page,
) -> Figure:
    """Draw the data and the curve of every law at each tested load, and how they differ.

    On the left are block means and each law's median curve; on the right the curves less that of
    the reference law, and means of the residuals with their standard errors, in bins of equally
    many blocks. Slip is drawn on a square-root scale, on which both the rise and the fall of the
    curves are seen.

    Args:
        blocks: Block means of slip ratio and forces, corrected for what the fit estimated.
        laws: Each law, of k parameters, with posterior draws of them, shape (n_draws, k), by name.
        reference: Name of the law with which all laws are compared.
        load_levels: Nominal loads, shape (n_levels,) [N].
        page: Whether data are simulated, and width of the figure.

    Returns:
        The figure.
    """
    levels = np.sort(np.ravel(np.asarray(load_levels, dtype=float)))
    nearest = np.argmin(np.abs(blocks.normal_force[:, None] - levels), axis=1)
    fitted, values = laws[reference][0], laws[reference][1].mean(axis=0)
    width, narrow = page.width or 9.0, page.narrow
    height = 1.6 + 1.4 * narrow + max(0.25 * width, 1.2) * len(levels)
    figure = sheet.new_figure("Slip laws compared", page.simulated, width=width, height=height)
    panels = figure.subplots(len(levels), 2, squeeze=False)
    for row, (load, (whole, beside)) in enumerate(zip(levels, panels, strict=True)):
        mine = nearest == row
        slip = sheet.slip_grid(blocks.slip[mine] if mine.any() else blocks.slip, 250)
        force = at_load(blocks, fitted, values, load)
        whole.scatter(
            blocks.slip[mine], force[mine], s=9, color="0.35", linewidths=0,
            alpha=sheet.point_alpha(int(mine.sum())), label="block means, corrected",
        )  # fmt: skip
        residual = force - fitted.force(blocks.slip, load, values)
        _draw_means(beside, blocks.slip[mine], residual[mine])
        base = _median(laws[reference], slip, load)
        for index, (name, law) in enumerate(laws.items()):
            force = _median(law, slip, load)
            is_fitted = name == reference
            style = {
                "color": sheet.CYCLE[index % len(sheet.CYCLE)],
                "ls": "-" if is_fitted else _STYLES[index % len(_STYLES)],
                "lw": 2.0 if is_fitted else 1.2,
            }
            whole.plot(slip, force, label=f"{name} (fitted)" if is_fitted else name, **style)
            beside.plot(slip, force - base, **style)
        whole.set_title(f"load {load:.4g} N", loc="left")
        beside.set_title("less the fitted law", loc="left")
        whole.set_ylabel("traction [N]")
        beside.set_ylabel("difference [N]")
    for axes in panels[-1, : 2 - narrow]:
        axes.set_xlabel(sheet.slip_label(blocks.definition, width / 2))
    for axes in panels.flat:
        axes.set_xscale("function", functions=(_root, _square))
        axes.xaxis.set_major_locator(FixedLocator(_TICKS[:: 1 + narrow]))
        axes.axhline(0, color="0.6", lw=0.5, zorder=0)
    sheet.legend_below(figure, columns=2)
    return figure


def _median(law: tuple[SlipLaw, Array], slip: Array, load: ArrayLike) -> Array:
    """Compute the median traction of a law's draws at slips and loads, shape (n,) [N]."""
    formula, draws = law
    return np.median(formula.force(slip, load, draws.T[:, :, None]), axis=0)


def _draw_means(axes: Axes, slip: Array, residual: Array) -> None:
    """Draw means of residuals in bins of equally many blocks, with their standard errors.

    There is a bin for every three blocks, at most `_BINS`; a single block has an error of 0.
    """
    if not len(slip):
        return
    parts = np.array_split(np.argsort(slip), min(_BINS, max(1, len(slip) // 3)))
    error = [np.std(residual[part], ddof=1) / np.sqrt(len(part)) if len(part) > 1 else 0.0
             for part in parts]  # fmt: skip
    axes.errorbar(
        [float(slip[part].mean()) for part in parts],
        [float(residual[part].mean()) for part in parts], error,
        fmt="o", ms=3.5, color="0.2", lw=0.8, zorder=3,
        label="measured less fitted: bin means, standard errors",
    )  # fmt: skip


def _root(slip: Array) -> Array:
    """Map slip ratios to the scale of the axis, the square root with its sign."""
    return np.sign(slip) * np.sqrt(np.abs(slip))


def _square(position: Array) -> Array:
    """Map positions on the axis to slip ratios, the inverse of `_root`."""
    return np.sign(position) * np.square(position)
