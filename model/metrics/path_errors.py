# SPDX-License-Identifier: MIT
"""Errors of a predicted path against a tracked one, pose by pose and in summary."""

from dataclasses import dataclass

import numpy as np

from model.arrays import Array
from model.metrics.alignment import align
from model.metrics.rigid_errors import motion_errors, pairs_by_distance
from model.metrics.turning import fitted_radius, mean_yaw_rate
from model.poses import Poses, overlap, wrap
from model.rigid_path import RigidPath
from model.travel import path_length, travel_chord, travel_direction, travelled

DISTANCES = (0.25, 0.5, 1.0)  # distances travelled over which relative errors are computed [m]


@dataclass(frozen=True)
class PoseErrors:
    """Errors pose by pose: predicted minus tracked.

    Attributes:
        t: Times, those of the track, shape (n,) [s].
        translation: Errors along the floor's axes, shape (n, 2) [m].
        rotation: Errors of heading in [-pi, pi); NaN where either pose has none, shape (n,) [rad].
        along: Errors in the track's direction of travel, positive ahead, shape (n,) [m].
        cross: Errors across the track's direction of travel, positive to the left, shape (n,) [m].
    """

    t: Array
    translation: Array
    rotation: Array
    along: Array
    cross: Array

    @property
    def distance(self) -> Array:
        """Distances between predicted and tracked positions, shape (n,) [m]."""
        return np.linalg.norm(self.translation, axis=1)


@dataclass(frozen=True)
class RelativeError:
    """Relative pose error: error of the motion over a distance, independent of earlier errors.

    Attributes:
        distance: Distance travelled between the two poses of a pair [m].
        pairs: Number of pairs of poses that are this distance apart, to a tenth of it.
        position: Root mean square error of the displacement from the first pose of a pair, in its
            frame, to the second [m]; NaN without pairs or if a heading is missing.
        yaw: Root mean square error of the turn between them [rad]; NaN likewise.
    """

    distance: float
    pairs: int
    position: float
    yaw: float


@dataclass(frozen=True)
class PathErrors:
    """Summary errors of a predicted path against a tracked one, at the track's times.

    Attributes:
        poses: Number of poses compared.
        length: Length of the track from the first to the last of these poses, without its noise
            (`model.travel`) [m].
        length_ratio: Predicted over tracked length, both by the track's chord; NaN if the track has
            no length [-].
        ate: Absolute trajectory error: root mean square distance, unaligned [m].
        x: Root mean square error of x [m].
        y: Root mean square error of y [m].
        along: Root mean square error along the track [m].
        cross: Root mean square error across the track [m].
        yaw: Root mean square error of heading; NaN if a heading is missing [rad].
        largest: Largest distance of a predicted from a tracked position [m].
        final_distance: Distance of the last predicted from the last tracked position [m].
        final_yaw: Last predicted minus last tracked heading, in [-pi, pi), or NaN [rad].
        ate_aligned: Root mean square distance after alignment over SE(2) [m].
        alignment_yaw: Angle by which alignment rotated the predicted path, positive left [rad].
        alignment_shift: Distance by which alignment moved the first predicted pose [m].
        relative: Relative pose errors, one for each of `DISTANCES`.
        radius: Turning radius of the predicted and of the tracked path, positive to the left;
            as by `fitted_radius` infinite if headings span less than 5 degrees, NaN if the path is
            no circle, a heading is missing or for fewer than four poses [m].
        yaw_rate: Mean yaw rate of the predicted and of the tracked path, positive to the left; NaN
            if a heading is missing [rad/s].
    """

    poses: int
    length: float
    length_ratio: float
    ate: float
    x: float
    y: float
    along: float
    cross: float
    yaw: float
    largest: float
    final_distance: float
    final_yaw: float
    ate_aligned: float
    alignment_yaw: float
    alignment_shift: float
    relative: tuple[RelativeError, ...]
    radius: tuple[float, float]
    yaw_rate: tuple[float, float]

    @property
    def ate_of_length(self) -> float:
        """Unaligned error `ate` over the length of the track; NaN if the length is zero [-]."""
        return self.ate / self.length if self.length > 0 else float("nan")


