# SPDX-License-Identifier: MIT
"""Rectified view of the floor, and confidence ellipses of 90 %."""

import numpy as np
from numpy.typing import ArrayLike, NDArray

from model.arrays import Array
from tracking.body.template import sample
from tracking.camera.lens import Camera, CameraPose, project


def rectify_floor(
    pixels: NDArray[np.uint8], camera: Camera, view: CameraPose, *, low: ArrayLike,
    high: ArrayLike, pixels_per_metre: float, height: float = 0.0,
) -> NDArray[np.uint8]:  # fmt: skip
    """Rectify a photograph: draw the floor as seen from straight above, x to the right and y up.

    Args:
        pixels: A photograph, BGR, shape (height, width, 3).
        camera: Camera intrinsics and distortion.
        view: Pose of the camera.
        low: Lowest x and y shown, shape (2,) [m].
        high: Highest x and y shown, shape (2,) [m].
        pixels_per_metre: Scale [px/m].
        height: Height over the floor of the plane drawn to scale; other heights are displaced [m].

    Returns:
        BGR picture, shape (rows, columns, 3), highest y in the first row; black outside the
        photograph, meaningless behind the camera.
    """
    (x0, y0), (x1, y1) = np.asarray(low, dtype=float), np.asarray(high, dtype=float)
    step = 1.0 / pixels_per_metre
    xx, yy = np.meshgrid(np.arange(x0, x1, step), np.arange(y1, y0, -step))
    world = np.stack((xx, yy, np.full_like(xx, height)), axis=-1).reshape(-1, 3)
    seen = project(camera, view, world).reshape(*xx.shape, 2)
    return np.clip(np.round(sample(pixels, seen)), 0, 255).astype(np.uint8)


def ellipse_90(covariance: Array) -> Array:
    """Compute the ellipse that holds 90 % of a planar normal density of mean zero.

    Args:
        covariance: Covariance of x and y, shape (2, 2) [m²].

    Returns:
        Points x, y on the ellipse, the last equal to the first, shape (33, 2) [m].
    """
    values, vectors = np.linalg.eigh(covariance)
    angle = np.linspace(0, 2 * np.pi, 33)
    # -2 ln(1 - 0.9) is the 90 % point of chi-squared with two degrees of freedom.
    radii = np.sqrt(np.maximum(values, 0) * -2 * np.log(0.1))
    return np.column_stack((np.cos(angle), np.sin(angle))) * radii @ vectors.T
