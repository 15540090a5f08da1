# SPDX-License-Identifier: MIT
"""Corners of a marker from all its pixels: fit the picture it would give, compare, improve.

Detectors find corners by their edges, to 0.1-0.5 px. But the marker is known, so every edge of
every cell tells where it is. The model of a pixel is

    I(p) = o + o_x x + o_y y + g D + q D (1 - D),    D = (T_c * G_s)(p)

with T_c the marker drawn with its corners at c, G_s a Gaussian blur, g the contrast, o the
brightness with a slope for shading, and q the bend of the camera's tone curve: pictures are blurred
in light but stored in tones, which moves every edge towards the black by a part of the blur and,
unmodelled, makes markers look small and hence far. These fourteen unknowns are fitted by
Gauss-Newton; the residual gives the noise, the normal equations the covariance.
"""

from dataclasses import dataclass, field

import cv2
import numpy as np
from numpy.typing import NDArray

from tracking.camera.lens import Array
from tracking.markers.square import (
    apply_homography,
    marker_picture,
    square_homography,
)

CORNER_FLOOR_PX = 0.02
"""What the model of a pixel leaves out (tone curve, JPEG, a print that is not flat) [px]."""

_MOST_PIXELS = 4_000
_LONGEST_SIDE = 60.0


@dataclass(frozen=True)
class Sighting:
    """A marker in a picture.

    Attributes:
        marker_id: Number of the marker in its dictionary.
        corners_px: Corners in OpenCV's order, shape (4, 2) [px]; pixel centres are integers.
        covariance: Of the corners, raveled, shape (8, 8) [px²].
        score: Correlation of the picture inside the black border with the marker's own, 1 for a
            perfect picture, 0.5 for the most similar other marker of a good dictionary [-].
        blur: Standard deviation of the blur that fits [px].
    """

    marker_id: int
    corners_px: Array
    covariance: Array
    score: float
    blur: float


def refine_corners(
    grey: NDArray[np.uint8], corners_px: Array, *, dictionary: str, marker_id: int,
    iterations: int = 12
) -> Sighting | None:  # fmt: skip
    """Fit a marker's picture, starting a pixel or two beside its corners.

    Args:
        grey: The picture, shape (height, width).
        corners_px: First guess of the corners, shape (4, 2) [px].
        dictionary: Name of the marker's dictionary.
        marker_id: Its number there.
        iterations: Most steps of Gauss-Newton.

    Returns:
        The marker as fitted, or None where the fit leaves the picture or collapses.
    """
    shrink = max(1, int(_longest_side(corners_px) / _LONGEST_SIDE))
    patch = _Patch.around(grey, corners_px, shrink)
    if patch is None:
        return None
    start = patch.own(corners_px)
    fit = _Fit(start, blur=_first_blur(start))
    for _ in range(iterations):
        step = _improve(fit, patch, dictionary, marker_id)
        if step is None:
            return None
        fit, moved = step
        if moved < 3e-3:
            break
    if np.abs(fit.corners - start).max() > 0.25 * _shortest_side(start):
        return None
    covariance = shrink**2 * fit.covariance + CORNER_FLOOR_PX**2 * np.eye(8)
    return Sighting(marker_id, patch.whole(fit.corners), covariance, fit.score, shrink * fit.blur)


