# SPDX-License-Identifier: MIT
"""The path of a walk, stretched and bent by what the model's forces do not explain."""

from typing import NamedTuple

import numpy as np

from model.arrays import Array


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
