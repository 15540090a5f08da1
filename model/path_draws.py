# SPDX-License-Identifier: MIT
"""Draws of a planar path: bend, anchor at a pose, interpolate, compute quantiles."""

from collections.abc import Sequence
from dataclasses import replace

import numpy as np

from model.arrays import Array
from model.errors import DomainError
from model.format_distinct import format_distinct
from model.poses import Poses, moved_onto
from model.walk.bend import Bend, bent_states
from model.walk.ground import FLAT, Ground
from model.walk.path import WalkPath

LEVELS = (0.025, 0.05, 0.25, 0.5, 0.75, 0.95, 0.975)
STATES = ("x", "y", "yaw")


def bent(paths: Poses, *, distance: Array, curvature: Array) -> Poses:
    r"""Stretch and bend paths: :math:`d s' = (1 + \epsilon) ds, \; d\psi' = d\psi + \kappa\, ds`.

    The first pose of each path stays where it is; s is the distance before stretching. The result
    has no covariance.

    Args:
        paths: Paths of m draws.
        distance: epsilon, relative error of distance of each path, shape (m,) [-].
        curvature: kappa, added to the curvature of each path, positive to the left, (m,) [rad/m].
    """
    states = bent_states(paths.states, distance=distance, curvature=curvature)
    return Poses.of_states(paths.t, states)


def bent_walk(path: WalkPath, bend: Bend, ground: Ground = FLAT) -> WalkPath:
    """Stretch and bend one walk as `bent` does; its body rises with the ground's plane.

    Args:
        path: The walk.
        bend: How the path is stretched and bent.
        ground: The ground, of which the slope of the plane counts.
    """
    one = path.poses.draws()
    moved = bent(one, distance=np.array([bend.distance]), curvature=np.array([bend.curvature]))
    away = moved.position[0] - path.position[:, :2]
    z = path.position[:, 2] + away @ [ground.slope_x, ground.slope_y]
    return replace(
        path,
        position=np.column_stack([moved.position[0], z]),
        orientation=np.column_stack([path.orientation[:, :2], moved.yaw[0]]),
    )


def middle_bend(single: Poses, band: Poses) -> Bend:
    """Return what stretches and bends a single path to the middle of its band.

    That is the path with the medians of the draws' length and turn. The most probable state of legs
    and floor is not the middle of their posterior: friction, the post-peak drop and the legs' arc
    make up for each other along a curve.

    Args:
        single: The single path, as one draw that covers the band's times.
        band: Paths of m draws.
    """
    travelled, turned = length_and_turn(band)
    same_times = Poses.of_states(band.t, states_at(single, band.t))
    own, own_turn = (float(each[0]) for each in length_and_turn(same_times))
    if own == 0:
        return Bend()
    return Bend(float(np.median(travelled)) / own - 1, (float(np.median(turned)) - own_turn) / own)


def length_and_turn(paths: Poses) -> tuple[Array, Array]:
    """Return length [m] and turn, positive to the left [rad], of each of m paths, (m,) each."""
    states = paths.states
    steps = np.diff(states[..., :2], axis=1)
    yaw = np.unwrap(states[..., 2], axis=1)
    return np.hypot(steps[..., 0], steps[..., 1]).sum(axis=1), yaw[:, -1] - yaw[:, 0]


def anchored(
    paths: Poses,
    pose: Array,
    *,
    at: float,
    covariance: Array | None = None,
    rng: np.random.Generator,
) -> Poses:
    """Move every path rigidly so that it passes a known pose, or a draw of an uncertain one.

    Args:
        paths: Draws of a path.
        pose: x, y [m] and yaw [rad] at the time `at`, shape (3,).
        at: Time of the pose, within the paths' times [s].
        covariance: Covariance of the pose, of which one is drawn for each path, shape (3, 3); None
            when the pose is exact.
        rng: Source of randomness of the drawn poses.

    Raises:
        DomainError: The time of the pose lies outside the paths' times, or the pose is not finite.
    """
    if not paths.t[0] <= at <= paths.t[-1]:
        known, start, end = format_distinct(at, paths.t[0], paths.t[-1])
        raise DomainError(f"the known pose is of {known} s, but paths run from {start} to {end} s")
    here = states_at(paths, np.array([at]))[:, 0]
    wanted = pose
    if covariance is not None:
        wanted = rng.multivariate_normal(pose, covariance, size=len(here), method="eigh")
    return Poses.of_states(paths.t, moved_onto(paths.states, here, wanted))


def states_at(paths: Poses, t: Array) -> Array:
    """Interpolate x, y and yaw of every draw linearly at given times.

    Args:
        paths: The draws, at two times or more.
        t: Times, shape (k,) [s]; outside the paths' times the end steps are extrapolated.

    Returns:
        States, shape (draws, k, 3) [m, m, rad].
    """
    values = paths.states
    after = np.clip(np.searchsorted(paths.t, t, side="right"), 1, len(paths.t) - 1)
    share = (t - paths.t[after - 1]) / (paths.t[after] - paths.t[after - 1])
    return values[:, after - 1] + share[:, None] * (values[:, after] - values[:, after - 1])


def quantiles(paths: Poses, levels: Sequence[float] = LEVELS) -> Array:
    """Compute quantiles over the draws of x, y and yaw at every time.

    Args:
        paths: The draws.
        levels: Levels of the quantiles, from 0 to 1 [-].

    Returns:
        Quantiles, shape (levels, n, 3) [m, m, rad].
    """
    return np.quantile(paths.states, np.asarray(levels), axis=0)
