# SPDX-License-Identifier: MIT
"""Steps from one exposure to the next, and chains of steps.

A step is forward and left of the mean heading, and a turn: shape (3,) [m, m, rad]. Intervals of
photographs are regular and the speed of a robot changes slowly, so that a step is similar to the
one before it.
"""

from collections.abc import Callable, Sequence
from itertools import pairwise

import numpy as np
from scipy.optimize import minimize

from tracking.camera.lens import Array

_STEP_SD, _TURN_SD = 0.1, np.radians(4.0)


def step_between(before: Array, after: Array) -> Array:
    """Compute the step between two poses, in the frame of their mean heading.

    Args:
        before: x, y [m] and yaw [rad], shape (3,).
        after: The same after the step, shape (3,).

    Returns:
        Forward, left [m] and turn [rad], shape (3,).
    """
    turn = float(np.angle(np.exp(1j * (after[2] - before[2]))))
    c, s = np.cos(before[2] + turn / 2), np.sin(before[2] + turn / 2)
    dx, dy = after[:2] - before[:2]
    return np.array([c * dx + s * dy, -s * dx + c * dy, turn])


def stepped(pose: Array, step: Array) -> Array:
    """Compute the pose after a step; inverse of `step_between`.

    Args:
        pose: x, y [m] and yaw [rad], shape (3,).
        step: Forward, left [m] and turn [rad], shape (3,).
    """
    forward, left, turn = step
    c, s = np.cos(pose[2] + turn / 2), np.sin(pose[2] + turn / 2)
    return np.array(
        [pose[0] + c * forward - s * left, pose[1] + s * forward + c * left, pose[2] + turn]
    )


def stepped_back(pose: Array, step: Array) -> Array:
    """Compute the pose before a step.

    Args:
        pose: x, y [m] and yaw [rad] after the step, shape (3,).
        step: Forward, left [m] and turn [rad], shape (3,).
    """
    return stepped(pose, -step)


def continued(before: Array, after: Array) -> Array:
    """Extrapolate the pose after two others by the same step.

    Args:
        before: x, y [m] and yaw [rad], shape (3,).
        after: The next pose, shape (3,).
    """
    return stepped(after, step_between(before, after))


def steady_chain(anchor: Array, step: Array, more_turn: float, ahead: int, behind: int) -> Array:
    """Compute poses by repeating one step, whose turn may grow, forward and backward from a pose.

    Args:
        anchor: Pose of the one, shape (3,).
        step: The step after it, shape (3,).
        more_turn: By how much each step turns more than the one before [rad].
        ahead: How many poses along the step.
        behind: How many against it.

    Returns:
        The anchor, those ahead of it and those behind it, each away from it, shape (n, 3).
    """
    poses, here = [anchor], anchor
    for number in range(ahead):
        here = stepped(here, step + np.array([0.0, 0.0, number * more_turn]))
        poses.append(here)
    here = anchor
    for number in range(1, behind + 1):
        here = stepped_back(here, step - np.array([0.0, 0.0, number * more_turn]))
        poses.append(here)
    return np.array(poses)


def unsteadiness(poses: Array) -> float:
    """Compute the sum of squared changes from step to step, divided by their usual variance.

    Args:
        poses: In order, shape (n, 3).

    Returns:
        1 a step where steps change by a tenth of their length or by 4 degrees of turn.
    """
    steps = np.array([step_between(a, b) for a, b in pairwise(poses)])
    if len(steps) < 2:
        return 0.0
    usual = float(np.median(np.hypot(steps[:, 0], steps[:, 1])))
    changes = np.diff(steps, axis=0) / [_STEP_SD * usual, _STEP_SD * usual, _TURN_SD]
    return float((changes**2).sum())


def distances(poses: Array, pose: Array) -> Array:
    """Compute the Euclidean distances of poses from one, shape (n,) [m].

    Args:
        poses: x, y [m] and yaw [rad], shape (n, 3).
        pose: The other pose, shape (3,).
    """
    return np.hypot(*(np.asarray(poses)[:, :2] - pose[:2]).T)


def usual_step(poses: Array) -> float:
    """Compute the median distance of poses, shape (n, 3), from their nearest neighbour [m]."""
    if len(poses) < 2:
        return 0.0
    nearest = [distances(np.delete(poses, k, axis=0), pose).min() for k, pose in enumerate(poses)]
    return float(np.median(nearest))


def improved(
    value: Callable[[Array], float], start: Array, *, reach: Sequence[float], tries: int
) -> tuple[Array, float]:
    """Maximise a function by the simplex method (Nelder and Mead 1965); it need not be smooth.

    Args:
        value: What to raise, of an array like `start`.
        start: Where to begin, shape (n,).
        reach: First changes, shape (n,).
        tries: Most evaluations.

    Returns:
        The best place and its value.
    """
    scale = np.asarray(reach, dtype=float)
    corners = np.vstack((np.zeros(len(scale)), np.eye(len(scale))))
    found = minimize(
        lambda change: -value(start + change * scale),
        corners[0],
        method="Nelder-Mead",
        options={"maxfev": tries, "initial_simplex": corners},
    )
    return start + found.x * scale, -float(found.fun)
