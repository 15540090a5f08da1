# SPDX-License-Identifier: MIT
"""Notes on a walk: its ground, and legs that turn faster than the robot's can."""

import numpy as np

from model.arrays import Array
from model.gait import CyclicReference, SampledReference
from model.robot import Robot
from model.walk.ground import beyond_grid
from model.walk.path import WalkPath
from zebro_lab.ground.ground_file import GroundFile


def ground_notes(ground: GroundFile, path: WalkPath, robot: Robot) -> tuple[str, ...]:
    """Return notes on a walk's ground, one line each: its parts, and a warning beyond its map.

    The robot is beyond the map where any of its hips is, seen from above with level body.

    Args:
        ground: The ground.
        path: The walk.
        robot: The robot that walked.
    """
    parts = tuple(f"ground: {each}" for each in ground.what)
    c, s = np.cos(path.yaw)[:, None], np.sin(path.yaw)[:, None]
    x = path.position[:, :1] + c * robot.hips[:, 0] - s * robot.hips[:, 1]
    y = path.position[:, 1:2] + s * robot.hips[:, 0] + c * robot.hips[:, 1]
    beyond = beyond_grid(ground.ground, x, y).any(axis=1)
    if not beyond.any():
        return parts
    first = int(beyond.argmax())
    at_x, at_y = path.position[first, :2]
    return (
        *parts,
        f"WARNING: the robot is off the map of heights in {beyond.mean():.1%} of the time, first "
        f"{path.t[first] - path.t[0]:.2f} s after the start with its centre at x {at_x:.3f}, "
        f"y {at_y:.3f} m; there the height of the map's edge continues",
    )


def largest_speeds(reference: CyclicReference | SampledReference) -> Array:
    """Return the largest speed of each leg, without its sign, shape (6,) [rad/s]."""
    if isinstance(reference, CyclicReference):
        return np.maximum(np.abs(reference.ground_speed), np.abs(reference.flight_speed))
    steps = np.diff(reference.theta, axis=0) / np.diff(reference.t)[:, None]
    return np.abs(steps).max(axis=0)


def speed_warnings(
    reference: CyclicReference | SampledReference, limit: float | None
) -> tuple[str, ...]:
    """Return a warning if a leg turns faster than the robot's legs can; else an empty tuple.

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
