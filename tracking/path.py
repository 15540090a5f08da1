# SPDX-License-Identifier: MIT
"""Path of a walk: observations of the pose in photographs, sorted by time and smoothed."""

from collections.abc import Sequence
from dataclasses import dataclass, replace

import numpy as np
from numpy.typing import NDArray

from model.arrays import Array
from model.joint_covariance import JointCovariance
from tracking.chain_fit import SharedInput
from tracking.constant_twist import Process
from tracking.errors import PathError
from tracking.pose import HELD, PLANAR, BodyPose, BodyPrior
from tracking.shared import (
    ANNOTATION,
    CAMERA,
    HEIGHT,
    TILT,
    SharedErrors,
    annotation_name,
    stand_name,
)
from tracking.smooth import SmoothPath, smooth

TRACK_COLUMNS = (
    "t_s", "t_sigma", "x_m", "y_m", "yaw_rad", "cov_xx", "cov_xy", "cov_xyaw", "cov_yy",
    "cov_yyaw", "cov_yawyaw", "z_m", "source", "score", "photo",
)  # fmt: skip
"""Columns of `track.csv`, in order; `_s` [s], `_m` [m], `_rad` [rad], `t_sigma` [s]; `cov_` of x,
y [m] and yaw [rad]."""


@dataclass(frozen=True)
class PoseObservation:
    """The robot's pose in one photograph, with covariance.

    Attributes:
        photo: Name of the photograph, or of the exposure in a composite one.
        t: Time [s].
        t_sd: Standard deviation of `t` [s].
        pose: Pose of the body, with its covariance and its derivatives by shared errors.
        score: Correlation of the photograph with the marker or template, 1 at best and of a pose
            that a person set [-].
        source: How the pose was found: "marker", "body" (template) or "hand" (set by a person; a
            pose of which only head and tail were exchanged keeps its source).
        stand: Number of the camera's stand in which the photograph was taken, from 0.
        annotated: Name of the annotated photograph whose template found the pose; "" for none.
    """

    photo: str
    t: float
    t_sd: float
    pose: BodyPose
    score: float
    source: str
    stand: int = 0
    annotated: str = ""

    @property
    def planar(self) -> Array:
        """x, y [m] and yaw [rad] of the body, shape (3,)."""
        return self.pose.planar

    @property
    def z(self) -> float:
        """Height of the body's origin over the floor [m]."""
        return float(self.pose.state[2])

    def by_error(self, shared: SharedErrors, prior: BodyPrior) -> Array:
        """Compute the derivative of the pose's six coordinates by shared errors, shape (6, q)."""
        by_cause = dict(self.pose.with_prior(prior))
        if CAMERA in by_cause:
            by_cause[stand_name(self.stand)] = by_cause.pop(CAMERA)
        if ANNOTATION in by_cause:
            by_cause[annotation_name(self.annotated)] = by_cause.pop(ANNOTATION)
        return shared.columns(by_cause, 6)


