# SPDX-License-Identifier: MIT
"""Pose of the robot from points of it in one photograph, by nonlinear least squares.

All six degrees of freedom are fitted, with a prior on those that a single camera determines badly.
From 3 m away a marker of 0.12 m gives its distance to centimetres and its tilt to degrees. A prior
on height, roll and pitch therefore enters from the robot's dimensions. Minimised is

    r' C^-1 r + ((z - z_body) / sd_z)² + (roll / sd_tilt)² + (pitch / sd_tilt)²

with r the points' pixels minus their projection, C the covariance of the pixels, z_body and sd_z
the prior's height and its standard deviation about the mean of the walk, sd_tilt that of roll and
pitch. x, y and yaw carry no prior; their covariance includes the uncertainty of height and tilt.

What photographs have in common (camera, lens, side of the marker) is taken as exact here. With the
pose comes its derivative by each of these, from which `tracking.path` computes the whole
covariance.
"""

from collections.abc import Mapping
from dataclasses import dataclass, field

import numpy as np
from numpy.typing import ArrayLike
from scipy.optimize import least_squares

from model.arrays import Array
from tracking.camera.lens import Camera, CameraPose, project, project_with_derivatives, to_floor
from tracking.errors import BodyError
from tracking.shared import CAMERA, HEIGHT, LENS, TILT


@dataclass(frozen=True)
class BodyPrior:
    """Prior on the body's height and tilt: of their means over a walk, and about these means.

    Raises BodyError where a standard deviation in a photograph is not above 0, or one of a mean is
    below 0.

    Attributes:
        height: Height of the body's origin over the floor, mean of a walk [m].
        height_sd: Standard deviation of the height about its mean, in a photograph [m].
        tilt_sd: Standard deviation of roll and of pitch about their means, in a photograph [rad].
        mean_height_sd: Standard deviation of `height` [m].
        mean_tilt_sd: Standard deviation of mean roll and of mean pitch, about 0 [rad].
    """

    height: float
    height_sd: float = 3e-3
    tilt_sd: float = 0.02
    mean_height_sd: float = 0.0
    mean_tilt_sd: float = 0.0

    def __post_init__(self) -> None:
        """Check the standard deviations."""
        for what, sd, unit in (("height", self.height_sd, "m"), ("tilt", self.tilt_sd, "rad")):
            if not sd > 0:
                raise BodyError(
                    f"the standard deviation of the body's {what} in a photograph is {sd:g} {unit};"
                    " expected more than 0"
                )
        for what, sd in (("height", self.mean_height_sd), ("tilt", self.mean_tilt_sd)):
            if not sd >= 0:
                raise BodyError(
                    f"the standard deviation of the body's mean {what} is {sd:g}; expected 0 or"
                    " more"
                )

    @property
    def covariance(self) -> Array:
        """Covariance of height, roll and pitch in a photograph about their means, shape (3, 3)."""
        return np.diag(np.square([self.height_sd, self.tilt_sd, self.tilt_sd]))

    @property
    def spreads(self) -> dict[str, Array]:
        """Covariance of the means of a walk by cause: height (1, 1), roll and pitch (2, 2)."""
        tilt = self.mean_tilt_sd**2 * np.eye(2)
        return {HEIGHT: np.array([[self.mean_height_sd**2]]), TILT: tilt}


PLANAR = [0, 1, 5]
"""Indices of x, y and yaw in `BodyPose.state`."""

HELD = [2, 3, 4]
"""Indices of z, roll and pitch in `BodyPose.state`, which have a prior."""


@dataclass(frozen=True)
class BodyPose:
    """Pose of the robot in one photograph.

    Attributes:
        state: x, y, z [m], roll, pitch, yaw [rad] of the body in the floor frame, shape (6,);
            R = Rz(yaw) Ry(pitch) Rx(roll).
        covariance: Covariance of `state` from errors of pixels, and of height and tilt about their
            means, all independent from photograph to photograph, shape (6, 6).
        by_cause: By cause of shared errors (`tracking.shared`), the derivative of `state` by the
            value that was used, shape (6, k); causes that do not matter are left out.
        log_evidence: Log marginal likelihood of the pixels over height and tilt at the best x, y
            and yaw, up to a constant; it compares assumptions on the pixels' errors [-].
    """

    state: Array
    covariance: Array
    by_cause: Mapping[str, Array] = field(default_factory=dict)
    log_evidence: float = 0.0

    @property
    def planar(self) -> Array:
        """x, y [m] and yaw [rad] of the body in the floor frame, shape (3,)."""
        return self.state[PLANAR]

    @property
    def planar_covariance(self) -> Array:
        """Covariance of x, y and yaw without shared errors, shape (3, 3)."""
        return self.covariance[np.ix_(PLANAR, PLANAR)]

    def by_pixels(self, prior: BodyPrior) -> Array:
        """Compute the covariance of x, y and yaw by errors of the pixels alone, shape (3, 3).

        With C the whole covariance and Q that of the prior, it is C - C Q^-1 C.

        Args:
            prior: Prior of height and tilt with which the pose was fitted.
        """
        known = self.covariance[:, HELD] @ np.linalg.inv(prior.covariance)
        by_pixels = self.covariance - known @ self.covariance[HELD]
        return by_pixels[np.ix_(PLANAR, PLANAR)]

    def with_prior(self, prior: BodyPrior) -> Mapping[str, Array]:
        """Return `by_cause` with the mean height and tilt of the prior that was used in the fit.

        With C the covariance of the estimate, that is C times the sum of information times value
        over all that is known. The prior's information is P^-1, so that the estimate moves with the
        prior's means by C P^-1. What `by_cause` already has of these means, as through a template,
        is added.
        """
        by_mean = self.covariance[:, HELD] @ np.linalg.inv(prior.covariance)
        by_cause = dict(self.by_cause)
        for cause, moved in ((HEIGHT, by_mean[:, :1]), (TILT, by_mean[:, 1:])):
            by_cause[cause] = moved + by_cause.get(cause, np.zeros_like(moved))
        return by_cause


