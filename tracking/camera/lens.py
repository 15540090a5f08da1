# SPDX-License-Identifier: MIT
"""Pinhole camera with lens distortion: projection to pixels, and back to a plane over the floor.

Pixel coordinates: the *centre* of the first pixel is (0, 0), as in OpenCV, so a picture of width w
spans [-0.5, w - 0.5]. Programs that put (0, 0) at the first pixel's *corner* give numbers larger by
half a pixel, which is 2 mm on the floor of a usual set-up; see `tracking.markers`.
"""

from dataclasses import dataclass, field
from typing import NamedTuple

import cv2
import numpy as np
from numpy.typing import ArrayLike

from model.arrays import Array


@dataclass(frozen=True)
class Camera:
    """Pinhole camera with OpenCV's lens distortion (intrinsic parameters).

    Attributes:
        size: Width and height of the picture [px].
        matrix: Focal lengths and principal point as OpenCV's camera matrix, shape (3, 3) [px].
        distortion: k1, k2, p1, p2, k3 of OpenCV's lens model, shape (5,) [-].
        covariance: Covariance of fx, fy, cx, cy [px], k1, k2, p1, p2, k3 [-], shape (9, 9); zeros
            for a lens taken as exact.
    """

    size: tuple[int, int]
    matrix: Array
    distortion: Array
    covariance: Array = field(default_factory=lambda: np.zeros((9, 9)))

    def scaled(self, size: tuple[int, int]) -> "Camera":
        """Return the camera for the same pictures scaled to another size.

        Args:
            size: Width and height of the scaled pictures [px].

        Raises:
            ValueError: When the aspect ratio differs, as of cropped pictures: by more than 1 px in
                height, at the size of the calibration.
        """
        ratio = size[0] / self.size[0]
        if abs(size[1] / self.size[1] - ratio) * self.size[1] > 1.0:
            raise ValueError(
                f"photographs of {size[0]}x{size[1]} px have another shape than those of "
                f"{self.size[0]}x{self.size[1]} px with which the camera was calibrated; use "
                f"photographs that are not cropped, or calibrate the camera with such photographs"
            )
        matrix = self.matrix.copy()
        matrix[:2, :2] *= ratio
        matrix[:2, 2] = (self.matrix[:2, 2] + 0.5) * ratio - 0.5
        in_pixels = np.array([ratio] * 4 + [1.0] * 5)
        covariance = self.covariance * np.outer(in_pixels, in_pixels)
        return Camera(size, matrix, self.distortion, covariance)

    def changed(self, step: Array) -> "Camera":
        """Return the camera with a step added to fx, fy, cx, cy, k1, k2, p1, p2, k3, shape (9,)."""
        matrix = self.matrix.copy()
        matrix[[0, 1, 0, 1], [0, 1, 2, 2]] += step[:4]
        return Camera(self.size, matrix, self.distortion + step[4:], self.covariance)


@dataclass(frozen=True)
class CameraPose:
    """Pose of the camera: X_camera = R X_world + t, OpenCV's axes (x right, y down, z ahead).

    World is the floor frame.

    Attributes:
        rotation_vector: R as axis times angle, shape (3,) [rad].
        translation: t, shape (3,) [m].
        covariance: Covariance of rotation vector [rad] and translation [m], shape (6, 6); zeros
            for a pose taken as exact.
    """

    rotation_vector: Array
    translation: Array
    covariance: Array

    @property
    def rotation(self) -> Array:
        """Rotation matrix R, world to camera, shape (3, 3) [-]."""
        return np.asarray(cv2.Rodrigues(self.rotation_vector)[0], dtype=float)

    @property
    def position(self) -> Array:
        """Position of the camera's centre in the floor frame, shape (3,) [m]."""
        return -self.rotation.T @ self.translation

    @classmethod
    def from_matrix(cls, rotation: ArrayLike, translation: ArrayLike) -> "CameraPose":
        """Build a camera pose of zero covariance from a rotation matrix and a translation.

        Args:
            rotation: R, world to camera, shape (3, 3) [-].
            translation: t, shape (3,) [m].
        """
        vector = np.ravel(cv2.Rodrigues(np.asarray(rotation, dtype=float))[0]).astype(float)
        return cls(vector, np.asarray(translation, dtype=float), np.zeros((6, 6)))


