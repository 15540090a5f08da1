# SPDX-License-Identifier: MIT
"""Plot slip curves, one panel for each tested load."""

import math
from collections.abc import Sequence
from dataclasses import dataclass, replace

import numpy as np
from matplotlib.axes import Axes
from matplotlib.figure import Figure
from matplotlib.gridspec import SubplotSpec
from numpy.typing import ArrayLike, NDArray

from model.arrays import Array
from model.bayes.blocks import SlipBlocks
from model.slip.law import SlipLaw
from model.slip.sided import braking_peak_slip
from zebro_lab.plots.sheet import (
    BLUE,
    NARROW,
    RED,
    TRACTION_LABEL,
    few_ticks,
    legend_below,
    new_figure,
    plain,
    point_alpha,
    slip_grid,
    slip_label,
    styled,
    tint,
)

_QUANTILES = (0.05, 0.25, 0.5, 0.75, 0.95)
_CURVES = 400  # draws whose curves make the bands
_LINE = 0.02  # of the height of a panel: a band that is narrower is hardly seen beside the line
_NEAR_LOAD = 0.1  # relative load difference beyond which a block is not comparable with the curve


@styled
def slip_curves(
    blocks: SlipBlocks,
    law: SlipLaw,
    *,
    draws: Array,
    load_levels: ArrayLike,
    simulated: bool,
) -> Figure:
    """Draw data and posterior slip curves, one panel for each tested load.

    Each block is drawn at the nearest load level; blocks whose load differs by more than 10 % are
    hollow, since the curve is for another load. The bands are those of the curve (parameters only),
    without noise and run offsets, over the slip tested at this load, or at all loads for a level
    without blocks. If a peak is in the first 15 % of the tested slip, each load has a second panel
    for that part.

    Args:
        blocks: Block means of slip ratio and forces.
        law: Slip law of the draws.
        draws: Posterior draws of the law's parameters, shape (n_draws, k).
        load_levels: Nominal loads, shape (n_levels,) [N].
        simulated: Whether to append "(simulated)" to the title.

    Returns:
        The figure.
    """
    curves = _load_curves(blocks, law, draws, np.sort(np.ravel(np.asarray(load_levels, float))))
    reach = _narrow_reach(blocks, curves)
    groups = math.ceil(math.sqrt(len(curves))) if reach is None else 1 + (len(curves) > 4)
    rows, width = math.ceil(len(curves) / groups), 1 if reach is None else 2
    sides = max(7.0, 3.2 * groups * width), 1.2 + 2.2 * max(rows, 1.6)
    figure = new_figure("Slip curve by load", simulated, width=sides[0], height=sides[1])
    grid = figure.add_gridspec(rows, groups * width)
    drawn: list[tuple[list[Axes], _LoadCurve]] = []
    for index, curve in enumerate(curves):
        row, column = index // groups, index % groups * width
        cells = [grid[row, column + i] for i in range(width)]
        panels = _draw_load(figure, cells, blocks, curve, reach)
        drawn.append((panels, curve))
        if column == 0:
            panels[0].set_ylabel(TRACTION_LABEL)
        if index + groups >= len(curves):  # the last panel of its column
            for axes in panels:
                axes.set_xlabel(slip_label(blocks.definition))
    hidden = all(curve.width() < _LINE * np.ptp(panels[0].get_ylim()) for panels, curve in drawn)
    for panels, curve in drawn:
        for axes in panels:
            _draw_bands(axes, curve, hidden=hidden)
    legend_below(figure, columns=3)
    return figure


@dataclass(frozen=True)
class _LoadCurve:
    """Posterior slip curve at one load [N] over `slip` [-]; `rows`: blocks nearest to this load."""

    load: float
    rows: NDArray[np.bool_]
    slip: Array
    bands: Array  # shape (5, m): `_QUANTILES` of the traction force [N]
    peaks: Array  # shape (0 to 2, 2): slip [-] and force [N] of driving, then of braking peak

    def width(self) -> float:
        """Return the median width of the band of 90 %, not that where the curve is steep [N]."""
        return float(np.median(self.bands[-1] - self.bands[0]))

    def main_peak(self) -> tuple[float, float] | None:
        """Return slip [-] and force [N] of the driving peak, else the braking one, else None."""
        return (float(self.peaks[0, 0]), float(self.peaks[0, 1])) if len(self.peaks) else None


def _draw_load(
    figure: Figure, cells: Sequence[SubplotSpec], blocks: SlipBlocks, curve: _LoadCurve,
    reach: tuple[float, float] | None,
) -> list[Axes]:  # fmt: skip
    """Draw data and curve at one load, in a second cell the part within `reach`; return panels."""
    whole = figure.add_subplot(cells[0])
    _draw_load_curve(whole, blocks, curve)
    load, peak = _load_text(blocks, curve), _peak_text(curve)
    if reach is None:
        whole.set_title(f"{load}\n{peak}", loc="left")
        return [whole]
    whole.set_title(load, loc="left")
    close = figure.add_subplot(cells[1], sharey=whole)
    inside = curve.rows & (reach[0] <= blocks.slip) & (blocks.slip <= reach[1])
    _draw_load_curve(close, blocks, replace(curve, rows=inside))
    margin = 0.02 * (reach[1] - reach[0])
    close.set_xlim(reach[0] - margin, reach[1] + margin)
    close.set_title(peak, loc="left")
    close.tick_params(labelleft=False)
    close.xaxis.set_major_locator(few_ticks(4))
    return [whole, close]


