# SPDX-License-Identifier: MIT
"""Candidate poses a step beside an exposure, and their selection."""

from collections.abc import Callable, Iterable, Sequence

import numpy as np
from numpy.typing import ArrayLike
from scipy.optimize import minimize

from model.arrays import Array

REACH = 1.25
"""Largest distance between exposures that count as neighbours, in lengths of the robot [-]."""

LEAST_STEP = 0.25
"""Least distance between two exposures, in lengths of the robot; nearer poses count as one [-]."""

CLIMB = (0.01, 0.01, 0.1)
"""Size of the initial simplex in x, y and yaw of the local search for a pose [m, m, rad]."""

_TURNS = np.radians(np.arange(-30.0, 31.0, 7.5))
_SIDEWAYS = np.radians(40.0)  # largest direction of a step off the heading
_MOST_TRIED = 200  # of candidates, of which the best that are apart are selected


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
        x, y [m] and yaw [rad], turned by up to 30 degrees, shape (n, 3). The step is within 40
        degrees of the mean of both headings, or of its opposite.
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
    # The chord of an arc has the mean of the headings at its ends, whichever way it is walked.
    arc_yaw = 2 * np.arctan2(dy, dx) - nearest[2]
    turns = np.arange(4) * np.pi / 2 if square else np.array([0.0, np.pi])
    turn = turns[np.argmax(np.cos(pose[2] + turns - arc_yaw))]
    return np.array([pose[0], pose[1], pose[2] + turn])


def is_apart(pose: Array, others: Iterable[Array], distance: float) -> bool:
    """Return whether a pose is farther than a distance from all of several other poses.

    Args:
        pose: x, y [m] and yaw [rad], shape (3,).
        others: The other poses, shape (3,) each; True if there are none.
        distance: Distance in x, y to exceed [m].
    """
    return all(np.hypot(*(pose - other)[:2]) > distance for other in others)


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
