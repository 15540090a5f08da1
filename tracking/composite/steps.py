# SPDX-License-Identifier: MIT
"""Steps from one exposure to the next, and chains of steps.

A step is forward and left of the mean heading, and a turn: shape (3,) [m, m, rad]. Intervals of
photographs are regular and the speed of a robot changes slowly, so that a step is similar to the
one before it.
"""

from collections.abc import Callable, Iterable, Sequence
from itertools import pairwise

import numpy as np
from numpy.typing import ArrayLike
from scipy.optimize import minimize

from model.arrays import Array
from tracking.composite.order import order_exposures

REACH = 1.25
"""Largest distance between exposures that count as neighbours, in lengths of the robot [-]."""

LEAST_STEP = 0.25
"""Least distance between two exposures, in lengths of the robot; nearer poses count as one [-]."""

MOST_EXPOSURES = 24
"""Largest number of exposures that are searched in a mean or a picture of darkest values."""

CLIMB = (0.01, 0.01, 0.1)
"""Size of the initial simplex in x, y and yaw of the local search for a pose [m, m, rad]."""

_TURN = np.radians(32.0)  # largest turn of a step
_TURNS = np.radians(np.arange(-30.0, 31.0, 7.5))
_SIDEWAYS = np.radians(40.0)  # largest direction of a step off the heading
_NEARBY = 0.16  # of the length: largest change from one step to the next
_NEARBY_TURNS = np.radians([-8.0, 0.0, 8.0])
_NEAR, _NEAR_TURN = 0.3, np.radians(16.0)
_MOST_TRIED = 200  # of candidates, of which the best that are apart are selected
_STEP_SD, _TURN_SD = 0.1, np.radians(4.0)


def step_between(before: Array, after: Array) -> Array:
    """Compute the step between two poses, in the frame of their mean heading.

    Args:
        before: x, y [m] and yaw [rad] before the step, shape (3,).
        after: x, y [m] and yaw [rad] after the step, shape (3,).

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


def continued(before: Array, after: Array) -> Array:
    """Extrapolate a third pose by repeating the step between two poses.

    Args:
        before: First pose: x, y [m] and yaw [rad], shape (3,).
        after: Second pose, shape (3,).
    """
    return stepped(after, step_between(before, after))


def steady_chain(anchor: Array, step: Array, more_turn: float, ahead: int, behind: int) -> Array:
    """Compute poses by repeating one step, whose turn may grow, forward and backward from a pose.

    Args:
        anchor: Pose to start from: x, y [m] and yaw [rad], shape (3,).
        step: Step from the anchor to the next pose, shape (3,).
        more_turn: Turn of each step minus turn of the step before it [rad].
        ahead: Number of poses after the anchor.
        behind: Number of poses before the anchor.

    Returns:
        The anchor, the poses after it, then the poses before it, the nearest first in both, shape
        (1 + ahead + behind, 3).
    """
    poses, more = [anchor], np.array([0.0, 0.0, more_turn])
    for sign, count in ((1, ahead), (-1, behind)):
        here = anchor
        for number in range(count):
            here = stepped(here, sign * (step + (number if sign > 0 else -number - 1) * more))
            poses.append(here)
    return np.array(poses)


def unsteadiness(poses: Array) -> float:
    """Compute the sum of squared changes from step to step, divided by their usual variance.

    Args:
        poses: x, y [m] and yaw [rad] in order of the walk, shape (n, 3).

    Returns:
        The sum [-]: 1 for each change by a tenth of the median step's length, or by 4 degrees of
        turn; 0 for fewer than three poses.
    """
    steps = np.array([step_between(a, b) for a, b in pairwise(poses)])
    if len(steps) < 2:
        return 0.0
    usual = float(np.median(np.hypot(steps[:, 0], steps[:, 1])))
    changes = np.diff(steps, axis=0) / [_STEP_SD * usual, _STEP_SD * usual, _TURN_SD]
    return float((changes**2).sum())


def distances(poses: Array, pose: Array) -> Array:
    """Compute the distances in x, y of several poses from one pose, shape (n,) [m].

    Args:
        poses: x, y [m] and yaw [rad], shape (n, 3).
        pose: The pose from which distances are measured, shape (3,).
    """
    return np.hypot(*(np.asarray(poses)[:, :2] - pose[:2]).T)


def usual_step(poses: Array) -> float:
    """Compute the median distance of poses (n, 3) from their nearest neighbour [m]; 0 of one."""
    if len(poses) < 2:
        return 0.0
    nearest = [distances(np.delete(poses, k, axis=0), pose).min() for k, pose in enumerate(poses)]
    return float(np.median(nearest))


def shifted_sets(poses: Array) -> list[Array]:
    """List sets of exposures with one more or one fewer at either or both ends of the walk.

    Args:
        poses: x, y [m] and yaw [rad] of at least two exposures, shape (n, 3).

    Returns:
        Sets other than `poses` itself that keep its first pose, in first place, shape (m, 3) each.
    """
    chain = [poses[k] for k in order_exposures(poses)]
    before, after = continued(chain[1], chain[0]), continued(chain[-2], chain[-1])
    starts: Sequence[list[Array]] = (chain, chain[1:], [before, *chain])
    sets = []
    for start in starts:
        for end in (start, start[:-1], [*start, after]):
            rest = [pose for pose in end if not np.array_equal(pose, poses[0])]
            kept = len(rest) < len(end)
            if kept and rest and end is not chain:
                sets.append(np.array([poses[0], *rest]))
    return sets


def improved(
    value: Callable[[Array], float], start: Array, *, reach: Sequence[float], tries: int
) -> tuple[Array, float]:
    """Maximise a function by the simplex method (Nelder and Mead 1965); it need not be smooth.

    Args:
        value: Function to maximise, of an array of shape (n,).
        start: Argument to start from, shape (n,).
        reach: Size of the initial simplex along each argument, shape (n,).
        tries: Largest number of evaluations.

    Returns:
        The best argument found, shape (n,), and its value.
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


