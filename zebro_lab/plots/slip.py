# SPDX-License-Identifier: MIT
"""Plot slip curves, a row of panels for each tested load."""

from collections.abc import Sequence

import numpy as np
from matplotlib.axes import Axes
from matplotlib.figure import Figure
from numpy.typing import NDArray

from model.arrays import Array
from model.bayes.averaging.blocks import SlipBlocks
from model.bayes.likelihood import at_load
from model.slip.law import SlipLaw
from zebro_lab.plots import sheet

_CURVES = 400  # draws whose curves make the band
_MOST_POINTS = 150  # of a load; of more, every so many is drawn
_BAND = "90 % band of the curve,\nload cell's gain included"


@sheet.styled
def slip_curves(
    blocks: SlipBlocks,
    corrected: SlipBlocks,
    law: SlipLaw,
    *,
    draws: Array,
    plain: Array,
    loads: Array,
    peaks: Sequence[Array],
    of_runs: bool,
    page: sheet.Page,
) -> Figure:
    """Draw data, as measured and corrected, with posterior and plain curve, a row for each load.

    Each block is drawn at the nearest load, corrected ones with the traction that they would have
    at it. The band is that of the curve (parameters only), without noise and run offsets, over the
    slip tested at this load, or at all loads for one without blocks; it holds 90 % of the curves at
    each slip. If the first peak of any load is in the first 15 % of the tested slip, each load has
    a second panel for that part.

    Args:
        blocks: Block means of slip ratio and forces, as measured.
        corrected: The same blocks, corrected for what the fit estimated.
        law: Slip law of the draws.
        draws: Posterior draws of the law's parameters, shape (n_draws, k).
        plain: The law's parameters of the plain fit, shape (k,).
        loads: Nominal loads in rising order, one for each row of panels, shape (n_loads,) [N].
        peaks: Slip [-] and traction [N] of driving, then of braking peak at each load, shape
            (2, 2); those outside of the tested slip are not drawn.
        of_runs: Whether to draw the means of runs, and not up to 150 blocks of each load.
        page: Whether data are simulated, and width of the figure.

    Returns:
        The figure.
    """
    nearest = np.argmin(np.abs(blocks.normal_force[:, None] - loads), axis=1)
    mine = [nearest == index for index in range(len(loads))]
    tested = np.stack([blocks.slip, corrected.slip])
    slips = [sheet.slip_grid(tested[:, rows] if rows.any() else tested, 250) for rows in mine]
    peaks = [each[(each[:, 0] > slip[0]) & (each[:, 0] < slip[-1])]
             for each, slip in zip(peaks, slips, strict=True)]  # fmt: skip
    reach = sheet.NARROW * float(np.abs(blocks.slip).max())
    columns = 1 + any(abs(each[0, 0]) < reach for each in peaks if len(each))
    width = page.width or 3.5 + 1.8 * columns
    height = float(np.clip(0.55 * width / columns, 1.2, 1.5)) + 0.7 * (len(loads) == 1)
    figure = sheet.new_figure(
        "Slip curve by load", page.simulated, width=width, height=1.9 + height * len(loads)
    )
    grid = figure.subplots(len(loads), columns, squeeze=False, sharey="row")
    for panels, load, rows, slip, peak in zip(grid, loads, mine, slips, peaks, strict=True):
        force = at_load(corrected, law, draws.mean(axis=0), load)
        both = (blocks.slip, blocks.traction_force), (corrected.slip, force)
        points = [_points(np.stack(each)[:, rows], blocks.run[rows], of_runs) for each in both]
        curves = _curves(law, slip, load, draws, plain)
        for axes in panels:
            _draw(axes, points, slip, curves, peak, "run means" if of_runs else "block means")
        panels[0].set_ylabel("traction [N]")
        panels[0].set_title(f"load {load:.4g} N" + " (no points)" * (not rows.any()), loc="left")
        panels[-1].set_title(_peak_text(peak), loc="right")
        if columns > 1:
            low, high = max(-reach, slip[0]), min(reach, slip[-1])
            margin = 0.02 * (high - low)
            panels[1].set_xlim(low - margin, high + margin)
    for axes in grid[-1]:
        axes.set_xlabel(sheet.slip_label(blocks.definition, width / columns))
    sheet.legend_below(figure, columns=3)
    return figure


def _points(points: Array, run: NDArray[np.intp], of_runs: bool) -> Array:
    """Return the means (2, p) of points (2, n) over each run, or every so many of the points."""
    if not of_runs:
        return points[:, :: -(-len(run) // _MOST_POINTS) or 1]
    _, index, counts = np.unique(run, return_inverse=True, return_counts=True)
    return np.stack([np.bincount(index, each, len(counts)) / counts for each in points])


def _curves(law: SlipLaw, slip: Array, load: float, draws: Array, plain: Array) -> list[Array]:
    """Return lower edge, median and upper edge of the posterior, and the plain fit, (m,) each [N].

    The former are quantiles over every kth draw, `_CURVES` to twice as many, or all if fewer.
    """
    values = draws[:: max(1, len(draws) // _CURVES)].T[:, :, None]
    bands = np.quantile(law.force(slip, load, values), (0.05, 0.5, 0.95), axis=0)
    return [*bands, law.force(slip, load, plain)]


def _draw(
    axes: Axes, points: Sequence[Array], slip: Array, curves: Sequence[Array], peaks: Array,
    name: str,
) -> None:  # fmt: skip
    """Draw points and curves at one load.

    Args:
        axes: Axes to draw on.
        points: Points as measured, and corrected: slip [-] and traction [N], shape (2, p) each.
        slip: Slip ratios of the curves, shape (m,) [-].
        curves: The curves, as `_curves` has them.
        peaks: Slip [-] and traction [N] of each peak, shape (0 to 2, 2).
        name: What the points are.
    """
    (measured, corrected), (low, median, high, plain) = points, curves
    axes.plot(*measured, "o", ms=3, mfc="none", mec="0.65", mew=0.6, label=f"{name}, as measured")
    axes.plot(*corrected, "o", ms=3, mew=0, color="0.2", alpha=0.8, label="corrected")
    axes.plot(slip, median, color=sheet.BLUE, lw=1.0, label="posterior median")
    axes.fill_between(slip, low, high, color=sheet.tint(0.35), lw=0, zorder=1, label=_BAND)
    axes.plot(slip, plain, color="black", lw=0.6, ls="--", label="plain fit")
    if len(peaks):
        axes.plot(*peaks.T, "D", ms=4, color=sheet.RED, mec="white", mew=0.6, label="peak")
    axes.axhline(0, color="0.6", lw=0.5, zorder=0)


def _peak_text(peaks: Array) -> str:
    """Format the first of the peaks: of driving, or of braking where only that was tested."""
    at = [sheet.plain(each) for each in peaks[:1].ravel().tolist()]
    return f"peak {at[1]} N at {at[0]}" if at else "no peak tested"
