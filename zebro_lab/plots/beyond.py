# SPDX-License-Identifier: MIT
"""Mark where a curve leaves its axes, so that nothing is cut off unseen."""

import numpy as np
from matplotlib.axes import Axes

from model.arrays import Array

_APART = 0.01  # of the time shown; excursions closer than this share a mark
_MARK = "0.25"
_MOST_MARKS = 12  # of more, which would merge to a bar, only the furthest is marked


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

    Of more than 12 at an edge, only the furthest has one, with the number of excursions beside it.

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
        if len(begins) > _MOST_MARKS:
            far = np.abs(values[outside])
            _write_count(axes, float(at[far.argmax()]), edge, len(begins))
            begins = at[[far.argmax()]]
        axes.plot(
            begins, np.full(len(begins), edge), transform=axes.get_xaxis_transform(),
            ls="none", marker=shape, ms=3.5, color=_MARK, mew=0, clip_on=False, zorder=5,
            label=label,
        )  # fmt: skip


def _write_count(axes: Axes, at: float, edge: float, count: int) -> None:
    axes.annotate(
        f"1 of {count}", (at, edge), xycoords=axes.get_xaxis_transform(), xytext=(4, 0),
        textcoords="offset points", ha="left", va="center", fontsize=7, color=_MARK,
        bbox={"facecolor": "white", "alpha": 0.7, "lw": 0, "pad": 0.5}, zorder=5,
    )  # fmt: skip