def beside(pose: Array, length: float, *, spacing: float) -> Array:
    """Compute a grid of candidate poses one step ahead of and behind a pose.

    Args:
        pose: x, y [m] and yaw [rad], shape (3,).
        length: Length of the robot; steps are `LEAST_STEP` to `REACH` of it [m].
        spacing: Distance between candidates in x and in y [m].

    Returns:
        x, y [m] and yaw [rad], turned by up to 30 degrees, shape (n, 3).
    """
    side = np.arange(-REACH * length, REACH * length + 1e-9, spacing)
    dx, dy = (part.ravel() for part in np.meshgrid(side, side))
    distance, direction = np.hypot(dx, dy), np.arctan2(dy, dx)
    places = []
    for turn in _TURNS:
        along = np.abs(np.cos(direction - pose[2] - turn / 2)) > np.cos(_SIDEWAYS)
        ok = along & (distance > LEAST_STEP * length) & (distance < REACH * length)
        yaw = np.full(ok.sum(), pose[2] + turn)
        places.append(np.column_stack((pose[0] + dx[ok], pose[1] + dy[ok], yaw)))
    return np.concatenate(places)


def nearby(pose: Array, length: float) -> Array:
    """Compute a grid of candidate poses around an expected pose.

    Args:
        pose: Expected x, y [m] and yaw [rad], shape (3,).
        length: Length whose 0.16-fold the grid reaches in x and y, as the robot's length [m].

    Returns:
        x, y [m] and yaw [rad], turned by -8, 0 and 8 degrees, shape (147, 3).
    """
    side = np.linspace(-_NEARBY, _NEARBY, 7) * length
    dx, dy = (part.ravel() for part in np.meshgrid(side, side))
    return np.concatenate([
        np.column_stack((pose[0] + dx, pose[1] + dy, np.full(dx.size, pose[2] + turn)))
        for turn in _NEARBY_TURNS
    ])  # fmt: skip


