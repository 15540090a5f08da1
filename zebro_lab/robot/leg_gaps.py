# SPDX-License-Identifier: MIT
"""Gaps in a leg log: short ones in which every leg keeps its speed are bridged, others refused."""

from typing import Final

import numpy as np
from numpy.typing import NDArray

from model.arrays import Array
from model.format_distinct import format_distinct
from zebro_lab.tables.raw_table import RawTable

WIDEST: Final = 5.0
"""Step of time that is no gap yet [median steps]."""
LONGEST_BRIDGED: Final = 0.25
"""Longest gap that is bridged: in more time a leg may swing and come to rest unseen [s]."""
_BESIDE: Final = 0.1  # s before and after a gap, of which the legs' speeds are taken
_FEWEST: Final = 3  # samples there
_APART: Final = 0.15
"""Largest distance of the angle behind a gap from that at an unchanged speed [rad].

Two counts of an encoder of 100 a turn; a leg that begins or ends its swing in 0.1 s is further off.
"""


def bridged_gaps(
    table: RawTable, column: str, t: Array, theta: Array, *, advice: str
) -> tuple[str, ...]:
    """Check the gaps of a leg log, and return a note on each that is bridged by straight lines.

    A gap is bridged if it lasts at most `LONGEST_BRIDGED`, and the angle of every leg behind it is
    the one that the leg reaches at its speed before the gap, and at that after it.

    Args:
        table: Table of the log.
        column: Name of its column of times.
        t: Times, increasing, shape (n,) [s].
        theta: Unwrapped angles, shape (n, 6) [rad].
        advice: What to do about a gap that is not bridged.

    Raises:
        DataError: A gap is longer, or a leg changes its speed in it; names the row.
    """
    steps = np.diff(t)
    usual = float(np.median(steps))
    gaps = np.flatnonzero(steps > WIDEST * usual)
    notes = []
    for at in gaps:
        before, now = format_distinct(t[at], t[at + 1])
        if why := _why_not(t, theta, int(at), gaps):
            raise table.fault(
                f"time jumps from {before} to {now} s, and {why}; expected at most {WIDEST:g} "
                f"times the usual {usual:.4g} s, or {LONGEST_BRIDGED:g} s in which every leg keeps "
                f"its speed: {advice}",
                column,
                int(at) + 1,
            )
        notes.append(
            f"WARNING: leg log: no samples from {before} to {now} s; every leg keeps its speed, "
            "and straight lines bridge this gap"
        )
    return tuple(notes)


def _why_not(t: Array, theta: Array, at: int, gaps: NDArray[np.intp]) -> str | None:
    """Return why the gap after sample `at` is not bridged; None if it is."""
    length = t[at + 1] - t[at]
    if length > LONGEST_BRIDGED:
        return f"that is {length:.3g} s"
    first = np.searchsorted(t, t[at] - _BESIDE - 1e-9)
    last = np.searchsorted(t, t[at + 1] + _BESIDE + 1e-9) - 1
    if at - first < _FEWEST - 1 or last - at - 1 < _FEWEST - 1:
        return "too few samples beside it tell the legs' speeds"
    if np.any((gaps != at) & (gaps >= first) & (gaps < last)):
        return "another gap is too near to tell the legs' speeds"
    turned = theta[at + 1] - theta[at]
    before = (theta[at] - theta[first]) / (t[at] - t[first])
    after = (theta[last] - theta[at + 1]) / (t[last] - t[at + 1])
    off = np.abs(np.stack([before, after]) * length - turned).max(axis=0)
    if off.max() > _APART:
        return f"leg {int(off.argmax()) + 1} changes its speed in that time"
    return None