def rotation_with_derivatives(roll: float, pitch: float, yaw: float) -> tuple[Array, Array]:
    """Compute R = Rz(yaw) Ry(pitch) Rx(roll), body to world, and its derivatives.

    Args:
        roll: Positive with the left side up [rad].
        pitch: Positive with the nose down [rad].
        yaw: Positive to the left [rad].

    Returns:
        R, shape (3, 3) [-], and its derivatives with respect to roll, pitch and yaw, stacked along
        the first axis, shape (3, 3, 3) [1/rad].
    """
    cr, sr, cp, sp = np.cos(roll), np.sin(roll), np.cos(pitch), np.sin(pitch)
    cy, sy = np.cos(yaw), np.sin(yaw)
    Rx, dRx = np.array([[1, 0, 0], [0, cr, -sr], [0, sr, cr]]), np.zeros((3, 3))
    dRx[1:, 1:] = [[-sr, -cr], [cr, -sr]]
    Ry = np.array([[cp, 0, sp], [0, 1, 0], [-sp, 0, cp]])
    dRy = np.array([[-sp, 0, cp], [0, 0, 0], [-cp, 0, -sp]])
    Rz = np.array([[cy, -sy, 0], [sy, cy, 0], [0, 0, 1]])
    dRz = np.array([[-sy, -cy, 0], [cy, -sy, 0], [0, 0, 0]])
    return Rz @ Ry @ Rx, np.stack((Rz @ Ry @ dRx, Rz @ dRy @ Rx, dRz @ Ry @ Rx))


def body_to_floor(points_body: Array, state: Array) -> Array:
    """Transform points of the body to the floor frame.

    Args:
        points_body: Points in the body frame, shape (n, 3) [m].
        state: x, y, z [m], roll, pitch, yaw [rad] of the body in the floor frame, shape (6,).

    Returns:
        Shape (n, 3) [m].
    """
    R, _ = rotation_with_derivatives(*state[3:])
    return points_body @ R.T + state[:3]


def fit_pose(
    camera: Camera,
    view: CameraPose,
    *,
    points_body: ArrayLike,
    corners_px: ArrayLike,
    covariance: ArrayLike,
    prior: BodyPrior,
    points_by: Mapping[str, Array] | None = None,
    pixels_by: Mapping[str, Array] | None = None,
) -> BodyPose:
    """Fit the robot's pose to points on the robot by least squares, with prior of height and tilt.

    Args:
        camera: Camera intrinsics and distortion.
        view: The camera's pose.
        points_body: Points in the body frame, shape (n, 3), n at least 2 [m].
        corners_px: The same points in the picture, shape (n, 2) [px].
        covariance: Covariance of `corners_px.ravel()`, shape (2n, 2n) [px²].
        prior: Prior of the body's height and tilt.
        points_by: By cause of shared errors, derivative of `points_body`, shape (n, 3, k).
        pixels_by: By cause of shared errors, how it moves the points in the picture besides
            their projection, shape (n, 2, k).

    Returns:
        The pose of least cost with its covariance and its derivatives by the camera, the lens and
        the causes given, yaw in -pi to pi.

    Raises:
        ValueError: When a point's ray does not meet the plane of the points' expected mean height.
        LinAlgError: When `covariance` is not positive definite.
    """
    pixels = np.asarray(corners_px, dtype=float)
    whiten = np.linalg.inv(np.linalg.cholesky(np.asarray(covariance, dtype=float)))
    body = np.asarray(points_body, dtype=float)
    problem = _PoseProblem(camera, view, body, pixels, prior, whiten)
    fit = least_squares(
        problem.residual,
        problem.start(),
        jac=problem.jacobian,  # pyright: ignore[reportArgumentType] # scipy has no types
        x_scale="jac",
    )
    J = problem.jacobian(fit.x)
    spread = np.linalg.inv(J.T @ J)
    by_cause = {
        # The estimate follows: d state = -(J'J)^-1 J' (d residual / d cause) d cause.
        cause: -spread @ J.T @ derivative
        for cause, derivative in problem.by_cause(fit.x, points_by or {}, pixels_by or {}).items()
    }
    # Laplace's approximation over height, roll and pitch: their covariance given x, y and yaw has
    # the determinant of the whole covariance over that of x, y and yaw.
    log_dets = (
        -2 * float(np.log(np.diag(whiten)).sum())
        - float(np.linalg.slogdet(spread)[1])
        + float(np.linalg.slogdet(spread[np.ix_(PLANAR, PLANAR)])[1])
    )
    return BodyPose(_wrapped(fit.x), spread, by_cause, -float(fit.cost) - 0.5 * log_dets)


