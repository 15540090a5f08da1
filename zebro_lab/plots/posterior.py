# SPDX-License-Identifier: MIT
"""Plots of posterior draws: corner plot of all pairs of parameters, and traces of the chains."""

import math
import textwrap
from collections.abc import Sequence

import numpy as np
from matplotlib.axes import Axes
from matplotlib.figure import Figure
from matplotlib.ticker import MaxNLocator
from scipy.ndimage import gaussian_filter

from model.arrays import Array
from zebro_lab.plots.sheet import BLUE, CYCLE, Page, legend_below, new_figure, styled, with_minus

_PANEL = 0.8  # inches of a parameter in print, at least
_REGIONS = ("#CCE3F0", "#66AAD1")  # blue, mixed with white: 90 % and 50 % of the draws


@styled
def corner(draws: Array, *, labels: Sequence[str], page: Page) -> Figure:
    """Draw the density of every parameter and the joint region of every pair, from draws.

    Args:
        draws: Posterior draws, shape (n_draws, k).
        labels: Axis label of each parameter with its unit, k of them; see `parameter_labels`.
        page: Whether data are simulated, and width of the figure.

    Returns:
        The figure: densities on the diagonal, titled with median and central 90 %; below it the
        regions of highest density that hold 50 % and 90 % of the draws, over a thinned sample.
        Panels narrower than 1.2 inches have symbols alone, and no numbers above.
    """
    k = draws.shape[1]
    side = max(page.width or 7.0, (_PANEL if page.width else 1.75) * k)
    ticks = 3 if side > 1.2 * k else 2
    if ticks == 2:
        labels = [each.split("\n")[-1].replace(" [", "\n[") for each in labels]
    figure = new_figure("Posterior of the slip law", page.simulated, width=side, height=side + 0.5)
    panels = figure.subplots(k, k, squeeze=False, sharex="col")
    edges = [_edges(values) for values in draws.T]
    for row in range(k):
        for column in range(k):
            axes: Axes = panels[row, column]
            if column > row:
                axes.remove()
                continue
            if column == row:
                title = _draw_marginal(axes, draws[:, row], edges[row])
                axes.set_title(title if ticks > 2 else "")
            else:
                _draw_pair(axes, draws[:, [column, row]], (edges[column], edges[row]))
            _label_corner(axes, labels, row, column, ticks)
    figure.align_labels()
    legend_below(figure, columns=3)
    return figure


