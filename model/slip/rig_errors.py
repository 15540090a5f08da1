# SPDX-License-Identifier: MIT
"""Errors of the rig that a fit estimates: ratio of the radii, rolling resistance, run-out."""

import math
from dataclasses import dataclass

RADIUS_TOLERANCE = 1e-4
"""Standard deviation of a radius measured with a calliper, the tread's softness included [m]."""
UNKNOWN_RATIO = 0.01
"""Standard deviation of the relative error of the ratio of two radii that are not known [-]."""
ROLLING_RESISTANCE = 0.02
"""Scale of Student's t for the rolling resistance of rubber on a disc, over the load [-]."""
RUN_OUT = 5e-5
"""Amplitude by which the radius of a disc at the contact varies once a turn [m]."""
UNKNOWN_SCATTER = 0.002
"""Typical size of a block's slip that the measured speeds do not show, for unknown discs [-]."""


@dataclass(frozen=True)
class RigErrors:
    """Prior scales of errors of the rig, each about zero; standard deviations if not said.

    Attributes:
        radius_ratio: Of the relative error of the ratio of the discs' radii [-].
        rolling_resistance: Of the resistance of rolling over the load, that of Student's t [-].
        slip_scatter: Scale of the half-normal prior on the standard deviation of that part of a
            block's slip which the measured speeds do not show [-].
        run_out: Standard deviation of each coefficient of run-out of a disc whose angle is
            recorded [m].
    """

    radius_ratio: float = UNKNOWN_RATIO
    rolling_resistance: float = ROLLING_RESISTANCE
    slip_scatter: float = UNKNOWN_SCATTER
    run_out: float = RUN_OUT


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


def run_out_scatter(radius_leg: float, radius_ground: float, run_out: float) -> float:
    """Compute the standard deviation of slip where the radii of both discs vary as sines [-].

    Args:
        radius_leg: Radius of the leg disc [m].
        radius_ground: Radius of the ground disc [m].
        run_out: Amplitude of each radius over a turn [m].

    >>> round(run_out_scatter(0.035, 0.12, 5e-5), 5)
    0.00105
    """
    return radius_ratio_sd(radius_leg, radius_ground, run_out) / math.sqrt(2)
