# SPDX-License-Identifier: MIT
"""Errors of the rig that a fit estimates: the ratio of the discs' radii and rolling resistance."""

import math
from dataclasses import dataclass

import numpy as np

from model.bayes.blocks import SlipBlocks

RADIUS_TOLERANCE = 1e-4
"""Standard deviation of a radius measured with a calliper, the tread's softness included [m]."""
UNKNOWN_RATIO = 0.01
ROLLING_RESISTANCE = 0.02
FEWEST_RUNS = 2  # on each side of zero slip
_CLEAR = 3.0  # standard errors by which the mean slip of a run is on one side


@dataclass(frozen=True)
class RigErrors:
    """Prior standard deviations of errors of the rig, each about zero.

    Attributes:
        radius_ratio: Of the relative error of the ratio of the discs' radii [-].
        rolling_resistance: Of the resistance of rolling over the load [-].
    """

    radius_ratio: float = UNKNOWN_RATIO
    rolling_resistance: float = ROLLING_RESISTANCE


USUAL = RigErrors()
"""Those of a rig of which nothing is stated."""


def radius_ratio_sd(radius_leg: float, radius_ground: float, tolerance: float) -> float:
    """Compute the standard deviation of the relative error of the ratio of two radii [-].

    Args:
        radius_leg: Radius of the leg disc [m].
        radius_ground: Radius of the ground disc [m].
        tolerance: Standard deviation of each radius [m].

    >>> round(radius_ratio_sd(0.035, 0.12, 1e-4), 5)
    0.00298
    """
    return tolerance * math.hypot(1 / radius_leg, 1 / radius_ground)


def tested_on_both_sides(blocks: SlipBlocks) -> bool:
    """Return whether slip was driving in two runs or more, and braking in two or more.

    Only then can a curve that goes through zero be told from one that is shifted: in slip, by wrong
    radii, or in force, by rolling resistance. A run is on a side if the slip of one of its blocks
    is there by more than three standard deviations of its error.
    """
    sd = np.sqrt(blocks.slip_error + blocks.run_slip_error[blocks.run])
    sides = [np.unique(blocks.run[sign * blocks.slip > _CLEAR * sd]) for sign in (1, -1)]
    return min(len(runs) for runs in sides) >= FEWEST_RUNS