def pose_errors(predicted: Poses, tracked: Poses) -> PoseErrors:
    """Compute predicted minus tracked poses at the same times, without alignment.

    Args:
        predicted: Predicted poses at the track's times.
        tracked: Tracked poses.
    """
    xy = predicted.position - tracked.position
    direction = travel_direction(tracked)
    c, s = np.cos(direction), np.sin(direction)
    return PoseErrors(
        t=tracked.t,
        translation=xy,
        rotation=wrap(predicted.yaw - tracked.yaw),
        along=c * xy[:, 0] + s * xy[:, 1],
        cross=c * xy[:, 1] - s * xy[:, 0],
    )


def path_errors(predicted: Poses, tracked: Poses) -> PathErrors:
    """Compute summary errors of a predicted path against a tracked one.

    The predicted path, sampled densely, is interpolated at the track's times; tracked poses
    outside the predicted path's times are left out.

    Args:
        predicted: Predicted path.
        tracked: Track, at any times of the same clock.

    Raises:
        InsufficientData: Fewer than two tracked poses lie within the predicted path's times.
    """
    tracked = tracked.part(overlap(tracked, predicted))
    predicted = predicted.at(tracked.t)
    errors = pose_errors(predicted, tracked)
    motion = align(predicted, tracked)
    moved = predicted.moved(rotation=motion.rotation, translation=motion.translation)
    chord = travel_chord(tracked)
    length = path_length(tracked, chord=chord)
    return PathErrors(
        poses=len(tracked),
        length=length,
        length_ratio=path_length(predicted, chord=chord) / length if length > 0 else float("nan"),
        ate=_rms(errors.distance),
        x=_rms(errors.translation[:, 0]),
        y=_rms(errors.translation[:, 1]),
        along=_rms(errors.along),
        cross=_rms(errors.cross),
        yaw=_rms(errors.rotation),
        largest=float(errors.distance.max()),
        final_distance=float(errors.distance[-1]),
        final_yaw=float(errors.rotation[-1]),
        ate_aligned=_rms(pose_errors(moved, tracked).distance),
        alignment_yaw=motion.rotation,
        alignment_shift=float(np.linalg.norm(moved.position[0] - predicted.position[0])),
        relative=tuple(relative_error(predicted, tracked, distance=d) for d in DISTANCES),
        radius=(fitted_radius(predicted), fitted_radius(tracked)),
        yaw_rate=(mean_yaw_rate(predicted), mean_yaw_rate(tracked)),
    )


def relative_error(predicted: Poses, tracked: Poses, *, distance: float) -> RelativeError:
    r"""Compute the relative pose error over a distance, starting at every pose in turn.

    For poses i and j of the track about that distance apart along it (see `pairs_by_distance`), the
    error is that of :math:`(T_i^{-1} T_j)^{-1} \hat T_i^{-1} \hat T_j`, T tracked and
    :math:`\hat T` predicted. NaN without such pairs, or if any heading is missing.

    Args:
        predicted: Predicted poses at the track's times.
        tracked: Tracked poses.
        distance: Distance [m]; pairs may miss it by a tenth.
    """
    start, end = pairs_by_distance(travelled(tracked), distance)
    if len(start) == 0 or not (predicted.has_yaw and tracked.has_yaw):
        return RelativeError(distance, len(start), float("nan"), float("nan"))
    estimate, reference = RigidPath.of_poses(predicted), RigidPath.of_poses(tracked)
    error, turn = motion_errors(estimate, reference, start, end)
    return RelativeError(distance, len(start), _rms(error), _rms(turn))


def _rms(values: Array) -> float:
    """Compute the root mean square of all elements."""
    return float(np.sqrt(np.mean(values**2)))
