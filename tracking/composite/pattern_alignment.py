# SPDX-License-Identifier: MIT
"""Align a faint exposure with a clearer template of the robot, in prewhitened pixels.

Photograph and template are compared after the floor's prediction filter (`floor_pattern`), so that
least squares sees white noise. The Jacobian is that of the template. The photograph's gradients,
which `tracking.body.align` uses, are mostly the floor's where the robot is faint.
"""

from dataclasses import dataclass
from functools import cached_property
from typing import NamedTuple

import cv2
import numpy as np
from numpy.typing import NDArray

from model.arrays import Array
from tracking.body import Alignment, BodyTemplate
from tracking.body.template import sample
from tracking.camera.lens import project_with_derivatives
from tracking.composite.floor_pattern import REACH_PX, FloorPattern
from tracking.composite.known import KnownExposure
from tracking.pose import PLANAR, BodyPose, rotation_with_derivatives
from tracking.shared import CAMERA, LENS

AROUND = 0.15
"""Margin that the template must have beyond the robot's top, in lengths of the top [-]."""

_REACH = 0.6  # of the body's diagonal: half a side of the window
_ITERATIONS = 6
_HUBER = 1.5
_LIMIT = np.array([0.01, 0.01, 0.05])  # m, m, rad: longest step
_LEAST_POINTS = 200
_ASSUMED = [2, 3, 4]  # height, roll and pitch in a state
# Columns: the state, the camera's pose and the lens.
_ALL, _CAMERA, _LENS = list(range(21)), slice(6, 12), slice(12, 21)


class PatternResidual(NamedTuple):
    """Prewhitened photograph and template at a pose, with robust weights of their difference.

    Attributes:
        seen: Prewhitened values of the photograph, pixels and colours raveled, shape (n,).
        expected: Prewhitened values of the template drawn at the pose, shape (n,).
        slopes: Derivative of `expected` by m components of the robot's state and the camera's
            pose, shape (n, m).
        noise: Standard deviation of the residual, by the median absolute deviation [-].
        weight: Huber's weights, 1 for small residuals, shape (n,) [-].
    """

    seen: Array
    expected: Array
    slopes: Array
    noise: float
    weight: Array

    @classmethod
    def of(cls, seen: Array, expected: Array, slopes: Array) -> "PatternResidual":
        """Compute noise and weights of `seen` minus `expected` at its best gain.

        Args:
            seen: Prewhitened values of the photograph, shape (n,).
            expected: Prewhitened values of the template, shape (n,).
            slopes: Derivative of `expected`, shape (n, m).
        """
        gain = expected @ seen / max(expected @ expected, 1e-9)
        size = np.abs(seen - gain * expected)
        noise = max(1.4826 * float(np.median(size)), 1e-6)
        weight = np.minimum(1.0, _HUBER * noise / np.maximum(size, 1e-9))
        return cls(seen, expected, slopes, noise, weight)

    @property
    def score(self) -> float:
        """Correlation of `seen` and `expected`, without subtracting means [-]."""
        power = (self.expected @ self.expected) * (self.seen @ self.seen)
        return float(self.expected @ self.seen / np.sqrt(max(power, 1e-9)))

    def step(self) -> Array:
        """Compute one Gauss-Newton step of x, y and yaw, clipped, shape (3,) [m, m, rad].

        `slopes` must be those by x, y and yaw; the gain of the template is fitted, too.
        """
        J = np.column_stack((self.slopes, self.expected))
        weighed = self.weight[:, None] * J
        change = np.linalg.lstsq(weighed.T @ J, weighed.T @ (self.seen - self.expected))[0]
        return np.clip(change[:3], -_LIMIT, _LIMIT)


