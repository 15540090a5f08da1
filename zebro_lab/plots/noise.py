# SPDX-License-Identifier: MIT
"""Residual plots of a fit: four checks of the noise model."""

import math

import numpy as np
from matplotlib.axes import Axes
from matplotlib.figure import Figure
from matplotlib.ticker import MaxNLocator
from numpy.typing import NDArray

from model.bayes.blocks import SlipBlocks
from model.slip.law import Array
from zebro_lab.plots.sheet import BLUE, RED, new_figure, slip_label, styled

_MAX_LAG = 20
_LAG_LIMIT = 0.05
_FAR = 8.0  # residuals further out would squeeze the histogram's body
_NORMAL_90, _NORMAL_95 = 1.6449, 1.96  # half-widths of a standard normal's central parts


@styled
def residuals(blocks: SlipBlocks, *, whitened: Array, run_score: Array, simulated: bool) -> Figure:
    """Draw the residuals of a fit, as four checks of the noise model.

    Args:
        blocks: Block means of slip ratio and forces.
        whitened: Whitened residuals in standard deviations, in the blocks' order, shape (n,) [-];
            independent standard normal if the noise model holds.
        run_score: Deviation of each run's mean over the standard deviation of the posterior
            predictive, shape (n_runs,) [-].
        simulated: Whether to append "(simulated)" to the title.

    Returns:
        The figure: residuals over slip, their distribution, their autocorrelation within runs,
        and the sorted run scores with the central 90 %.
    """
    figure = new_figure("Residuals", simulated, width=7.5, height=6.2)
    over_slip, distribution, lags, runs = figure.subplots(2, 2).ravel()
    points = over_slip.scatter(
        blocks.slip, whitened, c=blocks.normal_force, cmap="viridis", s=8, linewidths=0, alpha=0.8
    )
    over_slip.axhline(0, color="black", lw=0.6)
    over_slip.set(xlabel=slip_label(blocks.definition), ylabel="whitened residual [-]")
    figure.colorbar(points, ax=over_slip, label="normal force [N]")
    _draw_distribution(distribution, whitened)
    _draw_autocorrelation(lags, whitened, blocks.run)
    _draw_run_scores(runs, run_score)
    return figure


def _draw_distribution(axes: Axes, whitened: Array) -> None:
    reach = float(np.clip(np.abs(whitened).max(), 4.0, _FAR))
    beyond = int(np.sum(np.abs(whitened) > _FAR))
    axes.hist(
        np.clip(whitened, -reach, reach), range=(-reach, reach), density=True, color=BLUE,
        alpha=0.45, bins=int(np.clip(2 * math.sqrt(len(whitened)), 10, 40)),
        label=f"blocks ({beyond} beyond ±{_FAR:g} at the edges)" if beyond else "blocks",
    )  # fmt: skip
    x = np.linspace(-reach, reach, 200)
    axes.plot(x, np.exp(-(x**2) / 2) / math.sqrt(2 * math.pi), color="black", lw=1, label="N(0, 1)")
    axes.set(xlabel="whitened residual [-]", ylabel="density [-]")
    axes.set_ylim(0, 1.05 * max(axes.get_ylim()[1], 0.4))
    _legend_above(axes)


def _autocorrelation(
    whitened: Array, run: NDArray[np.intp]
) -> tuple[NDArray[np.intp], Array, NDArray[np.intp]]:
    """Compute the autocorrelation of whitened residuals within runs.

    The mean of the residuals is known to be zero, so it is not subtracted.

    Returns:
        Lags up to 20 that occur within runs [blocks], autocorrelation at each lag, the mean product
        over the mean square [-], and number of pairs; three empty arrays if no run has two blocks.
    """
    rows = []
    for lag in range(1, min(_MAX_LAG, len(whitened) - 1) + 1):
        products = (whitened[lag:] * whitened[:-lag])[run[lag:] == run[:-lag]]
        if len(products):
            rows.append((lag, products.mean() / np.mean(whitened**2), len(products)))
    lags, correlations, counts = np.array(rows).reshape(-1, 3).T
    return lags.astype(np.intp), correlations, counts.astype(np.intp)


def _draw_autocorrelation(axes: Axes, whitened: Array, run: NDArray[np.intp]) -> None:
    lags, correlations, counts = _autocorrelation(whitened, run)
    axes.set(xlabel="lag within a run [blocks]", ylabel="autocorrelation [-]")
    if not len(lags):
        axes.text(0.5, 0.5, "no run has two blocks", ha="center", transform=axes.transAxes)
        axes.set(xticks=[], yticks=[])
        return
    chance = _NORMAL_95 / np.sqrt(counts)
    axes.bar(lags, 2 * chance, bottom=-chance, width=1, color="0.88", label="95 % of white noise")
    axes.vlines(lags, 0, correlations, color=BLUE, lw=2)
    axes.plot(lags, correlations, ls="none", marker="o", ms=3.5, color=BLUE)
    axes.axhline(0, color="black", lw=0.6)
    axes.axhline(_LAG_LIMIT, color=RED, lw=0.9, ls="--", label=f"±{_LAG_LIMIT}")
    axes.axhline(-_LAG_LIMIT, color=RED, lw=0.9, ls="--")
    reach = 1.15 * max(2 * _LAG_LIMIT, float(np.abs(correlations).max()), float(chance.max()))
    axes.set(xlim=(0.5, lags[-1] + 0.5), ylim=(-reach, reach))
    axes.xaxis.set_major_locator(MaxNLocator(integer=True))
    _legend_above(axes)


def _legend_above(axes: Axes) -> None:
    axes.legend(fontsize=8, loc="lower left", bbox_to_anchor=(0, 1), ncols=2, borderpad=0)


def _draw_run_scores(axes: Axes, run_score: Array) -> None:
    outside = int(np.sum(np.abs(run_score) > _NORMAL_90))
    name = f"central 90 %, {outside} of {len(run_score)} runs outside"
    axes.axhspan(-_NORMAL_90, _NORMAL_90, color=BLUE, alpha=0.15, lw=0, label=name)
    ranks = np.arange(1, len(run_score) + 1)
    axes.plot(ranks, np.sort(run_score), ls="none", marker="o", ms=3, color=BLUE)
    axes.axhline(0, color="black", lw=0.6)
    axes.set(xlabel="run, by rank [-]", ylabel="run mean minus predicted mean [sd]")
    axes.xaxis.set_major_locator(MaxNLocator(integer=True))
    _legend_above(axes)
