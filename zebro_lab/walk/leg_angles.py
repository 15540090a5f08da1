# SPDX-License-Identifier: MIT
"""Leg angles of a log as model input: quantised encoder counts are reconstructed."""

import numpy as np

from model.gait.quantised import QuantisedLog, find_step
from model.gait.reference import SampledReference
from zebro_lab.robot.leg_log import LegLog


def angles_from(
    log: LegLog, start: float
) -> tuple[SampledReference | QuantisedLog, tuple[str, ...]]:
    """Return leg angles from time zero on, with their resolution if they are encoder counts.

    Args:
        log: The leg log.
        start: Time of the log that becomes zero [s].

    Returns:
        The angles, and notes, one line each.
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
