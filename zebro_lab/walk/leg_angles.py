# SPDX-License-Identifier: MIT
"""Leg angles of a log as model input: encoder counts and noisy angles are reconstructed."""

import numpy as np

from model.gait.quantised import QuantisedLog
from model.gait.reference import SampledReference
from model.gait.resolution import SEEN, find_noise, find_step
from zebro_lab.robot.leg_log import LegLog


def angles_from(
    log: LegLog, start: float
) -> tuple[SampledReference | QuantisedLog, tuple[str, ...]]:
    """Shift a leg log to start at time zero; find the step of its angles, or their noise.

    Args:
        log: The leg log.
        start: Time of the log that becomes zero [s].

    Returns:
        The angles, a `QuantisedLog` if they are encoder counts or have noise; and notes.
    """
    t, theta = log.reference.t - start, log.reference.theta
    step = find_step(theta)
    if step is not None:
        note = (
            f"leg log: angles are counted in steps of {np.degrees(step):.3g} deg, reconstructed as "
            "straight lines through the changes of count"
        )
        return QuantisedLog(t, theta, step), (note,)
    noise = find_noise(t, theta)
    if noise is None:
        return SampledReference(t, theta), ()
    worst = float(noise.max())
    note = (
        f"leg log: angles carry noise of {np.degrees(worst):.2g} deg ({1e3 * worst:.2g} mrad), "
        "reconstructed as straight lines through the samples"
    )
    return QuantisedLog(t, theta, 0.0, np.maximum(noise, SEEN)), (note,)
