# SPDX-License-Identifier: MIT
"""Rigid alignment of one planar path to another."""

from typing import NamedTuple

import numpy as np

from model.poses import Poses
from model.slip.law import Array


class RigidMotion(NamedTuple):
    """A rigid motion of the plane: rotation about the origin, then translation.

    Attributes:
        rotation: Angle of the rotation, counter-clockwise [rad].
        translation: Shift, shape (2,) [m].
    """

    rotation: float
    translation: Array


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
    x, y = predicted.position, tracked.position
    a, b = x - x.mean(axis=0), y - y.mean(axis=0)
    rotation = float(np.arctan2((a[:, 0] * b[:, 1] - a[:, 1] * b[:, 0]).sum(), (a * b).sum()))
    c, s = np.cos(rotation), np.sin(rotation)
    return RigidMotion(rotation, y.mean(axis=0) - np.array([[c, -s], [s, c]]) @ x.mean(axis=0))