def _wrapped(state: Array) -> Array:
    """Return a state with its yaw wrapped to -pi to pi."""
    wrapped = state.copy()
    wrapped[5] = np.arctan2(np.sin(state[5]), np.cos(state[5]))
    return wrapped


@dataclass(frozen=True)
class _PoseProblem:
    """Least-squares problem of `fit_pose`: arguments as there.

    `whiten` (2n, 2n) is the inverse of the pixels' Cholesky factor, which makes their residuals
    independent and of variance 1.
    """

    camera: Camera
    view: CameraPose
    points_body: Array
    corners_px: Array
    prior: BodyPrior
    whiten: Array

    def start(self) -> Array:
        """Compute a starting state (6,): the prior's height, no tilt, and x, y, yaw fitted.

        They are fitted to the pixels' rays on the level plane of the points' mean height.
        """
        height = self.prior.height + self.points_body[:, 2].mean()
        seen = to_floor(self.camera, self.view, self.corners_px, height)
        body = self.points_body[:, :2]
        a, b = body - body.mean(axis=0), seen - seen.mean(axis=0)
        yaw = np.arctan2((a[:, 0] * b[:, 1] - a[:, 1] * b[:, 0]).sum(), (a * b).sum())
        turn = np.array([[np.cos(yaw), -np.sin(yaw)], [np.sin(yaw), np.cos(yaw)]])
        xy = seen.mean(axis=0) - turn @ body.mean(axis=0)
        return np.array([*xy, self.prior.height, 0.0, 0.0, yaw])

    def residual(self, state: Array) -> Array:
        """Compute the whitened residuals of pixels, then of height, roll and pitch, (2n + 3,)."""
        pixels = project(self.camera, self.view, body_to_floor(self.points_body, state))
        prior = self.prior
        held = (
            (state[2] - prior.height) / prior.height_sd,
            state[3] / prior.tilt_sd,
            state[4] / prior.tilt_sd,
        )
        return np.concatenate((self.whiten @ (pixels - self.corners_px).ravel(), held))

    def jacobian(self, state: Array) -> Array:
        """Compute the derivative of `residual` by the state, shape (2n + 3, 6)."""
        _, dR = rotation_with_derivatives(*state[3:])
        by_state = np.empty((len(self.points_body), 3, 6))
        by_state[:, :, :3] = np.eye(3)
        by_state[:, :, 3:] = np.einsum("kab,nb->nak", dR, self.points_body)
        by_point = project_with_derivatives(
            self.camera, self.view, body_to_floor(self.points_body, state)
        ).by_point
        pixels = self.whiten @ (by_point @ by_state).reshape(-1, 6)
        held = np.zeros((3, 6))
        held[0, 2] = 1 / self.prior.height_sd
        held[1, 3] = held[2, 4] = 1 / self.prior.tilt_sd
        return np.vstack((pixels, held))

    def by_cause(
        self, state: Array, points_by: Mapping[str, Array], pixels_by: Mapping[str, Array]
    ) -> dict[str, Array]:
        """Compute the derivative of the residual by camera, lens and further causes (2n + 3, k).

        The last 3 rows (prior) are 0.
        """
        R, _ = rotation_with_derivatives(*state[3:])
        points = body_to_floor(self.points_body, state)
        seen = project_with_derivatives(self.camera, self.view, points)
        by_cause = {CAMERA: seen.by_pose, LENS: seen.by_lens}
        for cause, of_points in points_by.items():
            by_cause[cause] = seen.by_point @ R @ of_points
        by_cause |= pixels_by
        return {
            cause: np.vstack((self.whiten @ each.reshape(-1, each.shape[2]),
                              np.zeros((3, each.shape[2]))))
            for cause, each in by_cause.items()
        }  # fmt: skip
