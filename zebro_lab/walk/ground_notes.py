# SPDX-License-Identifier: MIT
"""Say of a walk what its ground is, and where the robot left the map of it."""

import numpy as np

from model.robot import Robot
from model.walk.ground import beyond_grid
from model.walk.path import WalkPath
from zebro_lab.ground.ground_file import GroundFile


def ground_notes(ground: GroundFile, path: WalkPath, robot: Robot) -> tuple[str, ...]:
    """Return notes on a walk's ground, one line each: its parts, and warnings of what is not known.

    Args:
        ground: The ground.
        path: The walk.
        robot: The robot that walked.
    """
    parts = tuple(f"ground: {each}" for each in ground.what)
    return (*parts, *ground.notes, *_off_the_map(ground, path, robot), *_too_high(ground, robot))


def _off_the_map(ground: GroundFile, path: WalkPath, robot: Robot) -> tuple[str, ...]:
    """Warn if a hip was beyond the map of heights."""
    c, s = np.cos(path.yaw)[:, None], np.sin(path.yaw)[:, None]
    x = path.position[:, :1] + c * robot.hips[:, 0] - s * robot.hips[:, 1]
    y = path.position[:, 1:2] + s * robot.hips[:, 0] + c * robot.hips[:, 1]
    beyond = beyond_grid(ground.terrain.ground, x, y).any(axis=1)
    if not beyond.any():
        return ()
    first = int(beyond.argmax())
    at_x, at_y = path.position[first, :2]
    return (
        f"WARNING: the robot is off the map of heights in {beyond.mean():.1%} of the time, first "
        f"{path.t[first] - path.t[0]:.2f} s after the start with its centre at x {at_x:.3f}, "
        f"y {at_y:.3f} m; there the height of the map's edge continues",
    )


def _too_high(ground: GroundFile, robot: Robot) -> tuple[str, ...]:
    """Warn of steps that are higher than the legs' radius, whose faces legs touch sideways."""
    rise = ground.terrain.ground.rise
    if not (np.abs(rise) > robot.leg_radius).any():
        return ()
    return (
        f"WARNING: a step of {1000 * np.abs(rise).max():g} mm is higher than the legs' radius, "
        f"{1000 * robot.leg_radius:g} mm: contacts are found from above, and those with its face "
        "are not to be trusted",
    )
