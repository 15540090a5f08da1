# SPDX-License-Identifier: MIT
"""Pictures of studies: histograms of ranks, differences of distribution functions, coverage."""

import math
from collections.abc import Sequence

import numpy as np
from matplotlib.axes import Axes
from matplotlib.figure import Figure

from model.study.coverage import LEVELS, Covered, binomial_band
from model.study.ranks import Uniformity
from model.study.uniformity import BINS, DRAWS, cumulative, histogram, simultaneous_band
from zebro_lab.plots.sheet import BLUE, RED, legend_below, new_figure, styled

_COLUMNS = 4
_GREY = "0.87"


@styled
def draw_ranks(tests: Sequence[Uniformity], *, title: str) -> Figure:
    """Draw a histogram of each parameter's ranks, with the binomial interval of a bin.

    Args:
        tests: Test of each parameter, one or more.
        title: What was simulated and fitted.

    Returns:
        The figure, a panel for each parameter, those that fail in red.
    """
    figure, panels = _panels(tests, f"Ranks of true values: {title}")
    edges = np.linspace(0, DRAWS + 1, BINS + 1)
    highest = max(int(histogram(test.ranks).max()) for test in tests)
    for test, axes in zip(tests, panels, strict=True):
        n = len(test.ranks)
        low, high = binomial_band(n, 1 / BINS, 0.01)
        axes.axhspan(low, high, color=_GREY, lw=0, label="99 % of a bin's counts, if uniform")
        axes.axhline(n / BINS, color="black", lw=0.6, ls="--")
        axes.stairs(
            histogram(test.ranks), edges, fill=True, alpha=0.7, label="counts",
            color=BLUE if test.passed else RED,
        )  # fmt: skip
        axes.set_ylim(0, 1.05 * max(highest, high))
        _head(axes, test, f"$\\chi^2$ p {_p(test.chi_square_p)}")
    _label(panels, "rank among 99 draws", "replicates")
    legend_below(figure, columns=2)
    return figure


@styled
def draw_ecdf(tests: Sequence[Uniformity], *, title: str) -> Figure:
    """Draw the ranks' distribution function less the uniform one, in its simultaneous band.

    Args:
        tests: Test of each parameter, one or more.
        title: What was simulated and fitted.

    Returns:
        The figure, a panel for each parameter, those that fail in red.
    """
    figure, panels = _panels(tests, f"Distribution of ranks less the uniform one: {title}")
    n = len(tests[0].ranks)
    band = simultaneous_band(n, tests[0].limit)
    label = f"band left by a correct fit with {100 * tests[0].limit:.2g} %"
    for test, axes in zip(tests, panels, strict=True):
        axes.fill_between(
            band.ranks, band.low / n - band.expected, band.high / n - band.expected,
            step="post", color=_GREY, lw=0, label=label,
        )  # fmt: skip
        axes.axhline(0, color="black", lw=0.6, ls="--")
        difference = cumulative(test.ranks) / n - band.expected
        axes.step(
            band.ranks, difference, where="post", lw=1.2, label="found",
            color=BLUE if test.passed else RED,
        )  # fmt: skip
        _head(axes, test, f"ECDF p {_p(test.ecdf_p)}")
    _label(panels, "rank among 99 draws", "difference [-]")
    legend_below(figure, columns=2)
    return figure


@styled
def draw_coverage(covered: Sequence[Covered], *, title: str) -> Figure:
    """Draw how many intervals hold the truth, beside the exact binomial intervals, and the bias.

    Args:
        covered: Coverage of each parameter, one or more.
        title: What was simulated and fitted.

    Returns:
        The figure: a panel for each level, and one of the mean error.
    """
    height = 2.2 + 0.32 * len(covered)
    figure = new_figure(f"Coverage of intervals: {title}", True, width=9.0, height=height)
    panels = figure.subplots(1, len(LEVELS) + 1, sharey=True)
    rows = np.arange(len(covered))[::-1]
    for index, (level, axes) in enumerate(zip(LEVELS, panels, strict=False)):
        n = covered[0].n
        low, high = (
            np.array([each.band[index][end] / each.n for each in covered]) for end in (0, 1)
        )
        far, top = (
            np.array([each.joint[index][end] / each.n for each in covered]) for end in (0, 1)
        )
        axes.barh(
            rows, top - far, left=far, height=0.7, color="0.93", label="99 % of all counts together"
        )
        axes.barh(rows, high - low, left=low, height=0.7, color="0.82", label="99 % of a count")
        axes.axvline(level, color="black", lw=0.6, ls="--")
        for row, each in zip(rows, covered, strict=True):
            axes.plot(
                each.held[index] / each.n, row, marker="o", ms=5, ls="none",
                color=BLUE if each.held[index] >= each.joint[index][0] else RED,
            )  # fmt: skip
        axes.set_xlabel(f"share of {n} intervals\nof {100 * level:g} % that hold [-]")
    bias = panels[-1]
    bias.axvline(0, color="black", lw=0.6, ls="--")
    error = 2.58 / math.sqrt(covered[0].n)
    bias.axvspan(-error, error, color="0.82", lw=0)
    bias.plot([each.bias for each in covered], rows, marker="o", ms=5, ls="none", color=BLUE)
    bias.set_xlabel("mean error [posterior sd]")
    panels[0].set_yticks(rows, [each.name.replace("_", " ") for each in covered])
    legend_below(figure, columns=2)
    return figure


def _panels(tests: Sequence[Uniformity], title: str) -> tuple[Figure, list[Axes]]:
    """Create a figure with a panel for each test; panels share their axes."""
    columns = min(_COLUMNS, len(tests))
    rows = math.ceil(len(tests) / columns)
    figure = new_figure(title, True, width=max(5.0, 2.3 * columns), height=1.2 + 1.75 * rows)
    grid = figure.subplots(rows, columns, squeeze=False, sharex=True, sharey=True)
    for spare in grid.ravel()[len(tests) :]:
        spare.remove()
    return figure, list(grid.ravel()[: len(tests)])


def _head(axes: Axes, test: Uniformity, said: str) -> None:
    name = test.name.replace("_", " ")
    words = "" if test.passed else f"\n{test.words}"
    axes.set_title(f"{name}\n{said}{words}", loc="left", fontsize=8)


def _label(panels: Sequence[Axes], x: str, y: str) -> None:
    for index, axes in enumerate(panels):
        if index + _COLUMNS >= len(panels):
            axes.set_xlabel(x)
            axes.tick_params(labelbottom=True)
        if index % _COLUMNS == 0:
            axes.set_ylabel(y)


def _p(value: float) -> str:
    """Format a p-value.

    >>> _p(0.4312), _p(2e-9), _p(0.0)
    ('0.43', '2e-09', '< 1e-12')
    """
    return "< 1e-12" if value < 1e-12 else f"{value:.2g}"
