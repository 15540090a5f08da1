# SPDX-License-Identifier: MIT
"""Rigid poses over time in space or in a plane, and their projection onto a plane of the axes."""

from dataclasses import dataclass
from typing import Self

import numpy as np
from numpy.typing import NDArray

from model.arrays import Array
from model.errors import DomainError
from model.poses import Poses

AXES = "xyz"


@dataclass(frozen=True)
class RigidPath:
    """Poses over time in space (d = 3) or in a plane (d = 2).

    Attributes:
        t: Times, shape (n,) [s].
        position: Positions, shape (n, d) [m].
        rotation: Rotations from the body's frame to that of the positions, shape (n, d, d); None
            where they are not known.
    """

    t: Array
    position: Array
    rotation: Array | None = None

    def __len__(self) -> int:
        """Return the number of poses."""
        return len(self.t)

    @classmethod
    def of_poses(cls, poses: Poses) -> Self:
        """Return a path in the plane, without rotations if a heading is missing."""
        c, s = np.cos(poses.yaw), np.sin(poses.yaw)
        rotation = np.stack([np.stack([c, -s], axis=-1), np.stack([s, c], axis=-1)], axis=-2)
        return cls(poses.t, poses.position, rotation if poses.has_yaw else None)

    @property
    def travelled(self) -> Array:
        """Distance travelled up to each pose, along straight lines, shape (n,) [m]."""
        steps = np.linalg.norm(np.diff(self.position, axis=0), axis=1)
        return np.concatenate([[0.0], np.cumsum(steps)])

    def part(self, keep: NDArray[np.intp] | NDArray[np.bool_]) -> "RigidPath":
        """Select poses by indices or by a boolean mask."""
        rotation = None if self.rotation is None else self.rotation[keep]
        return RigidPath(self.t[keep], self.position[keep], rotation)

    def scaled(self, factor: float) -> "RigidPath":
        """Multiply all positions by a factor [-]."""
        return RigidPath(self.t, factor * self.position, self.rotation)

    def in_plane(self, plane: str, *, forward: str) -> Poses:
        """Project a path in space onto a plane of two axes.

        The heading is the direction, in the plane, of the body's axis that points ahead. It is
        positive from the plane's first axis to its second.

        Args:
            plane: Two of the axes x, y and z, such as "xy".
            forward: Axis of the body that points ahead, "x", "y" or "z".

        Returns:
            Poses whose x and y are the plane's first and second axis; headings are unwrapped, NaN
            without rotations.

        Raises:
            DomainError: The plane is not two different axes.
        """
        first, second = plane_axes(plane)
        yaw = np.full(len(self), np.nan)
        if self.rotation is not None:
            ahead = self.rotation[:, :, AXES.index(forward)]
            yaw = np.unwrap(np.arctan2(ahead[:, second], ahead[:, first]))
        return Poses(self.t, self.position[:, [first, second]], yaw)


def plane_axes(plane: str) -> tuple[int, int]:
    """Return the indices of a plane's two axes.

    >>> plane_axes("zx")
    (2, 0)

    Raises:
        DomainError: The plane is not two different axes of x, y and z.
    """
    if len(plane) != 2 or not set(plane) <= set(AXES) or plane[0] == plane[1]:
        raise DomainError(f"plane '{plane}'; expected two different axes, such as xy or xz")
    return AXES.index(plane[0]), AXES.index(plane[1])


def rotations_of_quaternions(quaternion: Array) -> Array:
    """Convert quaternions x, y, z, w of any length but zero to rotations.

    Args:
        quaternion: Shape (n, 4), w last [-].

    Returns:
        Rotation matrices, shape (n, 3, 3).
    """
    x, y, z, w = (quaternion / np.linalg.norm(quaternion, axis=1, keepdims=True)).T
    rows = [
        [1 - 2 * (y * y + z * z), 2 * (x * y - z * w), 2 * (x * z + y * w)],
        [2 * (x * y + z * w), 1 - 2 * (x * x + z * z), 2 * (y * z - x * w)],
        [2 * (x * z - y * w), 2 * (y * z + x * w), 1 - 2 * (x * x + y * y)],
    ]
    return np.moveaxis(np.array(rows), -1, 0)
