# SPDX-License-Identifier: MIT
"""Two weighted loads that stand for all loads within a block."""

from dataclasses import dataclass

import numpy as np

from model.bayes.blocks import SlipBlocks
from model.slip.law import Array


@dataclass(frozen=True)
class LoadRule:
    """Two weighted loads with the mean, variance and skewness of each block's; shape (n,) each.

    Attributes:
        light: The lighter load, as measured [N].
        heavy: The heavier load, as measured [N].
        heavy_share: Share of the block at the heavier load [-].
        slip_light: Slip ratio at the lighter load [-].
        slip_heavy: Slip ratio at the heavier load [-].
        slip_per_load: Slope of slip over load within the block [1/N].
        slip_variance: Variance of the slip that follows load by that slope [-].
    """

    light: Array
    heavy: Array
    heavy_share: Array
    slip_light: Array
    slip_heavy: Array
    slip_per_load: Array
    slip_variance: Array


def load_rule(blocks: SlipBlocks) -> LoadRule:
    """Compute two loads and their shares with each block's mean, variance and skewness of load.

    Slip at the two loads follows load by the block's regression of slip on load. The load's
    standard deviation counts as 0.1 % of its mean at least.
    """
    # A block at a single load gets a small spread, so that the slope in load is defined.
    spread = np.maximum(np.sqrt(blocks.load_variance), 1e-3 * blocks.normal_force)
    half = 0.5 * blocks.load_skewness
    root = np.sqrt(1 + half**2)
    up, down = spread * (half + root), spread * (half - root)
    per_load = blocks.slip_load_covariance / spread**2
    return LoadRule(
        light=blocks.normal_force + down,
        heavy=blocks.normal_force + up,
        heavy_share=0.5 * (1 - half / root),
        slip_light=blocks.slip + per_load * down,
        slip_heavy=blocks.slip + per_load * up,
        slip_per_load=per_load,
        slip_variance=per_load**2 * spread**2,
    )
