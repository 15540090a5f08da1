# SPDX-License-Identifier: MIT
"""Which runs repeat one another: the same slips at the same load, measured twice."""

import numpy as np

from model.arrays import Array
from model.bayes.averaging.blocks import SlipBlocks
from model.bayes.averaging.load_levels import load_levels, nearest_level

MIDDLE = (0.1, 0.9)  # quantiles between which most slips of a run lie
SAME = 0.005  # of the slip ratio: set-points closer than this are the same
MIN_OVERLAP = 0.5  # of the smaller of two ranges of slip


def repeated_share(blocks: SlipBlocks) -> float:
    """Compute the share of the runs of which another run has the slips and the load, 0 to 1 [-].

    Two runs do if they lie nearest to the same of `load_levels` and the ranges of the middle 80 %
    of their block slips, each at least `SAME` of the slip wide, overlap by half of the smaller one.
    """
    parts = np.split(np.arange(len(blocks)), blocks.run_starts()[1:-1])
    levels = load_levels(blocks)
    loads = np.array([max(float(np.median(blocks.normal_force[part])), 1e-9) for part in parts])
    level = nearest_level(loads, levels)
    low, high = _ranges(blocks, parts)
    shared = np.minimum(high[:, None], high) - np.maximum(low[:, None], low)
    smaller = np.minimum((high - low)[:, None], high - low)
    again = (shared >= MIN_OVERLAP * smaller) & (level[:, None] == level)
    np.fill_diagonal(again, False)
    return float(again.any(axis=1).mean())


def _ranges(blocks: SlipBlocks, parts: list[np.ndarray]) -> tuple[Array, Array]:
    """Return the lower and upper end of the middle slips of each run, shape (n_runs,) each [-]."""
    low, high = np.array([np.quantile(blocks.slip[part], MIDDLE) for part in parts]).T
    least = 0.5 * SAME * np.maximum(np.maximum(np.abs(low), np.abs(high)), 1e-6)
    middle, half = 0.5 * (low + high), 0.5 * (high - low)
    half = np.maximum(half, least)
    return middle - half, middle + half
