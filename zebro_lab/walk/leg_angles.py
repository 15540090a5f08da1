# SPDX-License-Identifier: MIT
"""From a leg log to the angles that a model walks: counts are reconstructed, not taken as told."""

import numpy as np

from model.gait.quantised import QuantisedLog, find_step
from model.gait.reference import SampledReference
from zebro_lab.robot.leg_log import LegLog


def angles_from(
    log: LegLog, start: float
) -> tuple[SampledReference | QuantisedLog, tuple[str, ...]]:
    """Return the angles from time zero on, to be reconstructed where an encoder counted them.

    Args:
        log: The leg log.
        start: Its time that becomes zero [s].

    Returns:
        The angles, and what to tell a person of them.
    """
    t, theta = log.reference.t - start, log.reference.theta
    step = find_step(theta)
    if step is None:
        return SampledReference(t, theta), ()
    note = (
        f"leg log: angles are counted in steps of {np.degrees(step):.3g} deg, reconstructed as "
        "straight lines through the changes of count"
    )
    return QuantisedLog(t, theta, step), (note,)
