# SPDX-License-Identifier: MIT
"""Say of a walk what its ground is, and where the robot left the map of it."""

import numpy as np

from model.robot import Robot
from model.walk.ground import beyond_grid
from model.walk.path import WalkPath
from zebro_lab.ground.ground_file import GroundFile


def ground_notes(ground: GroundFile, path: WalkPath, robot: Robot) -> tuple[str, ...]:
    """Return notes on a walk's ground, one line each: its parts, and a warning beyond its map.

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
