# SPDX-License-Identifier: MIT
"""Plot the departure of the data from a slip law, over slip."""

import numpy as np
from matplotlib.figure import Figure

from model.arrays import Array
from model.bayes.blocks import SlipBlocks
from model.slip.discrepancy import LawWithDiscrepancy
from zebro_lab.plots.sheet import (
    BLUE,
    legend_below,
    new_figure,
    slip_grid,
    slip_label,
    styled,
    tint,
)

_CURVES = 400  # draws whose departures make the bands
_BINS = 24  # of slip, whose means are drawn


@styled
def discrepancy(
    blocks: SlipBlocks, law: LawWithDiscrepancy, *, draws: Array, simulated: bool
) -> Figure:
    """Draw the departure from a law over the load: median, bands, and what the data lie from it.

    Points are means of measured traction less that of the law alone, with its median values, over
    the load, in bins of equally many blocks of neighbouring slips, with their standard errors.

    Args:
        blocks: Block means of slip ratio and forces.
        law: The law with a departure.
        draws: Posterior draws of its parameters, shape (n_draws, k).
        simulated: Whether to append "(simulated)" to the title.

    Returns:
        The figure.
    """
    some = draws[:: max(1, len(draws) // _CURVES)]
    slip = slip_grid(blocks.slip, 250)
    low, lower, middle, upper, high = 100 * np.quantile(
        law.departure(slip, some.T[:, :, None]), (0.05, 0.25, 0.5, 0.75, 0.95), axis=0
    )
    figure = new_figure("Departure from the slip law", simulated, width=7.0, height=4.2)
    axes = figure.add_subplot()
    axes.axhline(0, color="0.6", lw=0.6, zorder=0)
    axes.fill_between(slip, low, high, color=tint(0.25), lw=0, label="90 % of departures")
    axes.fill_between(slip, lower, upper, color=tint(0.6), lw=0, label="50 % of departures")
    axes.plot(slip, middle, color=BLUE, lw=1.4, label="posterior median")
    axes.errorbar(
        *_bin_means(blocks, law, np.median(draws, axis=0)), fmt="o", ms=3.5, color="0.2", lw=0.8,
        label="measured less law: bin means, standard errors",
    )  # fmt: skip
    axes.set_xlabel(slip_label(blocks.definition))
    axes.set_ylabel("departure over load [%]")
    legend_below(figure, columns=2)
    return figure


def _bin_means(
    blocks: SlipBlocks, law: LawWithDiscrepancy, values: Array
) -> tuple[list[float], list[float], list[float]]:
    """Return slip [-], mean of measured less law over load, and its standard error [%], by bin."""
    k = len(law.law.parameters)
    away = blocks.traction_force - law.law.force(blocks.slip, blocks.normal_force, values[:k])
    share = 100 * away / blocks.normal_force
    parts = np.array_split(np.argsort(blocks.slip), min(_BINS, max(1, len(share) // 3)))
    return (
        [float(blocks.slip[part].mean()) for part in parts],
        [float(share[part].mean()) for part in parts],
        [float(share[part].std() / np.sqrt(len(part))) for part in parts],
    )
