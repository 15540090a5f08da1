# SPDX-License-Identifier: MIT
"""Match the poses of two paths by their times."""

import numpy as np
from numpy.typing import NDArray

from model.arrays import Array

Indices = NDArray[np.intp]


def match_times(first: Array, second: Array, *, most: float) -> tuple[Indices, Indices]:
    """Match each time of the shorter series with the nearest of the other, each at most once.

    Of series of equal number it is the second. Of two times that are equally near, the earlier is
    taken; of two that are nearest to the same time, the nearer, or the earlier.

    Args:
        first: Increasing times, shape (n,) [s].
        second: Increasing times by the same clock, shape (m,) [s].
        most: Largest difference of a matched pair [s].

    Returns:
        Indices of the matched times in `first` and in `second`, increasing, possibly empty.
    """
    if len(second) > len(first):
        return _nearest(first, second, most)
    matched, chosen = _nearest(second, first, most)
    return chosen, matched


def _nearest(sparse: Array, dense: Array, most: float) -> tuple[Indices, Indices]:
    """Match sparse times with the nearest dense ones; return indices into sparse and into dense.

    Pairs more than `most` apart are left out; a dense time is matched with the nearest of the
    sparse times that would have it, the earlier of two.
    """
    after = np.minimum(np.searchsorted(dense, sparse, side="right"), len(dense) - 1)
    before = np.maximum(after - 1, 0)
    gap_after, gap_before = np.abs(dense[after] - sparse), np.abs(dense[before] - sparse)
    nearest = np.where(gap_after < gap_before, after, before)
    gap = np.minimum(gap_after, gap_before)
    kept = np.flatnonzero(gap <= most)
    order = kept[np.lexsort((kept, gap[kept], nearest[kept]))]
    chosen = order[np.diff(nearest[order], prepend=-1) > 0]
    return np.sort(chosen), nearest[np.sort(chosen)]
