# SPDX-License-Identifier: MIT
"""Picture of suggested points: the slip curve with its band before and after, and the slips."""

from pathlib import Path
from typing import Final

import numpy as np
from matplotlib.axes import Axes

from model.arrays import Array
from model.design.targets import force_rows
from zebro_lab import plots
from zebro_lab.files.source_names import is_simulated
from zebro_lab.plots.sheet import (
    BLUE,
    NARROW,
    RED,
    TRACTION_LABEL,
    legend_below,
    new_figure,
    slip_grid,
    slip_label,
    styled,
)
from zebro_lab.suggest.folder import Suggested

_HALF: Final = 1.645  # standard deviations of a 90 % band
_POINTS: Final = 200


@styled
def draw_suggested(file: Path, suggested: Suggested) -> None:
    """Draw the curve at the smallest and largest suggested load, whole and near zero slip.

    Bands hold 90 % at each slip, for the law's parameters alone, by linear error propagation.
    Suggested slips are marked on the curve, larger where there are several points.

    Args:
        file: File to write.
        suggested: The suggestion.
    """
    loads = suggested.proposal.plan.points.loads
    shown = sorted({min(loads), max(loads)})
    figure = new_figure(
        f"Suggested points for {_targets(suggested)}: plan '{suggested.plan.name}'",
        is_simulated(suggested.source), width=9.0, height=1.4 + 2.6 * len(shown),
    )  # fmt: skip
    panels = figure.subplots(len(shown), 2, squeeze=False)
    slips = np.array(suggested.plan.points.slips)
    low, high = float(slips.min()), float(slips.max())
    reach = NARROW * max(abs(low), abs(high))
    for row, load in zip(panels, shown, strict=True):
        _draw_load(row[0], suggested, load, slip_grid(slips, _POINTS), beyond=reach)
        near = np.linspace(max(low, -reach), min(high, reach), _POINTS)
        _draw_load(row[1], suggested, load, near if near[0] < near[-1] else slip_grid(slips, 99))
        row[0].set_ylabel(TRACTION_LABEL)
        row[0].set_title(f"load {load:g} N", loc="left")
        row[1].set_title("near zero slip", loc="left")
    for axes in panels[-1]:
        axes.set_xlabel(slip_label(str(suggested.knowledge.posterior.blocks.definition)))
    legend_below(figure, columns=4)
    plots.save(figure, file)


def _targets(suggested: Suggested) -> str:
    """Return the names of the targets, each once, separated by commas."""
    return ", ".join(dict.fromkeys(row.target for row in suggested.expected))


def _draw_load(
    axes: Axes, suggested: Suggested, load: float, slip: Array, *, beyond: float = -1.0
) -> None:
    """Draw curve, bands and suggested slips at a load.

    The number of points, where it is above 1, is written at slips of a size above `beyond`.
    """
    knowledge, proposal = suggested.knowledge, suggested.proposal
    force, rows = force_rows(
        knowledge.posterior, knowledge.draws, slip=slip, load=np.full(len(slip), load)
    )
    curve = force.mean(axis=0)
    bands = {
        "90 % band now": (np.linalg.inv(knowledge.now), "0.82"),
        "after the suggestion, expected": (proposal.design.covariance, "#8fbfdf"),
    }
    for label, (covariance, colour) in bands.items():
        variance = np.einsum("mpi,mij,mpj->mp", rows, covariance, rows).mean(axis=0)
        half = _HALF * np.sqrt(np.maximum(variance, 0.0))
        axes.fill_between(slip, curve - half, curve + half, color=colour, lw=0, label=label)
    axes.plot(slip, curve, color=BLUE, lw=1.2, label="slip curve of the calibration")
    inside = (proposal.slips >= slip[0]) & (proposal.slips <= slip[-1])
    at, counts = proposal.slips[inside], proposal.counts[inside]
    axes.scatter(
        at, np.interp(at, slip, curve), s=14.0 * counts**0.7, color=RED, alpha=0.75, lw=0,
        zorder=3, label="suggested slips, larger for more points",
    )  # fmt: skip
    for x, y, count in zip(at, np.interp(at, slip, curve), counts, strict=True):
        if count > 1 and abs(x) > beyond:  # others are too close: the panel beside has them
            axes.annotate(
                f"{count}", (x, y), xytext=(0, 7), textcoords="offset points", fontsize=7,
                ha="center",
            )  # fmt: skip
    axes.margins(x=0.02)
    axes.grid(color="0.92", lw=0.6)
