# SPDX-License-Identifier: MIT
"""Two weighted loads that stand for all loads within a block."""

from typing import NamedTuple

import numpy as np

from model.arrays import Array
from model.bayes.averaging.blocks import SlipBlocks

LEAST_SPREAD = 0.001  # of the mean load, so that a slope in load is always defined [-]
LEAST_FOLLOWED = 0.005  # of the mean load: below it crosstalk and noise vary the load, not the rig


class LoadRule(NamedTuple):
    """Two weighted loads with the mean, variance and skewness of each block's; shape (n,) each.

    Attributes:
        light: The lighter load, as measured [N].
        heavy: The heavier load, as measured [N].
        heavy_share: Share of the block at the heavier load [-].
        variance: Variance of the load [N^2].
        followed: Variance of the load over which `slip_per_load` is computed, at least the square
            of `LEAST_FOLLOWED` times the mean load [N^2].
        slip_per_load: Slope of slip over measured load within the block [1/N].
    """

    light: Array
    heavy: Array
    heavy_share: Array
    variance: Array
    followed: Array
    slip_per_load: Array


def load_rule(blocks: SlipBlocks) -> LoadRule:
    """Compute two loads and their shares with each block's mean, variance and skewness of load.

    The load's standard deviation counts as `LEAST_SPREAD` of its mean at least, and in `followed`
    as `LEAST_FOLLOWED` of it.
    """
    # A block at a single load gets a small spread, so that the slope in load is defined.
    spread = np.maximum(np.sqrt(blocks.load_variance), LEAST_SPREAD * blocks.normal_force)
    followed = np.maximum(spread, LEAST_FOLLOWED * blocks.normal_force) ** 2
    half = 0.5 * blocks.load_skewness
    root = np.sqrt(1 + half**2)
    up, down = spread * (half + root), spread * (half - root)
    return LoadRule(
        light=blocks.normal_force + down,
        heavy=blocks.normal_force + up,
        heavy_share=0.5 * (1 - half / root),
        variance=spread**2,
        followed=followed,
        slip_per_load=blocks.slip_load_covariance / followed,
    )