@dataclass(frozen=True)
class _Patch:
    """A window of the picture: its corner there [px], its pixels, and how densely they are used.

    A marker of hundreds of pixels is shrunk: corners need no more than some dozens a side, and
    time goes with their square.
    """

    origin: Array
    values: Array
    shrink: int
    stride: int

    @classmethod
    def around(cls, grey: NDArray[np.uint8], corners_px: Array, shrink: int) -> "_Patch | None":
        """Cut the marker out with its white margin and room for the fit to move."""
        reach = 0.25 * np.ptp(corners_px, axis=0).max() + 3
        low = np.maximum(np.floor(corners_px.min(axis=0) - reach).astype(int), 0)
        high = np.minimum(np.ceil(corners_px.max(axis=0) + reach).astype(int) + 1, grey.shape[::-1])
        width, height = (high - low) // shrink
        if width < 8 or height < 8:
            return None
        window = grey[low[1] : low[1] + height * shrink, low[0] : low[0] + width * shrink]
        values = cv2.resize(
            window.astype(np.float32), (width, height), interpolation=cv2.INTER_AREA
        )
        stride = max(1, round(np.sqrt(values.size / _MOST_PIXELS)))
        return cls(low.astype(float), np.asarray(values, dtype=float), shrink, stride)

    def own(self, corners_px: Array) -> Array:
        """Turn pixels of the picture into pixels of the patch, centres at integers in both."""
        return (corners_px - self.origin + 0.5) / self.shrink - 0.5

    def whole(self, corners: Array) -> Array:
        """Turn pixels of the patch into pixels of the picture."""
        return (corners + 0.5) * self.shrink - 0.5 + self.origin


@dataclass(frozen=True)
class _Fit:
    """State of Gauss-Newton: corners in the patch [px], blur [px] and what the last step told."""

    corners: Array
    blur: float
    covariance: Array = field(default_factory=lambda: np.zeros((8, 8)))
    score: float = 0.0


def _improve(
    fit: _Fit, patch: _Patch, dictionary: str, marker_id: int
) -> tuple[_Fit, float] | None:
    """Take one step of Gauss-Newton; return the fit and how far its corners moved [px]."""
    points = _pixels_used(fit.corners, patch)
    if len(points) < 40:
        return None
    column, row = points.T.astype(int)
    values = patch.values[row, column]
    drawn = _draw(dictionary, marker_id, fit.corners, fit.blur, patch.values.shape)
    shade = np.column_stack((np.ones(len(points)), points - points.mean(axis=0)))
    tone = drawn[row, column]
    light_design = np.column_stack((shade, tone, tone * (1 - tone)))
    light, *_ = np.linalg.lstsq(light_design, values, rcond=None)
    contrast = light[3]
    if contrast <= 1.0:  # less than a grey level: nothing, or a negative
        return None
    residual = values - light_design @ light
    steepness = contrast + light[4] * (1 - 2 * tone)
    geometry = steepness[:, None] * _geometry_design(fit, drawn, points)
    inverse = _inverse_normal(np.column_stack((geometry, light_design)))
    if inverse is None:
        return None
    step = inverse[:9] @ (np.column_stack((geometry, light_design)).T @ residual)
    longest = float(np.abs(step[:8]).max())
    step[:8] *= min(1.0, 0.1 * _shortest_side(fit.corners) / max(longest, 1e-12))
    noise = residual @ residual / max(len(points) - 14, 1)
    improved = _Fit(
        fit.corners + step[:8].reshape(4, 2),
        float(np.clip(fit.blur + np.clip(step[8], -0.5, 0.5), 0.3, 8.0)),
        noise * inverse[:8, :8] * _correlated(fit.blur, patch.stride),
        _likeness(fit.corners, points, values - shade @ light[:3], drawn[row, column], dictionary),
    )
    return improved, float(np.abs(step[:8]).max())


def _geometry_design(fit: _Fit, drawn: Array, points: Array) -> Array:
    """Compute how drawn pixels change with the eight corner numbers and the blur, shape (n, 9)."""
    column, row = points.T.astype(int)
    slope = np.column_stack([np.gradient(drawn, axis=axis)[row, column] for axis in (1, 0)])
    by_corner = -np.einsum("pa,pak->pk", slope, _corner_flow(fit.corners, points))
    # d/ds of a Gaussian blur of s is s times the Laplacian (heat equation).
    by_blur = fit.blur * np.asarray(cv2.Laplacian(drawn, cv2.CV_64F))[row, column]
    return np.column_stack((by_corner, by_blur))


def _inverse_normal(design: Array) -> Array | None:
    normal = design.T @ design
    normal[8, 8] += 1e-3 * normal[8, 8] + 1e-9  # a sharp picture says nothing about its blur
    try:
        return np.linalg.inv(normal + 1e-12 * np.trace(normal) * np.eye(len(normal)))
    except np.linalg.LinAlgError:
        return None


