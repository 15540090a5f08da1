# SPDX-License-Identifier: MIT
"""Motion model of the smoother: a twist that is constant but for white noise, and the gait's sway.

For neighbours a and b, dt apart (Barfoot, State Estimation for Robotics, 2017, section 11.3):

    e = [ log(T_a^-1 T_b) - dt w_a ;  w_b - w_a ],   cov e = [ dt³/3 dt²/2 ; dt²/2 dt ] x Q_c

with T the pose, w the twist and Q_c the noise densities. States are x, y [m], yaw [rad], and
forward speed, speed to the left [m/s] and turning rate [rad/s]. The second line leaves out the
Jacobian of the logarithm, which differs from one by half the turn between two photographs; the
noise density absorbs the difference.

Added to the pose's part of cov e is the sway of a gait: within a step a legged robot moves to and
fro about its path, which noise of the twist cannot follow from one photograph to the next.
"""

from typing import NamedTuple

import numpy as np

from model.arrays import Array

SWAY_SD = np.array([0.8e-3, 0.3e-3, 2e-3])
"""Usual standard deviation of a gait's sway ahead, to the left [m] and of the heading [rad].

About a mean over 4 s, walks of a simulated rigid body on six legs (reference data, tripod gaits)
sway by 0.6 to 0.9 mm, 0.1 to 0.3 mm and 0.6 to 3 mrad."""
SWAY_TIME = 0.5
"""Time after which the sway is independent of what it was [s]."""
_LEAST_SD = 1e-6
"""Standard deviation added to each component of e [m, rad, m/s, rad/s]: far below any walk's, it
keeps links of photographs that are microseconds apart from being stiffer than numbers can hold."""


class Process(NamedTuple):
    """Noise of the process: densities of white noise on the twist's derivative, and the sway.

    Attributes:
        travel: Noise density of the forward and of the sideways speed [m²/s³].
        turn: Noise density of the turning rate [rad²/s³].
        sway: The gait's sway over `SWAY_SD` [-].
    """

    travel: float
    turn: float
    sway: float = 1.0


def link_weights(dt: Array, process: Process) -> tuple[Array, float]:
    """Compute the inverse covariance of the motion model's error e for every interval.

    Args:
        dt: Intervals, shape (n,), above 0 [s].
        process: Noise densities and sway.

    Returns:
        Inverses of cov e with the sway, shape (n, 6, 6), and the sum of the logarithms of their
        determinants.
    """
    q = np.array([process.travel, process.travel, process.turn])
    dt, least = dt[:, None], _LEAST_SD**2
    # Variance of the change of sway: that of the difference of two once they are independent.
    sway = 2 * (process.sway * SWAY_SD) ** 2 * np.minimum(dt / SWAY_TIME, 1.0) + least
    pose, both, twist = q * dt**3 / 3 + sway, q * dt**2 / 2, q * dt + least
    # pose·twist - both², written without differences, which would lose all digits at small dt
    determinant = q**2 * dt**4 / 12 + least * pose + sway * q * dt
    weights = np.zeros((len(dt), 6, 6))
    a, b = np.arange(3), np.arange(3, 6)
    weights[:, a, a], weights[:, b, b] = twist / determinant, pose / determinant
    weights[:, a, b] = weights[:, b, a] = -both / determinant
    return weights, -float(np.log(determinant).sum())


def log_between(a: Array, b: Array) -> Array:
    """Compute log(A^-1 B) of planar poses a, b: the constant twists that lead from a to b in 1 s.

    All of shape (n, 3): x, y, yaw, and forward, left, turn.
    """
    turn = b[:, 2] - a[:, 2]
    c, s = np.cos(a[:, 2]), np.sin(a[:, 2])
    dx, dy = b[:, 0] - a[:, 0], b[:, 1] - a[:, 1]
    forward, left = c * dx + s * dy, -s * dx + c * dy
    half = turn / 2
    # (turn/2) / tan(turn/2), whose limit for no turn is 1 - turn²/12.
    small = np.abs(half) < 1e-4
    cot = np.where(small, 1 - half**2 / 3, half / np.tan(np.where(small, 1.0, half)))
    return np.column_stack((cot * forward + half * left, cot * left - half * forward, turn))


def link_error(a: Array, b: Array, dt: Array) -> Array:
    """Compute e between states a and b, shape (n, 6) as they are, `dt` (n,) apart [s]."""
    travelled = log_between(a[:, :3], b[:, :3]) - dt[:, None] * a[:, 3:]
    return np.concatenate((travelled, b[:, 3:] - a[:, 3:]), axis=1)


def link_derivatives(a: Array, b: Array, dt: Array) -> tuple[Array, Array]:
    """Differentiate `link_error` by a and by b, shape (n, 6, 6) each.

    With f and l the displacement ahead and to the left, h half the turn and k = h / tan h, what is
    travelled is (k f + h l, k l - h f, 2 h).
    """
    h = (b[:, 2] - a[:, 2]) / 2
    c, s = np.cos(a[:, 2]), np.sin(a[:, 2])
    dx, dy = b[:, 0] - a[:, 0], b[:, 1] - a[:, 1]
    f, l = c * dx + s * dy, -s * dx + c * dy  # noqa: E741 as in the docstring
    small = np.abs(h) < 1e-4
    safe = np.where(small, 1.0, h)
    k = np.where(small, 1 - h**2 / 3, h / np.tan(safe))
    slope = np.where(small, -2 * h / 3, 1 / np.tan(safe) - h / np.sin(safe) ** 2)  # dk / dh
    by_turn = np.stack((slope * f + l, slope * l - f), axis=1) / 2
    by_a, by_b = np.zeros((len(a), 6, 6)), np.zeros((len(a), 6, 6))
    by_b[:, 0, 0], by_b[:, 0, 1] = k * c - h * s, k * s + h * c
    by_b[:, 1, 0], by_b[:, 1, 1] = -k * s - h * c, k * c - h * s
    by_b[:, :2, 2], by_b[:, 2, 2] = by_turn, 1.0
    by_a[:, :3, :3] = -by_b[:, :3, :3]
    by_a[:, 0, 2] += k * l - h * f
    by_a[:, 1, 2] += -k * f - h * l
    by_a[:, :3, 3:] = -dt[:, None, None] * np.eye(3)
    by_a[:, 3:, 3:], by_b[:, 3:, 3:] = -np.eye(3), np.eye(3)
    return by_a, by_b
