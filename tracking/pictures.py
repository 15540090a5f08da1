# SPDX-License-Identifier: MIT
"""Pictures that let a person check a track: drawn over a photograph, and over the floor from above.

Arrays in, arrays out; writing them is the caller's.
"""

import cv2
import numpy as np
from numpy.typing import ArrayLike, NDArray

from tracking.body.template import sample
from tracking.camera.lens import Array, Camera, CameraPose, project

_PATH_BGR = (40, 40, 230)
_ARROW_BGR = (40, 200, 40)
_ELLIPSE_BGR = (220, 140, 20)
_SUBPIXEL = 4


def draw_overlay(
    pixels: NDArray[np.uint8], camera: Camera, view: CameraPose, *, poses: ArrayLike,
    covariance: ArrayLike, height: float, arrow: float = 0.1,
) -> NDArray[np.uint8]:  # fmt: skip
    """Draw a path over a photograph: the body's origin, headings and 90 % regions.

    Args:
        pixels: The photograph, BGR.
        camera: The lens.
        view: Where the camera stands.
        poses: x, y [m] and yaw [rad], shape (n, 3).
        covariance: Of them, shape (n, 3, 3).
        height: Height of the body's origin over the floor [m].
        arrow: Length of a heading's arrow [m].

    Returns:
        A new picture.
    """
    places = np.asarray(poses, dtype=float)
    picture = pixels.copy()
    flat = [[x, y, height] for x, y, _ in places]
    _polyline(picture, project(camera, view, flat), _PATH_BGR)
    for (x, y, yaw), spread in zip(places, np.asarray(covariance, dtype=float), strict=True):
        tip = [x + arrow * np.cos(yaw), y + arrow * np.sin(yaw), height]
        _polyline(picture, project(camera, view, [[x, y, height], tip]), _ARROW_BGR)
        ring = np.add(ellipse_90(spread[:2, :2]), [x, y])
        world = np.column_stack((ring, np.full(len(ring), height)))
        _polyline(picture, project(camera, view, world), _ELLIPSE_BGR)
    return picture


def rectify_floor(
    pixels: NDArray[np.uint8], camera: Camera, view: CameraPose, *, low: ArrayLike,
    high: ArrayLike, pixels_per_metre: float, height: float = 0.0,
) -> NDArray[np.uint8]:  # fmt: skip
    """Draw the floor as seen from straight above, x to the right and y up.

    Args:
        pixels: A photograph, BGR.
        camera: The lens.
        view: Where the camera stands.
        low: Lowest x and y shown, shape (2,) [m].
        high: Highest x and y shown, shape (2,) [m].
        pixels_per_metre: Scale [px/m].
        height: Height of the plane that is drawn where it is; what is above or below leans [m].

    Returns:
        BGR picture; black where the photograph shows nothing.
    """
    (x0, y0), (x1, y1) = np.asarray(low, dtype=float), np.asarray(high, dtype=float)
    step = 1.0 / pixels_per_metre
    xx, yy = np.meshgrid(np.arange(x0, x1, step), np.arange(y1, y0, -step))
    world = np.stack((xx, yy, np.full_like(xx, height)), axis=-1).reshape(-1, 3)
    seen = project(camera, view, world).reshape(*xx.shape, 2)
    return np.clip(np.round(sample(pixels, seen)), 0, 255).astype(np.uint8)


def draw_path_on_floor(
    floor: NDArray[np.uint8], poses: ArrayLike, *, low: ArrayLike, high: ArrayLike,
    pixels_per_metre: float,
) -> NDArray[np.uint8]:  # fmt: skip
    """Draw a path on a rectified floor of the same `low`, `high` and scale.

    Args:
        floor: Picture from `rectify_floor`.
        poses: x, y [m] and yaw [rad], shape (n, 3).
        low: Lowest x and y shown, shape (2,) [m].
        high: Highest x and y shown, shape (2,) [m].
        pixels_per_metre: Scale [px/m].

    Returns:
        A new picture.
    """
    places, picture = np.asarray(poses, dtype=float), floor.copy()
    corner = np.array([np.asarray(low, dtype=float)[0], np.asarray(high, dtype=float)[1]])
    middle = (places[:, :2] - corner) * [pixels_per_metre, -pixels_per_metre]
    _polyline(picture, middle, _PATH_BGR)
    ahead = 0.05 * pixels_per_metre * np.column_stack((np.cos(places[:, 2]), -np.sin(places[:, 2])))
    for start, step in zip(middle, ahead, strict=True):
        _polyline(picture, np.array([start, start + step]), _ARROW_BGR)
    return picture


def ellipse_90(covariance: Array) -> Array:
    """Compute the outline of the region that holds 90 % of a planar normal density.

    Args:
        covariance: Shape (2, 2).

    Returns:
        Points around the origin, closed, shape (33, 2).
    """
    values, vectors = np.linalg.eigh(covariance)
    angle = np.linspace(0, 2 * np.pi, 33)
    # -2 ln(1 - 0.9) is the 90 % point of chi-squared with two degrees of freedom.
    radii = np.sqrt(np.maximum(values, 0) * -2 * np.log(0.1))
    return np.column_stack((np.cos(angle), np.sin(angle))) * radii @ vectors.T


def _polyline(picture: NDArray[np.uint8], points: ArrayLike, colour: tuple[int, int, int]) -> None:
    scaled = np.round(np.asarray(points, dtype=float) * 2**_SUBPIXEL).astype(np.int32)
    width = max(1, round(picture.shape[1] / 900))
    cv2.polylines(picture, [scaled], False, colour, width, cv2.LINE_AA, _SUBPIXEL)