def _correlated(blur: float, stride: int) -> float:
    # What the model misses is smooth over about the blur, so neighbouring pixels repeat each
    # other: their number is divided by the area of that blur.
    return max(1.0, 2 * np.pi * min(blur, 2.0) ** 2 / 4 / stride**2)


def _likeness(corners: Array, points: Array, values: Array, drawn: Array, dictionary: str) -> float:
    # Only cells inside the black border tell one marker from another: all have the border.
    own = apply_homography(np.linalg.inv(square_homography(corners)), points)
    inside = (np.abs(own - 0.5) < 0.5 - 1 / _cells(dictionary)).all(axis=1)
    if inside.sum() < 16:
        return 0.0
    a, b = values[inside] - values[inside].mean(), drawn[inside] - drawn[inside].mean()
    return float(a @ b / np.sqrt(max((a @ a) * (b @ b), 1e-12)))


def _pixels_used(corners: Array, patch: _Patch) -> Array:
    height, width = patch.values.shape
    steps = (np.arange(0, width, patch.stride), np.arange(0, height, patch.stride))
    points = np.stack(np.meshgrid(*steps), axis=-1).reshape(-1, 2).astype(float)
    own = apply_homography(np.linalg.inv(square_homography(corners)), points)
    # The marker and most of the margin that every print has, one cell of at least six.
    return points[(np.abs(own - 0.5) < 0.5 + 0.09).all(axis=1)]


def _corner_flow(corners: Array, points: Array) -> Array:
    """Compute how the marker's points in the picture move with its corners, shape (n, 2, 8)."""
    own = apply_homography(np.linalg.inv(square_homography(corners)), points)
    step = 1e-4 * _shortest_side(corners)
    flow = np.empty((len(points), 2, 8))
    for index in range(8):
        moved = corners.copy()
        moved.flat[index] += step
        flow[:, :, index] = (apply_homography(square_homography(moved), own) - points) / step
    return flow


def _draw(
    dictionary: str, marker_id: int, corners: Array, blur: float, shape: tuple[int, ...]
) -> Array:
    cells = _cells(dictionary)
    # At least twice the picture's resolution, so that drawing does not blur by itself.
    cell_px = int(np.clip(2 ** np.ceil(np.log2(2 * _longest_side(corners) / cells)), 8, 64))
    picture = marker_picture(dictionary, marker_id, cell_px)
    inner = cells * cell_px
    own_from_drawn = np.array(
        [[1, 0, 0.5 - cell_px], [0, 1, 0.5 - cell_px], [0, 0, inner]], dtype=float
    ) / inner  # fmt: skip
    n = 3 if cells * 6 > _shortest_side(corners) else 2  # finer where cells are small
    fine = np.array([[n, 0, (n - 1) / 2], [0, n, (n - 1) / 2], [0, 0, 1.0]])
    drawn = cv2.warpPerspective(
        picture, fine @ square_homography(corners) @ own_from_drawn,
        (shape[1] * n, shape[0] * n), flags=cv2.INTER_LINEAR, borderValue=(1.0,)
    )  # fmt: skip
    drawn = cv2.resize(drawn, (shape[1], shape[0]), interpolation=cv2.INTER_AREA)
    return np.asarray(cv2.GaussianBlur(drawn.astype(float), (0, 0), blur), dtype=float)


def _cells(dictionary: str) -> int:
    return marker_picture(dictionary, 0, 1).shape[0] - 2


def _first_blur(corners: Array) -> float:
    return float(np.clip(_shortest_side(corners) / 60, 0.6, 2.0))


def _sides(corners: Array) -> Array:
    return np.linalg.norm(corners - np.roll(corners, -1, axis=0), axis=1)


def _shortest_side(corners: Array) -> float:
    return float(_sides(corners).min())


def _longest_side(corners: Array) -> float:
    return float(_sides(corners).max())
