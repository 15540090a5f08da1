# SPDX-License-Identifier: MIT
"""Candidate poses of exposures: a step from another exposure, or where the last step leads."""

import numpy as np

from tracking.camera.lens import Array
from tracking.composite.chain import distances

REACH = 1.25
"""Largest distance between exposures that count as neighbours, in lengths of the robot [-]."""

LEAST_STEP = 0.25
"""Least distance between two exposures, in lengths of the robot; nearer ones are the same [-]."""

MOST_EXPOSURES = 24
"""Largest number of exposures in a picture whose exposures are judged as a set."""

CLIMB = (0.01, 0.01, 0.1)
"""Initial steps of the local search for a pose [m, m, rad]."""

_TURNS = np.radians(np.arange(-30.0, 31.0, 7.5))
_SIDEWAYS = np.radians(40.0)  # largest direction of a step off the heading
_NEARBY = 0.16  # of the length: largest change from one step to the next
_NEARBY_TURNS = np.radians([-8.0, 0.0, 8.0])
_NEAR, _NEAR_TURN = 0.3, np.radians(16.0)


def beside(pose: Array, length: float, *, spacing: float) -> Array:
    """Make a grid of candidate poses one step ahead of a pose and behind it.

    Args:
        pose: x, y [m] and yaw [rad], shape (3,).
        length: Length of the robot [m].
        spacing: Distance between candidates [m].

    Returns:
        Poses, shape (n, 3).
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
    """Make a grid of candidate poses around an expected one.

    Args:
        pose: Expected x, y [m] and yaw [rad], shape (3,).
        length: Length of the robot [m]; the grid spans a fixed share of it.

    Returns:
        Poses, shape (n, 3).
    """
    side = np.linspace(-_NEARBY, _NEARBY, 7) * length
    dx, dy = (part.ravel() for part in np.meshgrid(side, side))
    return np.concatenate([
        np.column_stack((pose[0] + dx, pose[1] + dy, np.full(dx.size, pose[2] + turn)))
        for turn in _NEARBY_TURNS
    ])  # fmt: skip


def headed(pose: Array, poses: Array, *, square: bool) -> Array:
    """Choose the heading of a pose so that an arc leads to it from the nearest exposure.

    The appearance of a symmetric robot does not determine its heading: it is found turned by a half
    (or a quarter, if it is square) about as often as not. The direction of the walk decides it, as
    in `tracking.body.heading`.

    Args:
        pose: x, y [m] and yaw [rad], shape (3,).
        poses: Exposures whose heading is known, shape (n, 3).
        square: Whether the robot is about as wide as long.

    Returns:
        The pose with its heading, or that turned by a half, or of a square robot a quarter.
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
        length: Length of the robot [m]; the tolerance of position is a share of it.
    """
    turned = abs(float(np.angle(np.exp(1j * (pose[2] - expected[2])))))
    return bool(distances(pose[None], expected)[0] < _NEAR * length and turned < _NEAR_TURN)


def apart(poses: Array, values: Array, distance: float, *, most: int) -> list[Array]:
    """Select the best of many poses that are apart from each other (non-maximum suppression).

    Args:
        poses: Shape (n, 3).
        values: How good they are, -inf where not at all, shape (n,).
        distance: How far apart [m].
        most: How many.

    Returns:
        The best first.
    """
    kept: list[Array] = []
    for k in np.argsort(-values)[:200]:
        if len(kept) == most or not np.isfinite(values[k]):
            break
        if not kept or distances(np.array(kept), poses[k]).min() > distance:
            kept.append(poses[k])
    return kept
