# SPDX-License-Identifier: MIT
"""Orientations as unit quaternions (w, x, y, z), body to world."""

import numpy as np

from model.arrays import Array
from model.compiled import inlined


@inlined
def rotation_matrix(q, R):
    """Compute the rotation matrix of a unit quaternion, body to world.

    Args:
        q: Unit quaternion (w, x, y, z), shape (4,).
        R: Filled: rotation matrix, shape (3, 3).
    """
    w, x, y, z = q
    R[0, 0], R[0, 1], R[0, 2] = 1 - 2 * (y * y + z * z), 2 * (x * y - w * z), 2 * (x * z + w * y)
    R[1, 0], R[1, 1], R[1, 2] = 2 * (x * y + w * z), 1 - 2 * (x * x + z * z), 2 * (y * z - w * x)
    R[2, 0], R[2, 1], R[2, 2] = 2 * (x * z - w * y), 2 * (y * z + w * x), 1 - 2 * (x * x + y * y)


@inlined
def rotate(q, w, dt):
    """Rotate an orientation by one step dt at constant angular velocity; normalise the quaternion.

    Args:
        q: Unit quaternion (w, x, y, z), updated in place, shape (4,).
        w: Angular velocity in the world frame, shape (3,) [rad/s].
        dt: Length of the step [s].
    """
    angle = np.sqrt(w[0] ** 2 + w[1] ** 2 + w[2] ** 2) * dt
    half = 0.5 * angle
    s = 0.5 * dt * (1 - half * half / 6) if angle < 1e-4 else np.sin(half) / angle * dt
    a, b, c, d = np.cos(half), s * w[0], s * w[1], s * w[2]
    q0, q1, q2, q3 = q
    q[0] = a * q0 - b * q1 - c * q2 - d * q3
    q[1] = a * q1 + b * q0 + c * q3 - d * q2
    q[2] = a * q2 - b * q3 + c * q0 + d * q1
    q[3] = a * q3 + b * q2 - c * q1 + d * q0
    size = np.sqrt(q[0] ** 2 + q[1] ** 2 + q[2] ** 2 + q[3] ** 2)
    for i in range(4):
        q[i] /= size


def turned_about_vertical(q: Array, yaw: float) -> Array:
    """Return an orientation quaternion, shape (4,), rotated about the world's vertical.

    Args:
        q: Unit quaternion (w, x, y, z), body to world, shape (4,).
        yaw: Angle, counter-clockwise seen from above [rad].
    """
    c, s = np.cos(0.5 * yaw), np.sin(0.5 * yaw)
    w, x, y, z = q
    return np.array([c * w - s * z, c * x - s * y, c * y + s * x, c * z + s * w])


def roll_pitch_yaw(q: Array) -> Array:
    """Convert unit quaternions (w, x, y, z) to roll, pitch and yaw, R = Rz(yaw) Ry(pitch) Rx(roll).

    Args:
        q: Quaternions, shape (n, 4).

    Returns:
        Roll, pitch and unwrapped yaw, shape (n, 3) [rad].
    """
    w, x, y, z = q.T
    roll = np.arctan2(2 * (y * z + w * x), 1 - 2 * (x * x + y * y))
    pitch = np.arcsin(np.clip(2 * (w * y - x * z), -1.0, 1.0))
    return np.column_stack([roll, pitch, unwrapped_yaw(q)])


def unwrapped_yaw(q: Array) -> Array:
    """Compute the yaw of successive unit quaternions (w, x, y, z), unwrapped along the rows.

    Args:
        q: Quaternions, shape (n, 4).

    Returns:
        Yaw, shape (n,) [rad].
    """
    w, x, y, z = q.T
    return np.unwrap(np.arctan2(2 * (x * y + w * z), 1 - 2 * (y * y + z * z)))
