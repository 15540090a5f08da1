# SPDX-License-Identifier: MIT
"""Leg angles of a log as model input: encoder counts and noisy angles are reconstructed."""

import numpy as np

from model.arrays import Array
from model.gait.inexact_log import InexactLog
from model.gait.reference import SampledReference
from model.gait.resolution import SEEN, find_noise, find_step
from model.robot import N_LEGS
from zebro_lab.robot.leg_log import LegLog

# Counts to which noise was added before they were counted flicker at their boundaries: lines within
# half a count are more than these times as many as lines within the noise of counts, from a tenth
# of a count of noise on. Without noise they are up to twice as many where servos yield, and up to
# five times beyond 10,000 counts a turn, where what servos yield is itself more than a count.
JAGGED = 2.5
_THROUGH_COUNTS = ", reconstructed as straight lines through the changes of count"
_TOO_COARSE = (
    "leg log: angles change too much between samples, or repeat too often, to tell noise from "
    "motion; they are taken as they are. Log new angles more often"
)


def angles_from(log: LegLog, start: float) -> tuple[SampledReference | InexactLog, tuple[str, ...]]:
    """Shift a leg log to start at time zero; find the step of its angles, or their noise.

    Angles with neither are taken as they are, as are angles without a step that are too coarse to
    tell noise from motion. Noisy ones are reconstructed within their noise, and encoder counts as
    lines through the changes of count. If counts need over `JAGGED` times as many lines as noisy
    angles would, they are taken as noisy.

    Args:
        log: The leg log.
        start: Time of the log that becomes zero [s].

    Returns:
        The angles, an `InexactLog` if they are encoder counts or have noise; and notes.
    """
    t, theta = log.reference.t - start, log.reference.theta
    step = find_step(theta)
    noise = find_noise(t, theta, step or 0.0)
    if step is None:
        if noise is None:
            return SampledReference(t, theta), ()
        if np.isnan(noise).any():
            return SampledReference(t, theta), (_TOO_COARSE,)
        noisy = InexactLog(t, theta, 0.0, np.maximum(noise, SEEN))
        return noisy, (f"leg log: angles carry {_told(noisy, noise)}",)
    counts = f"leg log: angles are counted in steps of {np.degrees(step):.3g} deg"
    counted = InexactLog(t, theta, step)
    if noise is not None and np.isnan(noise).any():
        return counted, (f"{counts}{_THROUGH_COUNTS}",)
    least = step / np.sqrt(12.0)  # the standard deviation of what counting leaves out
    noise = np.full(N_LEGS, least) if noise is None else np.maximum(noise, least)
    noisy = InexactLog(t, theta, step, noise)
    if counted.lines > JAGGED * noisy.lines:
        told = _told(noisy, noise)
        return noisy, (f"{counts} and leave straight lines by more than counting: {told}",)
    return counted, (f"{counts}{_THROUGH_COUNTS}",)


def _told(log: InexactLog, noise: Array) -> str:
    """Say how large the legs' noise is at most, and what is done about it."""
    worst = float(noise.max())
    told = (
        f"noise of {np.degrees(worst):.2g} deg ({1e3 * worst:.2g} mrad), reconstructed as "
        "straight lines through the samples"
    )
    if log.uneven:
        told += f"; {log.uneven} of {N_LEGS} legs turn unevenly and are smoothed as curves instead"
    return told
