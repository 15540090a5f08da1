# SPDX-License-Identifier: MIT
"""Absolute and relative errors of a path against another, pose by pose, in plane or space."""

import math
from dataclasses import dataclass
from typing import NamedTuple, TypeAlias

import numpy as np
from numpy.typing import NDArray

from model.arrays import Array
from model.counted import counted
from model.errors import InsufficientData
from model.metrics.alignment import Similarity, umeyama
from model.rigid_path import RigidPath

Indices: TypeAlias = NDArray[np.intp]
CLOSE = 0.1  # share of a distance by which a pair of poses may miss it


class Spread(NamedTuple):
    """Summary of distances of poses.

    Attributes:
        rms: Root mean square [m].
        mean: Mean [m].
        median: Median [m].
        largest: Largest [m].
    """

    rms: float
    mean: float
    median: float
    largest: float


class MotionError(NamedTuple):
    """Relative pose error: error of the motion from one pose to another.

    Attributes:
        distance: Distance travelled between two poses [m]; None for consecutive poses.
        pairs: Number of pairs.
        position: Root mean square error of the displacement, in the first pose's frame [m]; NaN
            without pairs or rotations.
        angle: Root mean square angle of the error of the rotation [rad]; NaN likewise.
    """

    distance: float | None
    pairs: int
    position: float
    angle: float


@dataclass(frozen=True)
class RigidErrors:
    """Errors of an estimated path against a reference at the same times.

    Attributes:
        poses: Number of poses.
        length: Length of the reference [m].
        scale: Factor by which the estimate was multiplied before all else [-].
        ate: Absolute trajectory error: distances of the poses, unaligned.
        aligned: Distances after alignment over SE(d) (Umeyama).
        alignment: The alignment, whose scale is 1.
        rotation: Root mean square angle between the rotations, unaligned; NaN without them [rad].
        steps: Relative errors of consecutive poses.
        relative: Relative errors over distances.
    """

    poses: int
    length: float
    scale: float
    ate: Spread
    aligned: Spread
    alignment: Similarity
    rotation: float
    steps: MotionError
    relative: tuple[MotionError, ...]


def rigid_errors(
    estimate: RigidPath,
    reference: RigidPath,
    *,
    distances: tuple[float, ...] = (),
    correct_scale: bool = False,
) -> RigidErrors:
    """Compute absolute, aligned and relative errors of a path, in the plane or in space.

    Args:
        estimate: Estimated poses.
        reference: Reference poses at the same times, of the same dimension.
        distances: Distances of the relative errors [m].
        correct_scale: Whether the estimate is first multiplied by the scale that aligns it best, as
            a path of unknown scale needs. All errors are then those of the scaled path.

    Raises:
        InsufficientData: There are fewer than two poses.
    """
    if len(reference) < 2:
        raise InsufficientData(
            f"{counted(len(reference), 'pose')} to compare; expected two or more"
        )
    scale = 1.0
    if correct_scale:
        scale = umeyama(estimate.position, reference.position, with_scale=True).scale
        estimate = estimate.scaled(scale)
    alignment = umeyama(estimate.position, reference.position)
    travelled = reference.travelled
    n = len(reference)
    over = (pairs_by_distance(travelled, distance) for distance in distances)
    return RigidErrors(
        poses=n,
        length=float(travelled[-1]),
        scale=scale,
        ate=_spread(estimate.position - reference.position),
        aligned=_spread(alignment.apply(estimate.position) - reference.position),
        alignment=alignment,
        rotation=_rotation_error(estimate, reference),
        steps=_motion_error(estimate, reference, None, (np.arange(n - 1), np.arange(1, n))),
        relative=tuple(
            _motion_error(estimate, reference, distance, pairs)
            for distance, pairs in zip(distances, over, strict=True)
        ),
    )


def motion_errors(
    estimate: RigidPath, reference: RigidPath, start: Indices, end: Indices
) -> tuple[Array, Array]:
    r"""Compute the errors of the motions from some poses to others.

    The error is that of :math:`(T_i^{-1} T_j)^{-1} \hat T_i^{-1} \hat T_j`, T of the reference and
    :math:`\hat T` estimated.

    Args:
        estimate: Estimated poses with rotations.
        reference: Reference poses with rotations, at the same times.
        start: Indices i of the first pose of each pair, shape (pairs,).
        end: Indices j of the second pose, shape (pairs,).

    Returns:
        Length of the error's displacement [m] and angle of its rotation [rad], each (pairs,).
    """
    (shift, turn), (true_shift, true_turn) = (
        _motions(path, start, end) for path in (estimate, reference)
    )
    # A rotation of the frame does not change the length of the displacement.
    error = np.linalg.norm(shift - true_shift, axis=1)
    return error, rotation_angles(np.swapaxes(true_turn, 1, 2) @ turn)


