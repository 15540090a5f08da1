# SPDX-License-Identifier: MIT
"""Geometry of the robot for drawing: body, hips and legs in the inertial frame."""

import numpy as np

from model.arrays import Array
from model.frames import attitude
from model.robot import Robot

_ARC_POINTS = 25
_CORNERS = np.array([[x, y, z] for x in (-1, 1) for y in (-1, 1) for z in (-1, 1)]) / 2
FACES = ((0, 1, 3, 2), (4, 5, 7, 6), (0, 1, 5, 4), (2, 3, 7, 6), (0, 2, 6, 4), (1, 3, 7, 5))
"""Four corners of each side of the body, as row indices of `body_corners`."""


def to_world(points: Array, position: Array, orientation: Array) -> Array:
    """Transform points from the body frame to the inertial or floor frame, shape (..., 3) [m].

    Args:
        points: Points in the body frame, shape (..., 3) [m].
        position: Body's centre in the target frame, shape (3,) [m].
        orientation: Roll, pitch and yaw of the body in that frame, shape (3,) [rad].
    """
    return points @ attitude(*orientation).T + position


def body_corners(robot: Robot) -> Array:
    """Compute the corners of the body in the body frame, shape (8, 3) [m].

    From low to high, x varies slowest and z fastest: rear right bottom comes first.
    """
    return _CORNERS * np.asarray(robot.body_size)


def leg_arcs(robot: Robot, theta: Array) -> Array:
    r"""Compute 25 points along each leg, hip to toe, in the body frame, shape (6, 25, 3) [m].

    The arc's centre lies a radius r from the hip h in the direction theta; from the hip the arc of
    angle A goes over the rear to the toe.

    .. math::
        p(s) = h + r \begin{pmatrix} \cos\theta \\ 0 \\ -\sin\theta \end{pmatrix}
                 + r \begin{pmatrix} \cos\alpha \\ 0 \\ -\sin\alpha \end{pmatrix}, \qquad
        \alpha = \theta + \pi - s, \quad 0 \le s \le A

    Args:
        robot: The robot.
        theta: Leg angles, shape (6,) [rad].

    >>> toes = leg_arcs(Robot(), np.full(6, np.pi / 2))[:, -1]
    >>> bool(np.allclose(toes - Robot().hips, [0, 0, -0.07]))  # straight down
    True
    """
    r, along = robot.leg_radius, np.linspace(0, robot.leg_arc, _ARC_POINTS)
    alpha = theta[:, None] + np.pi - along
    x = np.cos(theta)[:, None] + np.cos(alpha)
    z = -np.sin(theta)[:, None] - np.sin(alpha)
    return robot.hips[:, None] + r * np.stack([x, np.zeros_like(x), z], axis=-1)


def outline(robot: Robot) -> Array:
    """Compute the closed outline of the body from above, with a tip at the head.

    Returns points in the body frame with z = 0, from rear left by rear right to the head and back,
    the last equal to the first, shape (6, 3) [m].
    """
    length, width, _ = robot.body_size
    tip = 0.15 * length
    x = np.array([-0.5, -0.5, 0.5, 0.5, 0.5, -0.5]) * length
    y = np.array([0.5, -0.5, -0.5, 0.0, 0.5, 0.5]) * width
    x[3] += tip
    return np.column_stack([x, y, np.zeros_like(x)])