@dataclass(frozen=True)
class Track:
    """The smoothed path of a walk with its covariance, one sample for each photograph.

    Attributes:
        observations: The robot's observed poses, in order of time.
        smoothed: The path smoothed from `observations`, at their times.
        joint: Covariance of the smoothed poses with each other; its shared errors are `shared`.
        shared: Covariance of the shared errors that the photographs leave, by cause.
        stated: Covariance of the shared errors before the robot was looked at.
    """

    observations: tuple[PoseObservation, ...]
    smoothed: SmoothPath
    joint: JointCovariance
    shared: SharedErrors
    stated: SharedErrors

    @property
    def covariance(self) -> Array:
        """Covariance of each sample's x, y [m] and yaw [rad], shared errors included, (n, 3, 3)."""
        return self.joint.marginal

    def covariance_given(self, causes: Sequence[str]) -> Array:
        """Compute each sample's covariance if `causes`, keys of `shared.slots`, were known.

        Shape (n, 3, 3).
        """
        return replace(self.joint, errors=self.shared.given(causes)).marginal

    @property
    def t(self) -> Array:
        """Times of the observations, shape (n,) [s]."""
        return np.array([seen.t for seen in self.observations])

    @property
    def poses(self) -> Array:
        """Smoothed x, y [m] and yaw [rad], shape (n, 3)."""
        return self.smoothed.poses

    @property
    def residuals(self) -> Array:
        """Observed minus smoothed x, y [m] and yaw [rad], yaw in -pi to pi, shape (n, 3)."""
        difference = np.array([seen.planar for seen in self.observations]) - self.poses
        difference[:, 2] = np.angle(np.exp(1j * difference[:, 2]))
        return difference

    @property
    def gap_before(self) -> NDArray[np.bool_]:
        """Whether a gap in time interrupts the path just before each sample, shape (n,)."""
        return self.smoothed.gap_before

    @property
    def columns(self) -> dict[str, list[float] | list[str]]:
        """The table `track.csv`: for each name in `TRACK_COLUMNS` a list of n values.

        x, y, yaw and covariance are the smoothed ones, the other columns as observed.
        """
        x, y, yaw = self.poses.T.tolist()
        upper = [
            self.covariance[:, i, j].tolist() for i, j in zip(*np.triu_indices(3), strict=True)
        ]
        of = self.observations
        columns = (
            [seen.t for seen in of], [seen.t_sd for seen in of], x, y, yaw, *upper,
            [seen.z for seen in of], [seen.source for seen in of], [seen.score for seen in of],
            [seen.photo for seen in of],
        )  # fmt: skip
        return dict(zip(TRACK_COLUMNS, columns, strict=True))

    @property
    def tum(self) -> tuple[str, ...]:
        """Lines of a TUM file, smoothed poses: t x y z qx qy qz qw [s, m, -], roll and pitch 0."""
        rows = zip(self.observations, self.poses, strict=True)
        return tuple(
            f"{seen.t:.6f} {x:.6f} {y:.6f} {seen.z:.6f} 0 0 {np.sin(yaw / 2):.9f} "
            f"{np.cos(yaw / 2):.9f}"
            for seen, (x, y, yaw) in rows
        )


def assemble_track(
    observations: Sequence[PoseObservation],
    *,
    shared: SharedErrors,
    prior: BodyPrior,
    gap: float | None = None,
    process: Process | None = None,
    start: Process | None = None,
    average: bool = True,
    again: Sequence[PoseObservation] = (),
) -> Track:
    """Sort observations by time; estimate their path and the errors that they share.

    Args:
        observations: Poses of the robot, one for each photograph, in any order.
        shared: Covariance of the shared errors before the robot is looked at.
        prior: Prior of height and tilt with which the poses were fitted.
        gap: Interval longer than which the path is interrupted [s]; None for 3.5 times the median
            interval.
        process: Noise densities of the motion model; None to estimate them.
        start: Noise densities from which to start their estimate; None for a walking robot's.
        average: Whether estimated noise densities are means over the marginal likelihood; False
            takes the likeliest ones, in half the time.
        again: Further poses in photographs that have one among `observations`, found with another
            template. As height and tilt of the body are the same there, they tell only of the
            errors that the two poses do not share.

    Returns:
        The path, smoothed with `tracking.smooth.smooth`, with its joint covariance.

    Raises:
        PathError: When there is no observation or two photographs have the same time, and as
            `tracking.smooth.smooth` raises it.
    """
    if not observations:
        raise PathError("the robot is found in no photograph, or corrections delete all its poses")
    ordered = tuple(sorted(observations, key=lambda seen: seen.t))
    by_error = np.stack([seen.by_error(shared, prior) for seen in ordered])
    root = shared.root
    information, gradient = _from_heights(ordered, by_error @ root, root, shared, prior)
    first = {seen.photo: seen for seen in ordered}
    for other in again:
        if other.photo in first:
            more, slope = _from_difference(first[other.photo], other, shared, prior, root)
            information, gradient = information + more, gradient + slope
    path = smooth(
        [seen.t for seen in ordered],
        np.array([seen.planar for seen in ordered]),
        covariance=np.array([seen.pose.planar_covariance for seen in ordered]),
        time_sd=[seen.t_sd for seen in ordered],
        gap=gap,
        process=process,
        start=start,
        average=average,
        shared=SharedInput(by_error[:, PLANAR] @ root, information, gradient),
    )
    left = SharedErrors(root @ path.shared_covariance @ root.T, shared.slots)
    parts = (path.own, path.following, path.gain(by_error[:, PLANAR]), left.covariance)
    joint = JointCovariance(*(np.asarray(part, dtype=np.float64) for part in parts))
    return Track(ordered, path, joint, left, shared)


