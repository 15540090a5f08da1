# SPDX-License-Identifier: MIT
"""Leg angles of a log as model input: quantised encoder counts are reconstructed."""

import numpy as np

from model.gait.quantised import QuantisedLog, find_step
from model.gait.reference import SampledReference
from zebro_lab.robot.leg_log import LegLog


def angles_from(
    log: LegLog, start: float
) -> tuple[SampledReference | QuantisedLog, tuple[str, ...]]:
    """Shift a leg log to start at time zero, and find the step of its angles if they are counts.

    Args:
        log: The leg log.
        start: Time of the log that becomes zero [s].

    Returns:
        The angles, a `QuantisedLog` with their step if they are encoder counts; and notes.
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
