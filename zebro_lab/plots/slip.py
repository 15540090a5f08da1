# SPDX-License-Identifier: MIT
"""Plot slip curves, a row of panels for each tested load."""

from dataclasses import dataclass

import numpy as np
from matplotlib.axes import Axes
from matplotlib.figure import Figure
from numpy.typing import ArrayLike, NDArray

from model.arrays import Array
from model.bayes.averaging.blocks import SlipBlocks
from model.slip.law import SlipLaw
from model.slip.sided import braking_peak_slip
from zebro_lab.plots import sheet

_QUANTILES = (0.05, 0.25, 0.5, 0.75, 0.95)
_CURVES = 400  # draws whose curves make the bands


@sheet.styled
def slip_curves(
    blocks: SlipBlocks,
    law: SlipLaw,
    *,
    draws: Array,
    load_levels: ArrayLike,
    simulated: bool,
) -> Figure:
    """Draw data and posterior slip curves, a row for each tested load.

    Each block is drawn at the nearest load level; the loads of the blocks are written above. The
    bands are those of the curve (parameters only), without noise and run offsets, over the slip
    tested at this load, or at all loads for a level without blocks. They hold 50 % and 90 % of the
    curves at each slip. If the driving peak of any load (the braking peak where only that is in the
    tested slip) is in the first 15 % of the tested slip, each load has a second panel for that
    part.

    Args:
        blocks: Block means of slip ratio and forces.
        law: Slip law of the draws.
        draws: Posterior draws of the law's parameters, shape (n_draws, k).
        load_levels: Nominal loads, one for each row of panels, shape (n_levels,) [N].
        simulated: Whether to append "(simulated)" to the title.

    Returns:
        The figure.
    """
    curves = _load_curves(blocks, law, draws, np.sort(np.ravel(np.asarray(load_levels, float))))
    reach = sheet.NARROW * float(np.abs(blocks.slip).max())
    columns = 1 + any(abs(curve.peaks[0, 0]) < reach for curve in curves if len(curve.peaks))
    figure = sheet.new_figure(
        "Slip curve by load", simulated, width=3.5 + 2.9 * columns, height=1.6 + 1.5 * len(curves)
    )
    panels = figure.subplots(len(curves), columns, squeeze=False, sharey="row")
    for row, curve in zip(panels, curves, strict=True):
        for axes in row:
            _draw_curve(axes, blocks, curve)
        row[0].set_ylabel(sheet.TRACTION_LABEL)
        row[0].set_title(_load_text(blocks, curve), loc="left")
        row[-1].set_title(_peak_text(curve), loc="right" if columns == 1 else "left")
        if columns > 1:
            low, high = max(-reach, curve.slip[0]), min(reach, curve.slip[-1])
            margin = 0.02 * (high - low)
            row[1].set_xlim(low - margin, high + margin)
    for axes in panels[-1]:
        axes.set_xlabel(sheet.slip_label(blocks.definition))
    sheet.legend_below(figure, columns=3)
    return figure


@dataclass(frozen=True)
class _LoadCurve:
    """Posterior slip curve at one load [N] over `slip` [-]; `rows`: blocks nearest to this load."""

    load: float
    rows: NDArray[np.bool_]
    slip: Array
    bands: Array  # shape (5, m): `_QUANTILES` of the traction force [N]
    peaks: Array  # shape (0 to 2, 2): slip [-] and force [N] of driving, then of braking peak


def _load_curves(blocks: SlipBlocks, law: SlipLaw, draws: Array, levels: Array) -> list[_LoadCurve]:
    """Compute the posterior slip curve at each load level.

    The bands are quantiles over every kth draw, `_CURVES` to twice as many of them, or all if there
    are fewer; the peaks are medians over all draws.
    """
    nearest = np.argmin(np.abs(blocks.normal_force[:, None] - levels), axis=1)
    values = draws[:: max(1, len(draws) // _CURVES)].T[:, :, None]
    curves = []
    for index, load in enumerate(levels):
        rows = nearest == index
        slip = sheet.slip_grid(blocks.slip[rows] if rows.any() else blocks.slip, 250)
        bands = np.quantile(law.force(slip, load, values), _QUANTILES, axis=0)
        peaks = _peaks(law, draws, float(load), slip)
        curves.append(_LoadCurve(float(load), rows, slip, bands, peaks))
    return curves


def _peaks(law: SlipLaw, draws: Array, load: float, slip: Array) -> Array:
    """Return slip and force of driving and braking peak inside the tested slip, shape (0 to 2, 2).

    They are those of the tables: medians of each draw's own peak, not the peak of the median curve.
    The force of a draw that peaks beyond the largest tested slip is that at this slip.
    """
    own = np.broadcast_to(law.peak_slip(load, draws.T), len(draws))
    braking = np.broadcast_to(braking_peak_slip(law, load, draws.T), len(draws))
    reach = np.abs(slip).max()
    forces = (
        law.force(np.minimum(own, reach), load, draws.T),
        law.force(np.maximum(braking, -reach), load, draws.T),
    )
    both = np.array([
        [np.median(at), np.median(force)] for at, force in zip((own, braking), forces, strict=True)
    ])  # fmt: skip
    return both[(both[:, 0] > slip[0]) & (both[:, 0] < slip[-1])]


def _draw_curve(axes: Axes, blocks: SlipBlocks, curve: _LoadCurve) -> None:
    """Draw block means, median, bands and peaks of the curve at one load."""
    low, lower, median, upper, high = curve.bands
    axes.fill_between(curve.slip, low, high, color=sheet.tint(0.25), lw=0, label="90 % of curves")
    axes.fill_between(curve.slip, lower, upper, color=sheet.tint(0.6), lw=0, label="50 % of curves")
    axes.scatter(
        blocks.slip[curve.rows], blocks.traction_force[curve.rows], s=12, color="0.35",
        alpha=sheet.point_alpha(int(curve.rows.sum())), linewidths=0,
        label="block means" if curve.rows.any() else None,
    )  # fmt: skip
    axes.plot(curve.slip, median, color=sheet.BLUE, lw=1.4, label="posterior median")
    if len(curve.peaks):
        axes.plot(*curve.peaks.T, "D", ms=5, color=sheet.RED, mec="white", mew=0.6, label="peak")
    axes.axhline(0, color="0.6", lw=0.5, zorder=0)


def _load_text(blocks: SlipBlocks, curve: _LoadCurve) -> str:
    """Format a load level with the number of its blocks and the range of their loads [N]."""
    loads = blocks.normal_force[curve.rows]
    if not len(loads):
        return f"load {curve.load:.4g} N (no blocks)"
    ends = dict.fromkeys(
        (sheet.plain(loads.min()), sheet.plain(loads.max()))
    )  # one where they round alike
    return f"load {curve.load:.4g} N ({len(loads)} blocks, {'–'.join(ends)} N)"


def _peak_text(curve: _LoadCurve) -> str:
    """Format the first of the peaks: of driving, or of braking where only that was tested."""
    if not len(curve.peaks):
        return "no peak in the tested slip"
    slip, force = curve.peaks[0]
    return f"peak {sheet.plain(force)} N at slip {sheet.plain(slip)}"
