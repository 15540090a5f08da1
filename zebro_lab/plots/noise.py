# SPDX-License-Identifier: MIT
"""Residual plots of a fit: four checks of the noise model."""

import math

import numpy as np
from matplotlib.axes import Axes
from matplotlib.figure import Figure
from matplotlib.ticker import MaxNLocator
from numpy.typing import NDArray

from model.arrays import Array
from model.bayes.averaging.blocks import SlipBlocks
from model.bayes.residuals import lag_correlation
from zebro_lab.plots.sheet import BLUE, Page, new_figure, slip_label, styled

_MAX_LAG = 20
_FEWEST_PAIRS = 8  # of a lag that is drawn: with fewer the band of chance is most of -1 to 1
_FAR = 8.0  # residuals further out would squeeze the histogram's body
_NORMAL_90, _NORMAL_95 = 1.6449, 1.96  # half-widths of a standard normal's central parts


@styled
def residuals(blocks: SlipBlocks, *, whitened: Array, run_score: Array, page: Page) -> Figure:
    """Draw the residuals of a fit, as four checks of the noise model.

    Args:
        blocks: Block means of slip ratio and forces.
        whitened: Whitened residuals in standard deviations, in the blocks' order, shape (n,) [-];
            independent standard normal if the noise model holds.
        run_score: Deviation of each run's mean over the standard deviation of the posterior
            predictive, shape (n_runs,) [-].
        page: Whether data are simulated, and width of the figure.

    Returns:
        The figure: residuals over slip, their distribution, their autocorrelation within runs,
        and the sorted run scores with the central 90 %.
    """
    width, rows = page.width or 7.5, 4 if page.narrow else 2
    figure = new_figure(
        "Residuals", page.simulated, width=width, height=0.4 + rows * (1.2 + 0.2 * width)
    )
    over_slip, distribution, lags, runs = figure.subplots(rows, 4 // rows).ravel()
    points = over_slip.scatter(
        blocks.slip, whitened, c=blocks.normal_force, cmap="viridis", s=8, linewidths=0, alpha=0.8
    )
    over_slip.axhline(0, color="black", lw=0.6)
    over_slip.set(xlabel=slip_label(blocks.definition), ylabel="whitened residual [-]")
    if np.ptp(blocks.normal_force) > 0:
        figure.colorbar(points, ax=over_slip, label="normal force [N]")
    _draw_distribution(distribution, whitened)
    _draw_autocorrelation(lags, whitened, blocks.run)
    _draw_run_scores(runs, run_score)
    return figure


def _draw_distribution(axes: Axes, whitened: Array) -> None:
    """Draw a histogram of whitened residuals and the standard normal density.

    Residuals beyond ±`_FAR` are drawn in the outermost bins, and counted in the legend.
    """
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


def _draw_autocorrelation(axes: Axes, whitened: Array, run: NDArray[np.intp]) -> None:
    """Draw the autocorrelation of whitened residuals within runs, up to a lag of `_MAX_LAG` blocks.

    Lags with fewer than `_FEWEST_PAIRS` pairs are left out; a note is written if all are. The band
    holds 95 % of the correlations of white noise.
    """
    axes.set(xlabel="lag within a run [blocks]", ylabel="autocorrelation [-]")
    rows = [
        (lag, *lag_correlation(whitened, run, lag)) for lag in range(1, min(_MAX_LAG + 1, len(run)))
    ]
    rows = [row for row in rows if row[2] >= _FEWEST_PAIRS]
    if not rows:
        axes.text(0.5, 0.5, "too few runs have two blocks", ha="center", transform=axes.transAxes)
        axes.set(xticks=[], yticks=[])
        return
    lags, correlations, counts = np.array(rows).T
    chance = _NORMAL_95 / np.sqrt(counts)
    axes.bar(lags, 2 * chance, bottom=-chance, width=1, color="0.88", label="95 % of white noise")
    axes.vlines(lags, 0, correlations, color=BLUE, lw=2)
    axes.plot(lags, correlations, ls="none", marker="o", ms=3.5, color=BLUE)
    axes.axhline(0, color="black", lw=0.6)
    reach = 1.15 * max(float(np.abs(correlations).max()), float(chance.max()))
    axes.set(xlim=(0.5, lags[-1] + 0.5), ylim=(-reach, reach))
    axes.xaxis.set_major_locator(MaxNLocator(integer=True))
    _legend_above(axes, columns=1)


def _legend_above(axes: Axes, *, columns: int = 2) -> None:
    """Add a legend above, which must not be wider than the axes: they would be squeezed."""
    axes.legend(fontsize=8, loc="lower left", bbox_to_anchor=(0, 1), ncols=columns, borderpad=0)


def _draw_run_scores(axes: Axes, run_score: Array) -> None:
    """Draw the sorted run scores over the central 90 % of a normal; count those outside."""
    outside = int(np.sum(np.abs(run_score) > _NORMAL_90))
    name = f"central 90 %: {outside} of {len(run_score)} outside"
    axes.axhspan(-_NORMAL_90, _NORMAL_90, color=BLUE, alpha=0.15, lw=0, label=name)
    ranks = np.arange(1, len(run_score) + 1)
    axes.plot(ranks, np.sort(run_score), ls="none", marker="o", ms=3, color=BLUE)
    axes.axhline(0, color="black", lw=0.6)
    axes.set(xlabel="run, by rank [-]", ylabel="run mean less predicted [sd]")
    axes.xaxis.set_major_locator(MaxNLocator(5, integer=True))
    reach = 1.1 * max(3.0, float(np.abs(run_score).max()))
    axes.set_ylim(-reach, reach)
    _legend_above(axes)