def headed(pose: Array, poses: Array, *, square: bool) -> Array:
    """Turn a pose by a half or quarter to the heading of an arc from the nearest exposure.

    The appearance of a symmetric robot does not determine its heading: it is found turned by a half
    (or a quarter, if it is square) about as often as not. The direction of the walk decides it, as
    in `tracking.body.heading`.

    Args:
        pose: x, y [m] and yaw [rad], shape (3,).
        poses: Exposures whose heading is known, shape (n, 3).
        square: Whether the robot is about as wide as long.

    Returns:
        The pose turned by 0 or pi, or of a square robot by 0, pi/2, pi or 3 pi/2, shape (3,).
    """
    nearest = poses[int(np.argmin(distances(poses, pose)))]
    dx, dy = pose[:2] - nearest[:2]
    arc_yaw = 2 * np.arctan2(dy, dx) - nearest[2]
    turns = np.arange(4) * np.pi / 2 if square else np.array([0.0, np.pi])
    turn = turns[np.argmax(np.cos(pose[2] + turns - arc_yaw))]
    return np.array([pose[0], pose[1], pose[2] + turn])


def are_apart(poses: Array, length: float) -> bool:
    """Return whether all exposures are at least `LEAST_STEP` lengths of the robot apart.

    Args:
        poses: x, y [m] and yaw [rad], shape (n, 3).
        length: Length of the robot [m].
    """
    return all(
        distances(poses[k + 1 :], pose).min() >= LEAST_STEP * length
        for k, pose in enumerate(poses[:-1])
    )


def is_near(pose: Array, expected: Array, length: float) -> bool:
    """Return whether position and heading of a pose are close to those expected.

    Args:
        pose: x, y [m] and yaw [rad], shape (3,).
        expected: Expected pose, shape (3,).
        length: Length whose 0.3-fold is the tolerance of position [m]; that of heading is 16
            degrees.
    """
    turned = abs(float(np.angle(np.exp(1j * (pose[2] - expected[2])))))
    return bool(distances(pose[None], expected)[0] < _NEAR * length and turned < _NEAR_TURN)


def is_apart(pose: Array, others: Iterable[Array], distance: float) -> bool:
    """Return whether a pose is farther than a distance from all of several other poses.

    Args:
        pose: x, y [m] and yaw [rad], shape (3,).
        others: The other poses, shape (3,) each; True if there are none.
        distance: Distance in x, y to exceed [m].
    """
    return all(np.hypot(*(pose - other)[:2]) > distance for other in others)


def is_beside(pose: Array, poses: Sequence[Array], length: float) -> bool:
    """Return whether a pose is within `REACH` lengths and 32 degrees of heading of some other.

    Args:
        pose: x, y [m] and yaw [rad], shape (3,).
        poses: The other poses, shape (3,) each.
        length: Length of the robot [m].
    """
    return any(
        np.hypot(*(pose - other)[:2]) < REACH * length
        and np.cos(pose[2] - other[2]) > np.cos(_TURN)
        for other in poses
    )


def apart(
    poses: Sequence[Array] | Array, values: ArrayLike, distance: float, *, most: int | None = None
) -> list[Array]:
    """Select the best of many poses that are apart from each other (non-maximum suppression).

    Args:
        poses: x, y [m] and yaw [rad], shape (n, 3).
        values: Scores of the poses, greater is better, -inf to exclude a pose, shape (n,).
        distance: Distance in x, y that selected poses must exceed from each other [m].
        most: Largest number of poses, selected from the 200 best; None for no limit.

    Returns:
        The selected poses, best first.
    """
    kept: list[Array] = []
    scores = np.asarray(values)
    best = np.argsort(-scores)
    for k in best if most is None else best[:_MOST_TRIED]:
        if len(kept) == most or not np.isfinite(scores[k]):
            break
        if is_apart(poses[k], kept, distance):
            kept.append(poses[k])
    return kept
