# SPDX-License-Identifier: MIT
"""Alignment of one path to another, in the plane or in space."""

from typing import NamedTuple

import numpy as np

from model.arrays import Array
from model.poses import Poses


class RigidMotion(NamedTuple):
    """A rigid motion of the plane: rotation about the origin, then translation.

    Attributes:
        rotation: Angle of the rotation, counter-clockwise [rad].
        translation: Shift, shape (2,) [m].
    """

    rotation: float
    translation: Array


class Similarity(NamedTuple):
    """A similarity: scale and rotation about the origin, then translation.

    Attributes:
        scale: Factor on lengths [-].
        rotation: Rotation matrix, shape (d, d).
        translation: Shift, shape (d,) [m].
    """

    scale: float
    rotation: Array
    translation: Array

    def apply(self, position: Array) -> Array:
        """Move positions, shape (n, d) [m]."""
        return self.scale * position @ self.rotation.T + self.translation


def umeyama(x: Array, y: Array, *, with_scale: bool = False) -> Similarity:
    r"""Compute the rigid motion or similarity that brings points closest to others.

    .. math::
        \min_{s, R, p} \sum_i |s R x_i + p - y_i|^2

    Least squares over SE(d), or Sim(d) with scale; R is a proper rotation, never a mirror image.
    Umeyama (1991), Eqs. (34) to (43).

    Args:
        x: Points to move, shape (n, d) [m].
        y: The points to come close to, shape (n, d) [m].
        with_scale: Whether the scale is fitted; else it is 1, and also where all x coincide.

    Returns:
        Scale, rotation and translation; of the rotations that are equally good, any.
    """
    a, b = x - x.mean(axis=0), y - y.mean(axis=0)
    u, d, vt = np.linalg.svd(b.T @ a)
    sign = np.ones_like(d)
    sign[-1] = np.sign(np.linalg.det(u) * np.linalg.det(vt))
    rotation = (u * sign) @ vt
    spread = float(np.sum(a**2))
    scale = float(d @ sign) / spread if with_scale and spread > 0 else 1.0
    return Similarity(scale, rotation, y.mean(axis=0) - scale * rotation @ x.mean(axis=0))


def align(predicted: Poses, tracked: Poses) -> RigidMotion:
    r"""Compute the rigid motion that brings predicted positions closest to tracked ones.

    .. math::
        \min_{R, p} \sum_i |R x_i + p - y_i|^2

    Least squares over SE(2), without scale (Umeyama 1991); headings are not used. Alignment hides a
    wrong start and a wrong heading, so aligned errors never stand alone.

    Args:
        predicted: Predicted poses, positions x_i, one path.
        tracked: Tracked poses, positions y_i, at the same times, one path.

    Returns:
        Rotation R by an angle within [-pi, pi], 0 if either path stays in one place, and
        translation p.
    """
    motion = umeyama(predicted.position, tracked.position)
    rotation = float(np.arctan2(motion.rotation[1, 0], motion.rotation[0, 0]))
    return RigidMotion(rotation, motion.translation)
