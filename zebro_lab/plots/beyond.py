# SPDX-License-Identifier: MIT
"""Mark where a curve leaves its axes, so that nothing is cut off unseen."""

import numpy as np
from matplotlib.axes import Axes

from model.arrays import Array

_APART = 0.01  # of the time shown; excursions closer than this share a mark


def limits_without_tips(
    values: Array, *, cut: float, margin: float, least: float
) -> tuple[float, float]:
    """Compute axis limits that leave out the tips of impacts, which would flatten all else.

    Args:
        values: Values to draw, any shape; those that are not finite do not count.
        cut: Share of the values left out at either end; 0 for none [-].
        margin: Margin at either end, as a share of the range [-].
        least: Least range of the limits, so that rounding errors look like zero [unit of values].

    Returns:
        Lower and upper limit; around zero if no value is finite.
    """
    finite = values[np.isfinite(values)]
    low, high = np.quantile(finite, (cut, 1 - cut)) if len(finite) else (0.0, 0.0)
    wider = max(margin * (high - low), 0.5 * (least - (high - low)))
    return float(low - wider), float(high + wider)


def mark_beyond(
    axes: Axes, t: Array, values: Array, limits: tuple[float, float], *, label: str
) -> None:
    """Draw a triangle at the edge of the axes for each excursion of a curve beyond its limits.

    Args:
        axes: Axes with the curve.
        t: Times, shape (n,) [s].
        values: Values of the curve, shape (n,).
        limits: Limits of the vertical axis; they are set.
        label: Label of the marks in a legend.
    """
    axes.set_ylim(limits)
    for outside, edge, shape in ((values < limits[0], 0.0, "v"), (values > limits[1], 1.0, "^")):
        at = t[outside]
        if not len(at):
            continue
        begins = at[np.diff(at, prepend=-np.inf) > _APART * (t[-1] - t[0])]
        axes.plot(
            begins, np.full(len(begins), edge), transform=axes.get_xaxis_transform(),
            ls="none", marker=shape, ms=3.5, color="0.25", mew=0, clip_on=False, zorder=5,
            label=label,
        )  # fmt: skip