@dataclass(frozen=True)
class PatternAlignment:
    """Alignment of one exposure with a template, in prewhitened pixels.

    Attributes:
        known: The picture and the known exposure.
        residual: The picture after all other exposures are subtracted, whitened colours, high-pass
            filtered (`FloorPattern.flat`), shape (height, width, 3).
        template: Template of the robot's top and `AROUND` it, filtered likewise.
        pattern: Prediction filter of the floor.
        start: x, y [m] and yaw [rad] to start from, shape (3,).
    """

    known: KnownExposure
    residual: NDArray[np.float32]
    template: BodyTemplate
    pattern: FloorPattern
    start: Array

    def solved(self) -> Alignment | None:
        """Align by Gauss-Newton steps.

        Returns:
            The alignment, or None where fewer than 200 pixels of the top are visible. Height is
            that of `known.prior`, roll and pitch are 0; their uncertainty is in the covariance.
        """
        pose = self.start.copy()
        for _ in range(_ITERATIONS):
            residual = self.residual_at(pose, PLANAR)
            if residual is None:
                return None
            pose = pose + residual.step()
        residual = self.residual_at(pose, _ALL)
        return None if residual is None else self.concluded(pose, residual)

    @cached_property
    def window(self) -> tuple[tuple[slice, slice], Array]:
        """Slices of the picture's rows and columns around `start`, and x, y of its pixels.

        x, y on the plane of the top, in the floor frame, shape (rows, columns, 2) [m].
        """
        return self.known.around(self.start, reach=_REACH)

    @cached_property
    def seen(self) -> NDArray[np.float32]:
        """Prediction error of `residual` in the window, shape (rows, columns, 3)."""
        return self.pattern.prediction_error(self.residual[self.window[0]])

    @cached_property
    def shown(self) -> NDArray[np.bool_]:
        """Mask of the window's pixels with no hidden pixel within the filter's reach."""
        hidden = self.known.hidden[self.window[0]].astype(np.uint8)
        side = 2 * REACH_PX + 1
        return cv2.dilate(hidden, np.ones((side, side), np.uint8)) == 0

    def residual_at(self, pose: Array, by: list[int]) -> PatternResidual | None:
        """Compute residual and Jacobian on the top at a pose; None below 200 visible pixels.

        Args:
            pose: x, y [m] and yaw [rad], shape (3,).
            by: Columns of the Jacobian: 0 to 5 the robot's state, 6 to 11 the camera's pose.
        """
        body = self.body_at(pose)
        half = 0.5 * np.array([self.known.plate.length, self.known.plate.width])
        centre = [self.known.plate.centre_x, self.known.plate.centre_y]
        inside = (np.abs(body - centre) <= half).all(axis=-1)
        used = inside & self.shown
        if used.sum() < _LEAST_POINTS:
            return None
        drawn = self.drawn(body)
        expected = self.pattern.prediction_error(drawn)[used]
        slopes = self.pattern.prediction_error(self.slopes(drawn, body, pose)[..., by])[used]
        return PatternResidual.of(
            self.seen[used].ravel().astype(float),
            expected.ravel().astype(float),
            slopes.reshape(-1, slopes.shape[-1]).astype(float),
        )

    def body_at(self, pose: Array) -> Array:
        """Compute x, y of the window's pixels in the body frame, (rows, columns, 2) [m]."""
        c, s = np.cos(pose[2]), np.sin(pose[2])
        return (self.window[1] - pose[:2]) @ np.array([[c, -s], [s, c]])

    def drawn(self, body: Array) -> NDArray[np.float32]:
        """Interpolate the template at x, y of the body frame, (rows, columns, 3), 0 outside."""
        front_left = self.template.points_body[0, 0, :2]
        return sample(self.template.colours, (front_left - body)[..., ::-1] / self.template.step)

    def slopes(self, drawn: NDArray[np.float32], body: Array, pose: Array) -> Array:
        """Compute the Jacobian of the drawn picture, before filtering, by state and camera's pose.

        Args:
            drawn: The drawn picture, shape (rows, columns, 3).
            body: x, y of its pixels in the body frame, shape (rows, columns, 2) [m].
            pose: x, y [m] and yaw [rad], shape (3,).

        Returns:
            Jacobian, shape (rows, columns, 3, 21): x, y, z, roll, pitch, yaw, then the camera's
            rotation vector and translation, and the lens.
        """
        state = self.known.level(pose)
        points = np.concatenate(
            (body, np.full((*body.shape[:2], 1), self.known.plate.height)), axis=2
        ).reshape(-1, 3)
        R, dR = rotation_with_derivatives(*state[3:])
        _, by_point, by_camera, by_lens = project_with_derivatives(
            self.known.camera, self.known.view, points @ R.T + state[:3]
        )
        turned = (points @ dR.transpose(0, 2, 1)).transpose(1, 2, 0)
        moved = np.concatenate((by_point, by_point @ turned, by_camera, by_lens), axis=2)
        along = [cv2.Scharr(drawn, cv2.CV_32F, *axis, scale=1 / 32) for axis in ((1, 0), (0, 1))]
        slope = np.stack(along, axis=-1)
        return -slope @ moved.reshape(*body.shape[:2], 2, 21)

    def concluded(self, pose: Array, residual: PatternResidual) -> Alignment:
        """Build the alignment: the pose, its covariances from the Jacobian, and the score.

        Args:
            pose: x, y [m] and yaw [rad], shape (3,).
            residual: Residual, weights, noise and Jacobian of all 21 columns at the pose.
        """
        J, prior = residual.slopes[:, PLANAR], self.known.prior
        weighed = residual.weight[:, None] * J / residual.noise**2
        spread = np.linalg.inv(weighed.T @ J)
        follow = spread @ weighed.T @ residual.slopes  # x, y and yaw by state and camera's pose
        covariance = np.zeros((6, 6))
        covariance[np.ix_(PLANAR, PLANAR)] = spread
        by_camera, by_lens = np.zeros((6, 6)), np.zeros((6, 9))
        by_assumed = np.zeros((6, 3))
        by_assumed[PLANAR], by_assumed[_ASSUMED] = follow[:, _ASSUMED], -np.eye(3)
        # The pose follows the camera against the residual, as it does what is assumed.
        by_camera[PLANAR], by_lens[PLANAR] = -follow[:, _CAMERA], -follow[:, _LENS]
        return Alignment(
            BodyPose(
                self.known.level(pose),
                covariance + by_assumed @ prior.covariance @ by_assumed.T,
                {CAMERA: by_camera, LENS: by_lens},
            ),
            residual.score,
            -residual.seen.size * float(np.log(residual.noise)),
        )
