# SPDX-License-Identifier: MIT
"""Compare the leg speeds of a gait or program with those that the robot's legs reach."""

import numpy as np

from model.arrays import Array
from model.gait import CyclicReference, SampledReference


def largest_speeds(reference: CyclicReference | SampledReference) -> Array:
    """Return the largest speed of each leg, without its sign, shape (6,) [rad/s]."""
    if isinstance(reference, CyclicReference):
        return np.maximum(np.abs(reference.ground_speed), np.abs(reference.flight_speed))
    steps = np.diff(reference.theta, axis=0) / np.diff(reference.t)[:, None]
    return np.abs(steps).max(axis=0)


def speed_warnings(
    reference: CyclicReference | SampledReference, limit: float | None
) -> tuple[str, ...]:
    """Return a warning if a leg turns faster than the robot's legs can; else nothing.

    Args:
        reference: Leg angles over time.
        limit: Largest speed of a leg [rad/s]; None if it is not known.
    """
    speeds = largest_speeds(reference)
    leg = int(speeds.argmax())
    if limit is None or speeds[leg] <= limit * (1 + 1e-9):
        return ()
    return (
        f"WARNING: leg {leg + 1} turns at up to {np.degrees(speeds[leg]):.0f} deg/s; the robot's "
        f"legs turn at most at {np.degrees(limit):.0f} deg/s (legs.speed_limit_deg_per_s of "
        "robot.toml): lengthen the flight time or the cycle",
    )