@styled
def traces(chains: Array, *, labels: Sequence[str], page: Page) -> Figure:
    """Draw the draws of every parameter in order, one colour for each independent ensemble.

    Args:
        chains: Draws, shape (n_ensembles, n_draws, k).
        labels: Axis label of each parameter with its unit, k of them; see `parameter_labels`.
        page: Whether data are simulated, and width of the figure.

    Returns:
        The figure: a row for each parameter, densities left, traces right. Ensembles that agree
        lie on one another. Traces of 4,000 draws or more are thinned to 2,000 to 3,000 points.
    """
    n_ensembles, n_draws, k = chains.shape
    width, height, narrow = page.width or 7.5, 1.2 + 1.35 * k, page.narrow
    figure = new_figure("Traces by ensemble", page.simulated, width=width, height=height)
    panels = figure.subplots(k, 2, squeeze=False, width_ratios=(1, 1.4 if narrow else 2.4))
    kept = np.arange(0, n_draws, max(1, n_draws // 2000))
    for row, (density, trace) in enumerate(panels):
        edges = _edges(chains[:, :, row])
        for ensemble in range(n_ensembles):
            colour = CYCLE[ensemble % len(CYCLE)]
            name = f"ensemble {ensemble + 1}" if row == 0 else None
            heights = _density(chains[ensemble, :, row], edges)
            density.plot(_middles(edges), heights, color=colour, lw=1.2, label=name)
            trace.plot(kept, chains[ensemble, kept, row], color=colour, lw=0.4, alpha=0.8)
        density.spines["left"].set_visible(False)
        density.set(yticks=[], ylim=(0, None), xlabel=labels[row])
        density.xaxis.set_major_locator(MaxNLocator(2 if narrow else 3))
        trace.yaxis.set_major_locator(MaxNLocator(4))
        trace.tick_params(labelbottom=row == k - 1)
        trace.set(xlim=(0, max(1, n_draws - 1)), ylabel=labels[row].split("\n")[-1])
    panels[0, 0].set_title("density", loc="left")
    panels[0, 1].set_title("trace", loc="left")
    panels[-1, 1].set_xlabel("draw [-]")
    legend_below(figure, columns=min(n_ensembles, 4))
    return figure


def _edges(values: Array) -> Array:
    """Return the 41 edges of bins over the finite values and a tenth of their range on either side.

    At least one value must be finite.

    If the values are constant, the margin is a twentieth of their size, or 1 if they are 0.
    """
    finite = values[np.isfinite(values)]
    margin = 0.1 * float(np.ptp(finite)) or 0.05 * float(abs(finite.flat[0])) or 1.0
    return np.linspace(finite.min() - margin, finite.max() + margin, 41)


def _middles(edges: Array) -> Array:
    """Return the middle of each bin, one fewer than edges."""
    return (edges[1:] + edges[:-1]) / 2


def _density(values: Array, edges: Array) -> Array:
    """Estimate a Gaussian kernel density, of Scott's width, at the middles of the bins, (40,)."""
    heights, _ = np.histogram(values, edges, density=True)
    return _smoothed(heights, _bandwidth(values, edges, power=1 / 5))


def _smoothed(counts: Array, width: float | list[float]) -> Array:
    """Smooth counts by a Gaussian of a standard deviation along each axis [bins]."""
    return gaussian_filter(counts, width, mode="constant")


def _bandwidth(values: Array, edges: Array, *, power: float) -> float:
    """Compute Scott's kernel width [bins]: sd n^-power of n values; `power` is 1 / (4 + dims)."""
    return float(np.std(values)) * len(values) ** -power / float(edges[1] - edges[0])


def _draw_marginal(axes: Axes, values: Array, edges: Array) -> str:
    """Draw a parameter's density, median and central 90 %; return these numbers as text.

    They are rounded to two digits of the width of the 90 %, to three decimals if that is 0.
    """
    axes.fill_between(_middles(edges), _density(values, edges), color=BLUE, alpha=0.45, lw=0)
    low, median, high = np.quantile(values, (0.05, 0.5, 0.95))
    axes.axvline(median, color=BLUE, lw=1.2, label="median")
    for edge in (low, high):
        axes.axvline(edge, color=BLUE, lw=0.9, ls="--", label="central 90 %")
    digits = 1 - math.floor(math.log10(high - low)) if high > low else 3
    axes.set(yticks=[], ylim=(0, None))
    axes.spines["left"].set_visible(False)
    low, median, high = (with_minus(f"{value:.{max(digits, 0)}f}") for value in (low, median, high))
    return f"{median}\n[{low}, {high}]"


def _draw_pair(axes: Axes, values: Array, edges: tuple[Array, Array]) -> None:
    """Draw the highest-density regions of two parameters that hold 50 % and 90 %, and some draws.

    The density is a smoothed histogram. No region is drawn if all draws lie in one point.

    Args:
        axes: Axes to draw on.
        values: Draws of the two parameters, shape (n, 2).
        edges: Edges of the bins of either parameter.
    """
    counts, _, _ = np.histogram2d(*values.T, bins=edges)
    widths = [
        _bandwidth(each, bins, power=1 / 6) for each, bins in zip(values.T, edges, strict=True)
    ]
    smooth = _smoothed(counts, widths)
    falling = np.sort(smooth, axis=None)[::-1]
    held = np.cumsum(falling) / falling.sum()
    half, most = (float(falling[np.searchsorted(held, mass)]) for mass in (0.5, 0.9))
    x, y = _middles(edges[0]), _middles(edges[1])
    stray = values[:: max(1, len(values) // 1000)]
    axes.plot(*stray.T, ls="none", marker=".", ms=2, color="0.6", zorder=0, label="some draws")
    if most < half < falling[0]:  # not when all draws are one point
        axes.contourf(x, y, smooth.T, levels=[most, half, falling[0]], colors=_REGIONS)
    for colour, mass in zip(_REGIONS, (90, 50), strict=True):
        axes.fill_between([], [], color=colour, lw=0, label=f"{mass} % region")
    axes.set_ylim(edges[1][0], edges[1][-1])


def _label_corner(axes: Axes, labels: Sequence[str], row: int, column: int, ticks: int) -> None:
    """Set ticks and labels of a panel: labels only at the left and lower edge of the figure."""
    axes.xaxis.set_major_locator(MaxNLocator(ticks))
    axes.tick_params(axis="x", labelrotation=35)
    axes.set_xlabel(_wrapped(labels[column]))
    if column < row:
        axes.yaxis.set_major_locator(MaxNLocator(ticks))
        axes.set_ylabel(_wrapped(labels[row]))
    axes.label_outer()


def _wrapped(label: str) -> str:
    """Wrap each line of a label at 18 characters, between words, to the width of a panel."""
    return "\n".join(textwrap.fill(line, 18, break_long_words=False) for line in label.split("\n"))
