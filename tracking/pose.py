# SPDX-License-Identifier: MIT
"""Pose of the robot from points of it in one photograph, by nonlinear least squares.

All six degrees of freedom are fitted, with a prior on those that a single camera determines badly.
From 3 m away a marker of 0.12 m gives its distance to centimetres and its tilt to degrees. A prior
on height, roll and pitch therefore enters from the robot's dimensions. Minimised is

    r' C^-1 r + ((z - z_body) / sd_z)² + (roll / sd_tilt)² + (pitch / sd_tilt)²

with r the points' pixels minus their projection, C the covariance of the pixels, z_body and sd_z
the prior's height and its standard deviation, sd_tilt that of roll and pitch. x, y and yaw carry no
prior; their covariance includes the uncertainty of height and tilt.
"""

from dataclasses import dataclass

import numpy as np
from numpy.typing import ArrayLike
from scipy.optimize import least_squares

from tracking.camera.lens import (
    Array,
    Camera,
    CameraPose,
    project,
    project_with_derivatives,
    to_floor,
)
from tracking.errors import MarkerError
from tracking.markers import marker_corners


@dataclass(frozen=True)
class RobotMarker:
    """The marker on the robot's back.

    Attributes:
        marker_id: Number of the marker in its dictionary.
        side: Side of the black square, above 0, else MarkerError is raised [m].
        dictionary: Name of the dictionary.
        position: Centre of the marker in the body frame: forward, left, up [m].
        yaw: Turn of the print's left-to-right direction from the body's x, counter-clockwise
            [rad]; -pi/2 when the print's top points ahead.
        side_sd: Standard deviation of `side` [m].
    """

    marker_id: int
    side: float
    dictionary: str
    position: tuple[float, float, float]
    yaw: float = -np.pi / 2
    side_sd: float = 2e-4

    def __post_init__(self) -> None:
        if not self.side > 0:
            raise MarkerError(f"the robot's marker has side {self.side} m; expected more than 0 m")

    @property
    def points_body(self) -> Array:
        """Corners of the marker in the body frame, OpenCV's order, shape (4, 3) [m]."""
        return marker_corners(self.side, self.position, self.yaw)


@dataclass(frozen=True)
class BodyPrior:
    """Prior on the body's height and tilt.

    Attributes:
        height: Height of the body's origin over the floor [m].
        height_sd: Standard deviation of `height` over a walk [m].
        tilt_sd: Standard deviation of roll and of pitch over a walk [rad].
    """

    height: float
    height_sd: float = 3e-3
    tilt_sd: float = 0.02


@dataclass(frozen=True)
class BodyPose:
    """Pose of the robot in one photograph.

    Attributes:
        state: x, y, z [m], roll, pitch, yaw [rad] of the body in the floor frame, shape (6,);
            R = Rz(yaw) Ry(pitch) Rx(roll).
        covariance: Covariance of `state` from errors of pixels, height and tilt, taken as
            independent from photograph to photograph, shape (6, 6).
        camera_covariance: Covariance of `state` from the error of the camera's pose, which the
            photographs of a stand share, shape (6, 6).
    """

    state: Array
    covariance: Array
    camera_covariance: Array

    @property
    def planar(self) -> Array:
        """x, y [m] and yaw [rad] of the body in the floor frame, shape (3,)."""
        return self.state[PLANAR]

    @property
    def planar_covariance(self) -> Array:
        """Covariance of x, y and yaw without the error of the camera's pose, shape (3, 3)."""
        return self.covariance[np.ix_(PLANAR, PLANAR)]


PLANAR = [0, 1, 5]
"""Indices of x, y and yaw in `BodyPose.state`."""


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


def fit_pose(
    camera: Camera,
    view: CameraPose,
    *,
    points_body: ArrayLike,
    corners_px: ArrayLike,
    covariance: ArrayLike,
    prior: BodyPrior,
    scale_sd: float = 0.0,
) -> BodyPose:
    """Fit the robot's pose to points on the robot by least squares, with prior of height and tilt.

    Args:
        camera: Camera intrinsics and distortion.
        view: The camera's pose with covariance.
        points_body: Points in the body frame, shape (n, 3), n at least 2 [m].
        corners_px: The same points in the picture, shape (n, 2) [px].
        covariance: Covariance of `corners_px.ravel()`, shape (2n, 2n) [px²].
        prior: Prior of the body's height and tilt.
        scale_sd: Relative standard deviation of the points' common scale, `side_sd / side` of a
            marker. It limits how well the size in the picture determines the height [-].

    Returns:
        The pose of least cost with its covariances, yaw in -pi to pi.

    Raises:
        ValueError: When a point's ray does not meet the plane of the points' expected mean height.
    """
    pixels = np.asarray(corners_px, dtype=float)
    growth = scale_sd * (pixels - pixels.mean(axis=0)).ravel()
    spread_px = np.asarray(covariance, dtype=float) + np.outer(growth, growth)
    whiten = np.linalg.inv(np.linalg.cholesky(spread_px))
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
    # The state follows the camera: d state = -(J'J)^-1 J' (d residual / d camera) d camera.
    follow = -spread @ J.T @ problem.by_camera(fit.x)
    return BodyPose(_wrapped(fit.x), spread, follow @ view.covariance @ follow.T)


def _wrapped(state: Array) -> Array:
    wrapped = state.copy()
    wrapped[5] = np.arctan2(np.sin(state[5]), np.cos(state[5]))
    return wrapped


@dataclass(frozen=True)
class _PoseProblem:
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

    def points_world(self, state: Array) -> Array:
        R, _ = rotation_with_derivatives(*state[3:])
        return self.points_body @ R.T + state[:3]

    def residual(self, state: Array) -> Array:
        pixels = project(self.camera, self.view, self.points_world(state))
        prior = self.prior
        held = (
            (state[2] - prior.height) / prior.height_sd,
            state[3] / prior.tilt_sd,
            state[4] / prior.tilt_sd,
        )
        return np.concatenate((self.whiten @ (pixels - self.corners_px).ravel(), held))

    def jacobian(self, state: Array) -> Array:
        _, dR = rotation_with_derivatives(*state[3:])
        by_state = np.empty((len(self.points_body), 3, 6))
        by_state[:, :, :3] = np.eye(3)
        by_state[:, :, 3:] = np.einsum("kab,nb->nak", dR, self.points_body)
        _, by_point, _ = project_with_derivatives(self.camera, self.view, self.points_world(state))
        pixels = self.whiten @ (by_point @ by_state).reshape(-1, 6)
        held = np.zeros((3, 6))
        held[0, 2] = 1 / self.prior.height_sd
        held[1, 3] = held[2, 4] = 1 / self.prior.tilt_sd
        return np.vstack((pixels, held))

    def by_camera(self, state: Array) -> Array:
        """Compute the derivative of the residual by the camera's pose, shape (2n + 3, 6).

        Columns: rotation vector [1/rad], translation [1/m]; the last 3 rows (prior) are 0.
        """
        _, _, by_pose = project_with_derivatives(self.camera, self.view, self.points_world(state))
        return np.vstack((self.whiten @ by_pose.reshape(-1, 6), np.zeros((3, 6))))
