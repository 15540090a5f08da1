# SPDX-License-Identifier: MIT
"""Loads that were set, found from block means, and what was measured at each."""

import numpy as np
from numpy.typing import NDArray

from model.arrays import Array
from model.bayes.averaging.blocks import SlipBlocks
from model.slip.load_curves import LOAD_GAP

RARE_LEVEL = 0.05  # least share of the runs at a level
MAX_LOAD_LEVELS = 8


def load_levels(blocks: SlipBlocks) -> Array:
    """Find the loads that were set, in increasing order, shape (n_levels,) [N].

    A run's load is the lower quartile of its blocks' loads (a bump on a disc only adds to it).
    Sorted loads of runs form one level, their median, until one is more than 10 % above the last. A
    level with fewer than one run in twenty is dropped (a disc that stood still on its bump). With
    no level left, or more than 8 (the load was swept), 8 quantiles of the blocks' loads replace
    them.
    """
    parts = np.split(blocks.normal_force, blocks.run_starts()[1:-1])
    ordered = np.sort([np.quantile(part, 0.25) for part in parts])
    groups = np.split(ordered, np.flatnonzero(ordered[1:] > LOAD_GAP * ordered[:-1]) + 1)
    levels = np.array([np.median(g) for g in groups if len(g) >= RARE_LEVEL * blocks.n_runs])
    if 1 <= len(levels) <= MAX_LOAD_LEVELS:
        return levels
    return np.quantile(blocks.normal_force, (np.arange(MAX_LOAD_LEVELS) + 0.5) / MAX_LOAD_LEVELS)


def middle_loads(blocks: SlipBlocks) -> Array:
    """Compute the load of the middle of the measurements at each of `load_levels`, shape (m,) [N].

    It is the median of the blocks nearest to the level, at which a curve passes through the
    middle of its points; the level itself where no block is nearest to it. The level is lower,
    since it is made of lower quartiles.
    """
    levels = load_levels(blocks)
    load = np.maximum(blocks.normal_force, 1e-9)
    nearest = nearest_level(load, levels)
    near = [load[nearest == i] for i in range(len(levels))]
    return np.array([np.median(each) if len(each) else levels[i] for i, each in enumerate(near)])


def nearest_level(load: Array, levels: Array) -> NDArray[np.intp]:
    """Find the load level nearest to each load, by the ratio of the two.

    Args:
        load: Positive loads, shape (n,) [N].
        levels: Positive load levels, shape (m,) [N].

    Returns:
        Index of the level, shape (n,).
    """
    return np.argmin(np.abs(np.log(load[:, None] / levels)), axis=1)


def largest_slips(blocks: SlipBlocks) -> Array:
    """Compute the largest absolute slip ratio of the blocks nearest to each of `load_levels`.

    Shape (n_levels,) [-]; 0 for a level without blocks.
    """
    levels = load_levels(blocks)
    nearest = nearest_level(np.maximum(blocks.normal_force, 1e-9), levels)
    return np.array(
        [np.abs(blocks.slip[nearest == i]).max(initial=0.0) for i in range(len(levels))]
    )