def _from_heights(
    observations: Sequence[PoseObservation], by_error: Array, root: Array, shared: SharedErrors,
    prior: BodyPrior,
) -> tuple[Array, Array]:  # fmt: skip
    """Compute what heights and tilts in the photographs tell of the shared errors u.

    With C the covariance of height and tilt after a photograph, Q that of their prior and e the
    estimate less the prior's mean, the photograph's own value differs from the prior's by v with
    G v = Q^-1 e, where G = Q^-1 (Q - C) Q^-1 is the inverse covariance of v (0 where a photograph
    tells nothing). v moves with the shared errors by G dv = Q^-1 (de - dm), m the prior's mean.

    Returns:
        Information on u, shape (r, r), and gradient of minus the log likelihood at u = 0, (r,).
    """
    of_mean = shared.columns(
        {HEIGHT: np.eye(3)[:, :1], TILT: np.eye(3)[:, 1:]}, 3
    ) @ root  # fmt: skip
    Q = prior.covariance
    held = np.linalg.inv(Q)
    information, gradient = np.zeros((root.shape[1],) * 2), np.zeros(root.shape[1])
    for seen, derivative in zip(observations, by_error, strict=True):
        C = seen.pose.covariance[np.ix_(HELD, HELD)]
        e = seen.pose.state[HELD] - [prior.height, 0.0, 0.0]
        spread = _inverse_where_known(held @ (Q - C) @ held, held)
        moved = held @ (derivative[HELD] - of_mean)
        information += moved.T @ spread @ moved
        gradient += moved.T @ spread @ held @ e
    return information, gradient


def _from_difference(
    one: PoseObservation, other: PoseObservation, shared: SharedErrors, prior: BodyPrior,
    root: Array,
) -> tuple[Array, Array]:  # fmt: skip
    """Compute what two poses found in one photograph tell of the shared errors u.

    The true pose is either plus its derivative times u plus noise, so that their difference is
    that of the derivatives times u, plus noise of the pixels alone.

    Returns:
        Information on u, shape (r, r), and gradient of minus the log likelihood at u = 0, (r,).
    """
    difference = other.planar - one.planar
    difference[2] = np.angle(np.exp(1j * difference[2]))
    by_error = (one.by_error(shared, prior) - other.by_error(shared, prior))[PLANAR] @ root
    noise = one.pose.by_pixels(prior) + other.pose.by_pixels(prior)
    weighed = by_error.T @ np.linalg.inv(noise)
    return weighed @ by_error, -weighed @ difference


def _inverse_where_known(G: Array, held: Array) -> Array:
    """Invert an information matrix; 0 in directions that hold under a millionth of `held`."""
    unit = np.sqrt(np.diag(held))
    values, vectors = np.linalg.eigh(G / np.outer(unit, unit))
    inverse = np.where(values > 1e-6, 1 / np.maximum(values, 1e-6), 0.0)
    return (vectors * inverse) @ vectors.T / np.outer(unit, unit)
