# SPDX-License-Identifier: MIT
"""The path of a walk, stretched and bent by what the model's forces do not explain."""

from typing import NamedTuple

import numpy as np

from model.arrays import Array
from model.walk.arrays import State
from model.walk.ground import Ground


class Bend(NamedTuple):
    """How a path is stretched and bent; see `bent_states`.

    Attributes:
        distance: Relative error of distance [-].
        curvature: Curvature added, positive to the left [rad/m].
    """

    distance: float = 0.0
    curvature: float = 0.0


STRAIGHT = Bend()


def bent_states(states: Array, *, distance: Array, curvature: Array) -> Array:
    r"""Stretch and bend paths: :math:`d s' = (1 + \epsilon) ds, \; d\psi' = d\psi + \kappa\, ds`.

    The first pose of each path stays where it is; s is the distance before stretching.

    Args:
        states: x, y and yaw of m paths at n times, shape (m, n, 3) [m, m, rad].
        distance: epsilon, relative error of distance of each path, shape (m,) [-].
        curvature: kappa, added to the curvature of each path, positive to the left, (m,) [rad/m].

    Returns:
        x, y and yaw of the bent paths, shape (m, n, 3) [m, m, rad].
    """
    step = np.diff(states[..., :2], axis=1)
    forward = step[..., 0] + 1j * step[..., 1]
    travelled = _from_zero(np.abs(forward))
    turned = curvature[:, None] * travelled
    middle = 0.5 * (turned[:, 1:] + turned[:, :-1])
    steps = (1 + distance[:, None]) * forward * np.exp(1j * middle)
    moved = np.stack([_from_zero(np.real(steps)), _from_zero(np.imag(steps))], axis=-1)
    return np.concatenate(
        [states[:, :1, :2] + moved, (states[..., 2] + turned)[..., None]], axis=-1
    )


def _from_zero(steps: Array) -> Array:
    """Return the cumulative sum along axis 1, starting at zero: (m, n - 1) becomes (m, n)."""
    return np.concatenate([np.zeros((len(steps), 1)), np.cumsum(steps, axis=1)], axis=1)


def bent_poses(pose: Array, bend: Bend, ground: Ground) -> tuple[Array, Array]:
    """Stretch and bend poses of a body about their first; it rises with the ground's plane.

    Args:
        pose: Position [m] and quaternion (w, x, y, z), shape (n, 7).
        bend: How the path is stretched and bent.
        ground: The ground, of which the slope of the plane counts.

    Returns:
        The moved poses, shape (n, 7), and by how much each was turned about the vertical, positive
        to the left, shape (n,) [rad].
    """
    states = np.column_stack([pose[:, :2], np.zeros(len(pose))])[None]
    distance, curvature = np.array([bend.distance]), np.array([bend.curvature])
    bent = bent_states(states, distance=distance, curvature=curvature)[0]
    moved, turned = pose.copy(), bent[:, 2]
    moved[:, :2] = bent[:, :2]
    away = bent[:, :2] - pose[:, :2]
    moved[:, 2] += ground.slope_x * away[:, 0] + ground.slope_y * away[:, 1]
    c, s = np.cos(0.5 * turned), np.sin(0.5 * turned)
    w, x, y, z = pose[:, 3:].T
    moved[:, 3:] = np.column_stack([c * w - s * z, c * x - s * y, c * y + s * x, c * z + s * w])
    return moved, turned


def turned_vectors(vectors: Array, yaw: Array | float) -> Array:
    """Turn vectors about the vertical.

    Args:
        vectors: World vectors whose first two components are x and y, shape (..., 2 or 3).
        yaw: Angle, positive to the left, that broadcasts against the vectors' shape (...) [rad].
    """
    c, s = np.cos(yaw), np.sin(yaw)
    x, y = vectors[..., 0], vectors[..., 1]
    return np.concatenate([
        np.stack([c * x - s * y, s * x + c * y], axis=-1), vectors[..., 2:]
    ], axis=-1)  # fmt: skip


def move_state(state: State, pose: Array, yaw: float) -> None:
    """Move a state to a pose that differs from its own by a turn about the vertical.

    Args:
        state: State of the body, overwritten; velocities are turned.
        pose: Position [m] and quaternion, shape (7,).
        yaw: The turn, positive to the left [rad].
    """
    state.p[:], state.q[:] = pose[:3], pose[3:]
    for vectors in (state.v, state.w):
        vectors[:] = turned_vectors(vectors, yaw)
