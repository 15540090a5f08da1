# SPDX-License-Identifier: MIT
"""Rotations and homogeneous transforms between the inertial, body, hip and contact frames.

Frames and signs are those of `docs/conventions.md`. Angles may be arrays; matrices then have the
angles' shape in front.
"""

import numpy as np
from numpy.typing import ArrayLike

from model.arrays import Array


def rotation_x(angle: ArrayLike) -> Array:
    """Return rotation matrices about x by angles [rad], R_r of Eq. (3-7), shape (..., 3, 3)."""
    c, s, one, zero = _entries(angle)
    return _matrix([[one, zero, zero], [zero, c, -s], [zero, s, c]])


def rotation_y(angle: ArrayLike) -> Array:
    """Return rotation matrices about y by angles [rad], R_p of Eq. (3-7), shape (..., 3, 3)."""
    c, s, one, zero = _entries(angle)
    return _matrix([[c, zero, s], [zero, one, zero], [-s, zero, c]])


def rotation_z(angle: ArrayLike) -> Array:
    """Return rotation matrices about z by angles [rad], R_y of Eq. (3-7), shape (..., 3, 3)."""
    c, s, one, zero = _entries(angle)
    return _matrix([[c, -s, zero], [s, c, zero], [zero, zero, one]])


def attitude(roll: ArrayLike, pitch: ArrayLike, yaw: ArrayLike) -> Array:
    """Return the rotation from body to inertial frame, Rz(yaw) Ry(pitch) Rx(roll), (..., 3, 3).

    Args:
        roll: Roll [rad].
        pitch: Pitch [rad].
        yaw: Yaw [rad].
    """
    return rotation_z(yaw) @ rotation_y(pitch) @ rotation_x(roll)


def thesis_attitude(roll: ArrayLike, pitch: ArrayLike, yaw: ArrayLike) -> Array:
    """Return the thesis's rotation from body to inertial frame, Rx(roll) Ry(pitch) Rz(yaw).

    Eq. (3-7), shape (..., 3, 3). Its roll turns the robot about an axis fixed to the ground: for a
    robot that heads along y it is a pitch. The angles agree with those of `attitude`, to first
    order, only for a robot that heads along x.

    Args:
        roll: Roll [rad].
        pitch: Pitch [rad].
        yaw: Yaw [rad].
    """
    return rotation_x(roll) @ rotation_y(pitch) @ rotation_z(yaw)


def roll_pitch_yaw(rotation: Array) -> Array:
    """Compute roll, pitch and yaw, as `attitude` takes them, from rotation matrices.

    Args:
        rotation: Rotation matrices from body to inertial frame, shape (..., 3, 3).

    Returns:
        Roll in [-pi, pi], pitch in [-pi/2, pi/2] and yaw in [-pi, pi], shape (..., 3) [rad]; with
        a pitch of pi/2 either way the rotation does not determine roll and yaw.
    """
    R = rotation
    return np.stack(
        [
            np.arctan2(R[..., 2, 1], R[..., 2, 2]),
            -np.arcsin(np.clip(R[..., 2, 0], -1.0, 1.0)),
            np.arctan2(R[..., 1, 0], R[..., 0, 0]),
        ],
        axis=-1,
    )


def transform(rotation: Array, position: ArrayLike) -> Array:
    """Return the homogeneous transform of a rotation and a position, Eq. (3-2).

    Args:
        rotation: Rotation matrix, shape (3, 3).
        position: Position, shape (3,) [m].

    Returns:
        Matrix with the rotation top left and the position in the last column, shape (4, 4).
    """
    H = np.eye(4)
    H[:3, :3], H[:3, 3] = rotation, position
    return H


def body_from_hip(theta: float, hip: ArrayLike) -> Array:
    """Return the homogeneous transform from hip to body frame, Eq. (3-11), shape (4, 4).

    A rotation by theta about y, then a shift to the hip.

    Args:
        theta: Leg angle [rad].
        hip: Position of the hip in the body frame, shape (3,) [m].
    """
    return transform(rotation_y(theta), hip)


def hip_from_contact(phi: float, contact: float, *, roll: float, radius: float) -> Array:
    """Return the homogeneous transform from contact to hip frame, Eq. (3-14), (3-16), (4, 4).

    A rotation Ry(phi - pi/2) Rx(-roll), then a shift to the leg's lowest point. The contact frame
    is level with roll and pitch of `thesis_attitude` without yaw; with those of `attitude`, only if
    one of the two is zero.

    Args:
        phi: Angle of the lowest point of the leg's full circle [rad].
        contact: Angle of the leg's own lowest point, `model.leg.contact_angle` [rad].
        roll: Roll, which the contact frame does not share [rad].
        radius: Radius of the leg's arc [m].
    """
    R = rotation_y(phi - np.pi / 2) @ rotation_x(-roll)
    return transform(R, [radius + radius * np.cos(contact), 0.0, -radius * np.sin(contact)])


def _entries(angle: ArrayLike) -> tuple[Array, Array, Array, Array]:
    """Return cosine and sine of angles [rad], and ones and zeros of the angles' shape."""
    a = np.asarray(angle, dtype=float)
    return np.cos(a), np.sin(a), np.ones_like(a), np.zeros_like(a)


def _matrix(rows: list[list[Array]]) -> Array:
    """Stack three rows of three arrays of one shape (...) to matrices of shape (..., 3, 3)."""
    return np.stack([np.stack(row, axis=-1) for row in rows], axis=-2)