def project(camera: Camera, pose: CameraPose, points_world: ArrayLike) -> Array:
    """Project points of the floor frame to pixels of the picture.

    Args:
        camera: Camera intrinsics and distortion.
        pose: Pose of the camera.
        points_world: Points, shape (n, 3) [m].

    Returns:
        Pixels, shape (n, 2) [px]. Points behind the camera give meaningless numbers.
    """
    # cv2.projectPoints would compute all derivatives too, which takes most of its time.
    x, y, z = pose.rotation @ np.asarray(points_world, dtype=float).reshape(-1, 3).T + np.reshape(
        pose.translation, (3, 1)
    )
    k1, k2, p1, p2, k3 = np.ravel(camera.distortion)
    with np.errstate(over="ignore", invalid="ignore"):  # beside and behind the camera
        z = np.where(z == 0.0, 1.0, z)
        x, y = x / z, y / z
        xx, yy, xy = x * x, y * y, x * y
        r2 = xx + yy
        radial = 1 + r2 * (k1 + r2 * (k2 + r2 * k3))
        u = x * radial + 2 * p1 * xy + p2 * (r2 + 2 * xx)
        v = y * radial + p1 * (r2 + 2 * yy) + 2 * p2 * xy
        matrix = camera.matrix
        return np.column_stack((matrix[0, 0] * u + matrix[0, 2], matrix[1, 1] * v + matrix[1, 2]))


class Projection(NamedTuple):
    """Pixels of projected points, with their derivatives.

    Attributes:
        pixels: Pixels, shape (n, 2) [px].
        by_point: Derivative with respect to the points, shape (n, 2, 3) [px/m].
        by_pose: Derivative with respect to the camera's rotation vector and translation, shape
            (n, 2, 6) [px/rad, px/m].
        by_lens: Derivative with respect to fx, fy, cx, cy [-], k1, k2, p1, p2, k3 [px], shape
            (n, 2, 9).
    """

    pixels: Array
    by_point: Array
    by_pose: Array
    by_lens: Array


def project_with_derivatives(
    camera: Camera, pose: CameraPose, points_world: ArrayLike
) -> Projection:
    """Project points to pixels; compute the Jacobians by the points, camera's pose and lens.

    Args:
        camera: Camera intrinsics and distortion.
        pose: Pose of the camera.
        points_world: Points, shape (n, 3) [m].
    """
    points = np.ascontiguousarray(points_world, dtype=float).reshape(-1, 1, 3)
    pixels, derivative = cv2.projectPoints(
        points, pose.rotation_vector, pose.translation, camera.matrix, camera.distortion
    )
    by_all = np.asarray(derivative, dtype=float)[:, :15].reshape(-1, 2, 15)
    by_pose = by_all[:, :, :6]
    # d X_camera / d X_world = R, and d X_camera / d t is the identity.
    by_point = by_pose[:, :, 3:] @ pose.rotation
    at = np.asarray(pixels, dtype=float).reshape(-1, 2)
    return Projection(at, by_point, by_pose, by_all[:, :, 6:])


def undistort(camera: Camera, corners_px: ArrayLike) -> Array:
    """Remove lens distortion from pixel coordinates; return shape (n, 2) [px].

    Args:
        camera: Camera intrinsics and distortion.
        corners_px: Pixels of the photograph, shape (n, 2) [px].
    """
    pixels = np.ascontiguousarray(corners_px, dtype=float).reshape(-1, 1, 2)
    straight = cv2.undistortPoints(pixels, camera.matrix, camera.distortion, P=camera.matrix)
    return np.asarray(straight, dtype=float).reshape(-1, 2)


def rays(camera: Camera, pose: CameraPose, corners_px: ArrayLike) -> Array:
    """Compute the viewing directions of pixels in the floor frame.

    Args:
        camera: Camera intrinsics and distortion.
        pose: Pose of the camera.
        corners_px: Pixels, shape (n, 2) [px].

    Returns:
        Unit vectors from the camera in the floor frame, shape (n, 3) [-].
    """
    straight = undistort(camera, corners_px)
    ahead = np.column_stack((straight, np.ones(len(straight)))) @ np.linalg.inv(camera.matrix).T
    directions = ahead @ pose.rotation
    return directions / np.linalg.norm(directions, axis=1, keepdims=True)


def to_floor(camera: Camera, pose: CameraPose, corners_px: ArrayLike, height: float = 0.0) -> Array:
    """Intersect the rays of pixels with a horizontal plane.

    Args:
        camera: Camera intrinsics and distortion.
        pose: Pose of the camera.
        corners_px: Pixels, shape (n, 2) [px].
        height: Height of the plane over the floor [m].

    Returns:
        x and y in the floor frame, shape (n, 2) [m]; NaN where the ray does not reach the plane,
        as above the horizon.
    """
    directions = rays(camera, pose, corners_px)
    eye = pose.position
    with np.errstate(divide="ignore", invalid="ignore"):
        reach = (height - eye[2]) / directions[:, 2]
    reach[~(reach > 0)] = np.nan
    return eye[:2] + reach[:, None] * directions[:, :2]