def pairs_by_distance(travelled: Array, distance: float) -> tuple[Indices, Indices]:
    """Find for each pose the later pose whose distance travelled from there is nearest to a value.

    Args:
        travelled: Distance travelled up to each pose, shape (n,) [m].
        distance: Distance wanted [m]; pairs that miss it by more than a tenth are left out.

    Returns:
        Indices of the first and of the second pose of each pair, each of shape (pairs,), possibly
        empty. Of second poses that are equally near, the first.
    """
    n = len(travelled)
    beyond = np.minimum(np.searchsorted(travelled, travelled + distance), n - 1)
    before = np.searchsorted(travelled, travelled[np.maximum(beyond - 1, 0)])
    gaps = np.abs(travelled[[before, beyond]] - travelled - distance)
    end = np.where(gaps[0] <= gaps[1], before, beyond)
    kept = (gaps.min(axis=0) <= CLOSE * distance) & (end > np.arange(n))
    start = np.flatnonzero(kept)
    return start, end[start]


def round_distances(length: float) -> tuple[float, ...]:
    """Return three round distances for relative errors: the largest up to a quarter of a length.

    They are 1, 2 or 5 times a power of ten [m]; none without a length.

    >>> round_distances(9.0)
    (0.5, 1.0, 2.0)
    """
    if not length > 0:
        return ()
    power = math.floor(math.log10(length / 4))
    candidates = [
        float(f"{digit}e{exponent}")
        for exponent in range(power - 1, power + 1)
        for digit in (1, 2, 5)
    ]
    return tuple(each for each in candidates if each <= length / 4)[-3:]


def rotation_angles(rotation: Array) -> Array:
    """Compute the angles of rotations in the plane or in space.

    Args:
        rotation: Rotation matrices, shape (n, d, d).

    Returns:
        Angles in [0, pi], exact near both ends, shape (n,) [rad].
    """
    skew = rotation - np.swapaxes(rotation, 1, 2)
    sine = np.linalg.norm(skew, axis=(1, 2)) / math.sqrt(8)
    cosine = (np.trace(rotation, axis1=1, axis2=2) - rotation.shape[1] + 2) / 2
    return np.arctan2(sine, cosine)


def _motions(path: RigidPath, start: Indices, end: Indices) -> tuple[Array, Array]:
    """Return shift (pairs, d) and rotation (pairs, d, d) of each pair, in its first pose's frame.

    Raise `InsufficientData` if the path has no rotations.
    """
    rotation = path.rotation
    if rotation is None:
        raise InsufficientData("a path has no rotations; motions in the frame of a pose need them")
    back = np.swapaxes(rotation[start], 1, 2)
    shift = np.einsum("nij,nj->ni", back, path.position[end] - path.position[start])
    return shift, back @ rotation[end]


def _motion_error(
    estimate: RigidPath,
    reference: RigidPath,
    distance: float | None,
    pairs: tuple[Indices, Indices],
) -> MotionError:
    """Summarise the relative errors of pairs; NaN without pairs or rotations."""
    if estimate.rotation is None or reference.rotation is None or len(pairs[0]) == 0:
        return MotionError(distance, len(pairs[0]), math.nan, math.nan)
    error, angle = motion_errors(estimate, reference, *pairs)
    return MotionError(distance, len(pairs[0]), _rms(error), _rms(angle))


def _rotation_error(estimate: RigidPath, reference: RigidPath) -> float:
    """Compute the root mean square angle between rotations; NaN without rotations [rad]."""
    if estimate.rotation is None or reference.rotation is None:
        return math.nan
    return _rms(rotation_angles(np.swapaxes(reference.rotation, 1, 2) @ estimate.rotation))


def _spread(difference: Array) -> Spread:
    """Summarise the lengths of difference vectors, shape (n, d) [m]."""
    distance = np.linalg.norm(difference, axis=1)
    return Spread(
        _rms(distance), float(distance.mean()), float(np.median(distance)), float(distance.max())
    )


def _rms(values: Array) -> float:
    """Compute the root mean square of all elements."""
    return float(np.sqrt(np.mean(values**2)))
