# SPDX-License-Identifier: MIT
"""Pinhole camera with lens distortion: points to pixels, and pixels back to rays.

Written out in full, so that the truth of a synthetic photograph depends on no other code.
"""

from dataclasses import dataclass, field

import numpy as np
from numpy.typing import ArrayLike

from model.arrays import Array

_FIXED_POINT_STEPS = 30  # distortions of real lenses shrink the error tenfold a step


@dataclass(frozen=True)
class SyntheticCamera:
    r"""A camera that looks at the world.

    A point X in the inertial frame is at :math:`X_c = R X + t` in the camera's frame, whose x
    points right, y down and z forward. Pixel centres are at whole numbers; the centre of an image
    of width w is at (w - 1)/2.

    Attributes:
        width: Of its pictures [px].
        height: Of its pictures [px].
        focal: Focal lengths along x and y, shape (2,) [px].
        centre: Principal point, shape (2,) [px].
        distortion: k1, k2, p1, p2, k3 of Brown's model [-].
        rotation: R, shape (3, 3).
        translation: t, shape (3,) [m].
    """

    width: int
    height: int
    focal: tuple[float, float]
    centre: tuple[float, float]
    distortion: tuple[float, float, float, float, float] = (0.0, 0.0, 0.0, 0.0, 0.0)
    rotation: Array = field(default_factory=lambda: np.eye(3))
    translation: Array = field(default_factory=lambda: np.zeros(3))

    @property
    def matrix(self) -> Array:
        """The camera matrix, shape (3, 3) [px]."""
        return np.array(
            [[self.focal[0], 0.0, self.centre[0]], [0.0, self.focal[1], self.centre[1]], [0, 0, 1]]
        )

    @property
    def position(self) -> Array:
        """Where the camera is in the inertial frame, shape (3,) [m]."""
        return -self.rotation.T @ self.translation

    def project(self, points: ArrayLike) -> Array:
        """Compute where points of the inertial frame appear.

        Args:
            points: Shape (..., 3) [m].

        Returns:
            Pixels, shape (..., 2); NaN for points behind the camera [px].
        """
        seen = np.asarray(points, dtype=float) @ self.rotation.T + self.translation
        depth = np.where(seen[..., 2] > 0, seen[..., 2], np.nan)
        bent = distort(seen[..., :2] / depth[..., None], self.distortion)
        return bent * self.focal + self.centre

    def rays(self, pixels: ArrayLike) -> Array:
        """Compute the direction of the ray through each pixel, the inverse of `project`.

        Args:
            pixels: Shape (..., 2) [px].

        Returns:
            Directions in the camera's frame with z = 1, shape (..., 3) [-].
        """
        bent = (np.asarray(pixels, dtype=float) - self.centre) / self.focal
        straight = undistort(bent, self.distortion)
        return np.concatenate([straight, np.ones_like(straight[..., :1])], axis=-1)


def look_at(
    position: ArrayLike,
    target: ArrayLike,
    *,
    width: int = 1280,
    height: int = 960,
    field_of_view: float = np.radians(50.0),
    distortion: tuple[float, float, float, float, float] = (0.0, 0.0, 0.0, 0.0, 0.0),
) -> SyntheticCamera:
    """Make an upright camera that points at a target.

    Args:
        position: Of the camera, shape (3,) [m].
        target: What appears in the middle of the picture; not straight above or below the camera,
            shape (3,) [m].
        width: [px].
        height: [px].
        field_of_view: Across the width, without distortion [rad].
        distortion: k1, k2, p1, p2, k3 [-].
    """
    place = np.asarray(position, dtype=float)
    forward = np.asarray(target, dtype=float) - place
    forward /= np.linalg.norm(forward)
    right = np.cross(forward, [0.0, 0.0, 1.0])
    right /= np.linalg.norm(right)
    rotation = np.stack([right, np.cross(forward, right), forward])
    focal = width / 2 / np.tan(field_of_view / 2)
    return SyntheticCamera(
        width, height, (focal, focal), ((width - 1) / 2, (height - 1) / 2), distortion,
        rotation, -rotation @ place,
    )  # fmt: skip


def distort(normalised: ArrayLike, distortion: tuple[float, ...]) -> Array:
    r"""Apply Brown's model of a lens to normalised image points.

    .. math::
        x' = x (1 + k_1 r^2 + k_2 r^4 + k_3 r^6) + 2 p_1 x y + p_2 (r^2 + 2 x^2), \quad
        y' = y (1 + k_1 r^2 + k_2 r^4 + k_3 r^6) + p_1 (r^2 + 2 y^2) + 2 p_2 x y

    Source: D.C. Brown, Close-range camera calibration, 1971.

    Args:
        normalised: X/Z and Y/Z, shape (..., 2) [-].
        distortion: k1, k2, p1, p2, k3 [-].

    Returns:
        Distorted points, shape (..., 2) [-].
    """
    points = np.asarray(normalised, dtype=float)
    scale, shift = _radial_and_tangential(points, distortion)
    return points * scale[..., None] + shift


def undistort(distorted: ArrayLike, distortion: tuple[float, ...]) -> Array:
    """Invert `distort` by fixed-point iteration, to rounding for lenses of moderate distortion.

    Args:
        distorted: Shape (..., 2) [-].
        distortion: k1, k2, p1, p2, k3 [-].

    Returns:
        Normalised points, shape (..., 2) [-].
    """
    goal = np.asarray(distorted, dtype=float)
    if not any(distortion):
        return goal
    points = goal
    for _ in range(_FIXED_POINT_STEPS):
        scale, shift = _radial_and_tangential(points, distortion)
        step = (goal - shift) / scale[..., None] - points
        points = points + step
        if np.max(np.abs(step), initial=0.0) < 1e-12:
            break
    return points


def _radial_and_tangential(points: Array, distortion: tuple[float, ...]) -> tuple[Array, Array]:
    k1, k2, p1, p2, k3 = distortion
    x, y = points[..., 0], points[..., 1]
    r2 = x * x + y * y
    scale = 1 + r2 * (k1 + r2 * (k2 + r2 * k3))
    shift = np.stack(
        [2 * p1 * x * y + p2 * (r2 + 2 * x * x), p1 * (r2 + 2 * y * y) + 2 * p2 * x * y], axis=-1
    )
    return scale, shift