def _load_curves(blocks: SlipBlocks, law: SlipLaw, draws: Array, levels: Array) -> list[_LoadCurve]:
    nearest = np.argmin(np.abs(blocks.normal_force[:, None] - levels), axis=1)
    values = draws[:: max(1, len(draws) // _CURVES)].T[:, :, None]
    curves = []
    for index, load in enumerate(levels):
        rows = nearest == index
        slip = slip_grid(blocks.slip[rows] if rows.any() else blocks.slip, 250)
        bands = np.quantile(law.force(slip, load, values), _QUANTILES, axis=0)
        peaks = _peaks(law, draws, float(load), slip)
        curves.append(_LoadCurve(float(load), rows, slip, bands, peaks))
    return curves


def _peaks(law: SlipLaw, draws: Array, load: float, slip: Array) -> Array:
    """Return slip and force of the peaks inside the tested slip, medians over all draws.

    They are those of the tables: medians of each draw's own peak, not the peak of the median curve.
    """
    own = np.broadcast_to(law.peak_slip(load, draws.T), len(draws))
    braking = np.broadcast_to(braking_peak_slip(law, load, draws.T), len(draws))
    reach = np.abs(slip).max()
    forces = (
        law.force(np.minimum(own, reach), load, draws.T),
        law.force(np.maximum(braking, -reach), load, draws.T),
    )
    both = np.array(
        [
            [np.median(at), np.median(force)]
            for at, force in zip((own, braking), forces, strict=True)
        ]
    )
    return both[(both[:, 0] > slip[0]) & (both[:, 0] < slip[-1])]


def _narrow_reach(blocks: SlipBlocks, curves: Sequence[_LoadCurve]) -> tuple[float, float] | None:
    """Return the slip range of the additional panel; None if no peak is in the first 15 %."""
    reach = NARROW * float(np.abs(blocks.slip).max())
    peaks = [peak for curve in curves if (peak := curve.main_peak())]
    if not any(abs(slip) < reach for slip, _ in peaks):
        return None
    low, high = float(blocks.slip.min()), float(blocks.slip.max())
    return max(-reach, min(low, 0.0)), min(reach, max(high, 0.0))


def _draw_load_curve(axes: Axes, blocks: SlipBlocks, curve: _LoadCurve) -> None:
    near = np.abs(blocks.normal_force - curve.load) <= _NEAR_LOAD * curve.load
    slip, force = blocks.slip, blocks.traction_force
    on, off = curve.rows & near, curve.rows & ~near
    alpha = point_alpha(int(curve.rows.sum()))
    axes.scatter(
        slip[on], force[on], s=12, color="0.35", alpha=alpha, linewidths=0,
        label="block means" if on.any() else None,
    )  # fmt: skip
    axes.scatter(
        slip[off], force[off], s=12, facecolors="none", edgecolors="0.35", alpha=alpha,
        linewidths=0.6, label="block means, load differs > 10 %" if off.any() else None,
    )  # fmt: skip
    axes.plot(curve.slip, curve.bands[2], color=BLUE, lw=1.4, label="posterior median")
    if len(curve.peaks):
        axes.plot(
            *curve.peaks.T, ls="none", marker="D", ms=5, color=RED,
            mec="white", mew=0.6, label="peak",
        )  # fmt: skip
    axes.axhline(0, color="0.6", lw=0.5, zorder=0)


def _draw_bands(axes: Axes, curve: _LoadCurve, *, hidden: bool) -> None:
    """Draw the bands of curves; `hidden`: none is wider than the line, which their key says."""
    low, lower, _, upper, high = curve.bands
    note = " (hardly seen)" if hidden else ""
    axes.fill_between(
        curve.slip, low, high, color=tint(0.25), lw=0, zorder=0.5, label=f"90 % of curves{note}"
    )
    axes.fill_between(
        curve.slip, lower, upper, color=tint(0.6), lw=0, zorder=0.6, label=f"50 % of curves{note}"
    )


def _load_text(blocks: SlipBlocks, curve: _LoadCurve) -> str:
    loads = blocks.normal_force[curve.rows]
    if not len(loads):
        return f"load {curve.load:.4g} N (no blocks)"
    ends = dict.fromkeys((plain(loads.min()), plain(loads.max())))  # one where they round alike
    return f"load {curve.load:.4g} N ({len(loads)} blocks, {'–'.join(ends)} N)"


def _peak_text(curve: _LoadCurve) -> str:
    if (peak := curve.main_peak()) is None:
        return "no peak in the tested slip"
    return f"peak {plain(peak[1])} N at slip {plain(peak[0])}"
