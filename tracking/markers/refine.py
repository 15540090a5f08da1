# SPDX-License-Identifier: MIT
"""Refine a marker's corners by fitting a rendered picture of it to all its pixels.

Detectors find corners by their edges, to 0.1-0.5 px. But the marker is known, so every edge of
every cell carries information. The model of a pixel is

    I(p) = o + o_x x + o_y y + g D + q D (1 - D),    D = (T_c * G_s)(p)

with T_c the marker drawn with its corners at c, G_s a Gaussian blur, g the contrast, o the
brightness with a slope for shading, and q the curvature of the camera's tone curve. Pictures are
blurred in light but stored in tones, which moves every edge towards the black by a part of the
blur; unmodelled, this makes markers look small and hence far. These fourteen unknowns are fitted by
Gauss-Newton. The residual gives the noise and its correlation, the normal equations the covariance.
"""

from dataclasses import dataclass

import cv2
import numpy as np
from numpy.typing import NDArray

from model.arrays import Array
from tracking.markers.pixel_noise import unknowns_covariance
from tracking.markers.square import (
    apply_homography,
    marker_picture,
    square_homography,
)

CORNER_FLOOR_PX = 0.003
"""Standard deviation of model errors added to each corner coordinate, in a sharp picture [px]."""

_LAGS_PX = 8
"""Largest lag of the residual's autocovariance: a block of JPEG [px]."""

_SLOPE = np.array([[1.0, -8.0, 0.0, 8.0, -1.0]]) / 12
"""Five-point central difference; that of three points underestimates the slope of a sharp edge."""

_UNITS = np.eye(8).reshape(8, 4, 2)  # of each corner coordinate a unit step
_USUAL_SIDE = 60.0  # px, to about which longer sides are downsampled
_MARGIN = 0.09  # of the side: most of the white margin around the marker that is compared
_BLURS_INSIDE = 2.5  # standard deviations over which blur reaches in from beyond the margin


@dataclass(frozen=True)
class Sighting:
    """A marker detected in a picture, with the covariance of its corners.

    Attributes:
        marker_id: Number of the marker in its dictionary.
        corners_px: Corners in OpenCV's order, shape (4, 2) [px]; pixel centres are integers.
        covariance: Covariance of `corners_px.ravel()`, shape (8, 8) [px²].
        score: Correlation of the picture inside the black border with the marker's pattern, 1 for
            a perfect picture, 0.5 for the most similar other marker of a good dictionary; 0 for
            fewer than 16 pixels, 1 where none was computed (`find_markers`, effort 0) [-].
        blur: Standard deviation of the Gaussian blur fitted [px]; 0 where none was fitted.
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
    """Refine a marker's corners by Gauss-Newton, from a start within a pixel or two.

    Args:
        grey: The picture, shape (height, width).
        corners_px: First guess of the corners, shape (4, 2) [px].
        dictionary: Name of the marker's dictionary.
        marker_id: Number of the marker in the dictionary.
        iterations: Largest number of Gauss-Newton steps.

    Returns:
        The marker with refined corners, whatever its score; None where under 8 pixels of a side or
        40 in all are left, the contrast is at most 1 grey level, the pixels do not determine the
        fit, or a corner coordinate moves by more than a quarter of the shortest side.
    """
    shrink = max(1, round(_longest_side(corners_px) / _USUAL_SIDE))
    patch = _Patch.around(grey, corners_px, shrink)
    if patch is None:
        return None
    start = patch.own(corners_px)
    fit, look = _Fit(start, blur=_first_blur(start)), None
    for _ in range(iterations):
        look = _look(fit, patch, dictionary, marker_id)
        if look is None:
            return None
        fit, moved = _improved(fit, look)
        if moved < 3e-3:
            break
    if look is None or np.abs(fit.corners - start).max() > 0.25 * _shortest_side(start):
        return None
    covariance = shrink**2 * (look.covariance(patch) + CORNER_FLOOR_PX**2 * np.eye(8))
    return Sighting(marker_id, patch.whole(fit.corners), covariance, look.score, shrink * fit.blur)


@dataclass(frozen=True)
class _Patch:
    """A window of the picture: its origin, pixels, downsampling factor and pixel coordinates.

    A marker of hundreds of pixels is downsampled: corners need no more than some dozens a side, and
    time grows with their square. It is averaged, not decimated: every second pixel of every second
    row falls on a quarter of the places in the 8 x 8 blocks of JPEG, whose errors there are the
    same in all blocks. They shift whole markers by 0.05 px in a dark, blurred picture, which no
    residual shows.
    """

    origin: Array
    values: Array
    shrink: int
    points: Array

    @classmethod
    def around(cls, grey: NDArray[np.uint8], corners_px: Array, shrink: int) -> "_Patch | None":
        """Crop a marker, a quarter of its size and 3 px around; None under 8 px wide or high."""
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
        row, column = np.indices((height, width))
        points = np.column_stack((column.ravel(), row.ravel())).astype(float)
        return cls(low.astype(float), np.asarray(values, dtype=float), shrink, points)

    def own(self, corners_px: Array) -> Array:
        """Convert coordinates in the picture to coordinates in the patch [px]."""
        return (corners_px - self.origin + 0.5) / self.shrink - 0.5

    def whole(self, corners: Array) -> Array:
        """Convert coordinates in the patch to coordinates in the picture [px]."""
        return (corners + 0.5) * self.shrink - 0.5 + self.origin


@dataclass(frozen=True)
class _Fit:
    """State of the Gauss-Newton iteration: corners in the patch [px] and blur [px]."""

    corners: Array
    blur: float


@dataclass(frozen=True)
class _Look:
    """Residual and Jacobian of a fit.

    Attributes:
        points: Column and row of the pixels compared in the patch, shape (n, 2) [px].
        design: Derivative of their modelled values by the 14 unknowns, shape (n, 14): x, y of four
            corners, blur, o, o_x, o_y, g, q of the module's docstring.
        inverse: Inverse of the normal equations' matrix, shape (14, 14).
        residual: Pixel values minus the fitted model, shape (n,) [grey levels].
        contrast: White minus black, g [grey levels].
        score: Correlation with the marker inside its black border; 0 below 16 pixels [-].
    """

    points: Array
    design: Array
    inverse: Array
    residual: Array
    contrast: float
    score: float

    def covariance(self, patch: _Patch) -> Array:
        """Compute the covariance of the corners in the patch, shape (8, 8) [px²]."""
        return unknowns_covariance(
            self.points,
            self.design,
            self.inverse,
            self.residual,
            first=8,
            lags=max(2, round(_LAGS_PX / patch.shrink)),
        )


def _look(fit: _Fit, patch: _Patch, dictionary: str, marker_id: int) -> _Look | None:
    """Compute residual and Jacobian of a fit; None under 40 pixels, no contrast, or singular."""
    H = square_homography(fit.corners)
    own = apply_homography(np.linalg.inv(H), patch.points)
    used = np.flatnonzero(_is_used(own, fit, _cells(dictionary)))
    if len(used) < 40:
        return None
    points, own, values = patch.points[used], own[used], patch.values.ravel()[used]
    drawn = _draw(dictionary, marker_id, H, fit, patch.values.shape)
    tone = drawn.ravel()[used]
    # Each column of the Jacobian is contiguous in memory.
    design = np.empty((14, len(used)))
    design[9], design[10:12] = 1.0, (points - points.mean(axis=0)).T
    design[12], design[13] = tone, tone * (1 - tone)
    light = np.linalg.lstsq(design[9:] @ design[9:].T, design[9:] @ values, rcond=None)[0]
    contrast = light[3]
    if contrast <= 1.0:  # less than a grey level: no marker, or an inverted one
        return None
    steepness = contrast + light[4] * (1 - 2 * tone)
    design[:9] = steepness * _geometry_design(fit, H, drawn, used, own, points)
    inverse = _inverse_normal(design)
    if inverse is None:
        return None
    score = _likeness(own, values - light[:3] @ design[9:12], tone, dictionary)
    return _Look(points, design.T, inverse, values - light @ design[9:], contrast, score)


def _improved(fit: _Fit, look: _Look) -> tuple[_Fit, float]:
    """Take a Gauss-Newton step; return the fit and the largest change of a corner coordinate [px].

    Corners move by at most 0.1 of the shortest side, the blur by 0.5 px and within 0.3 to 8 px.
    """
    step = look.inverse[:9] @ (look.design.T @ look.residual)
    longest = float(np.abs(step[:8]).max())
    step[:8] *= min(1.0, 0.1 * _shortest_side(fit.corners) / max(longest, 1e-12))
    corners = fit.corners + step[:8].reshape(4, 2)
    blur = float(np.clip(fit.blur + np.clip(step[8], -0.5, 0.5), 0.3, 8.0))
    return _Fit(corners, blur), float(np.abs(step[:8]).max())


def _geometry_design(
    fit: _Fit, H: Array, drawn: Array, used: NDArray, own: Array, points: Array
) -> Array:
    """Compute the Jacobian of drawn pixels by the eight corner coordinates and the blur, (9, n).

    For white minus black of 1. H maps `own`, in the marker's unit square, to `points` in the patch.
    With p = (H own) / w, w the third component, a point of the marker moves with its corners by
    dp = (dH own - p (dH own)_3) / w, and what is drawn there by minus the slope times dp.
    """
    across, down = (
        np.asarray(cv2.filter2D(drawn, cv2.CV_64F, kernel)).ravel()[used]
        for kernel in (_SLOPE, _SLOPE.T)
    )
    x, y = points.T
    along = np.stack((-across, -down, across * x + down * y))
    along /= H[2, 0] * own[:, 0] + H[2, 1] * own[:, 1] + H[2, 2]
    by_H = np.empty((3, 3, len(used)))
    by_H[:, 0], by_H[:, 1], by_H[:, 2] = along * own[:, 0], along * own[:, 1], along
    design = np.empty((9, len(used)))
    design[:8] = _slopes_of_homography(fit.corners, H).reshape(9, 8).T @ by_H.reshape(9, -1)
    # d/ds of a Gaussian blur of s is s times the Laplacian (heat equation).
    design[8] = fit.blur * np.asarray(cv2.Laplacian(drawn, cv2.CV_64F)).ravel()[used]
    return design


def _slopes_of_homography(corners: Array, H: Array) -> Array:
    """Compute the derivative of the homography by x, y of the four corners, shape (3, 3, 8)."""
    step = 1e-4 * _shortest_side(corners)
    moved = square_homography(corners + step * _UNITS)
    return (np.moveaxis(moved, 0, -1) - H[:, :, None]) / step


def _inverse_normal(design: Array) -> Array | None:
    """Invert the normal equations' matrix of a design (14, n); None where it is singular."""
    normal = design @ design.T
    normal[8, 8] += 1e-3 * normal[8, 8] + 1e-9  # a sharp picture does not determine its blur
    try:
        return np.linalg.inv(normal + 1e-12 * np.trace(normal) * np.eye(len(normal)))
    except np.linalg.LinAlgError:
        return None


def _likeness(own: Array, values: Array, drawn: Array, dictionary: str) -> float:
    """Compute the correlation of values and drawn marker inside the black border [-].

    `own` are the pixels in the marker's unit square; 0 where fewer than 16 are inside.
    """
    # Only cells inside the black border distinguish markers: all have the border.
    inside = (np.abs(own - 0.5) < 0.5 - 1 / _cells(dictionary)).all(axis=1)
    if inside.sum() < 16:
        return 0.0
    a, b = values[inside] - values[inside].mean(), drawn[inside] - drawn[inside].mean()
    return float(a @ b / np.sqrt(max((a @ a) * (b @ b), 1e-12)))


def _is_used(own: Array, fit: _Fit, cells: int) -> NDArray[np.bool_]:
    """Return whether points can be compared with the model: on the marker, or close around it.

    Every print has a margin one cell wide; what lies beyond it is not known. The margin is used up
    to `_MARGIN` of the side, but not its outer `_BLURS_INSIDE` standard deviations of blur, which
    show some of what lies beyond. `own` (n, 2) are the points in the marker's unit square, `cells`
    the number of cells along its side.
    """
    blurred = _BLURS_INSIDE * fit.blur / _shortest_side(fit.corners)
    margin = np.clip(1 / cells - blurred, 0.0, _MARGIN)
    return (np.abs(own - 0.5) < 0.5 + margin).all(axis=1)


def _draw(dictionary: str, marker_id: int, H: Array, fit: _Fit, shape: tuple[int, ...]) -> Array:
    """Draw the marker for a fit in a patch of a shape, blurred, 0 black to 1 white."""
    cells = _cells(dictionary)
    n = 4
    # Half the resolution at which it is sampled where foreshortening is greatest: interpolation
    # then places an edge along a row of pixels, and not at the nearest sample.
    fine_px = n * _shortest_side(fit.corners) / cells
    cell_px = int(np.clip(2 ** np.floor(np.log2(fine_px / 2)), 4, 64))
    picture = marker_picture(dictionary, marker_id, cell_px)
    inner = cells * cell_px
    # From pixels of the picture to the unit square, whose corners are those of the border.
    own_from_drawn = np.array(
        [[1, 0, 0.5 - cell_px], [0, 1, 0.5 - cell_px], [0, 0, inner]], dtype=float
    ) / inner  # fmt: skip
    fine = np.array([[n, 0, (n - 1) / 2], [0, n, (n - 1) / 2], [0, 0, 1.0]])
    drawn = cv2.warpPerspective(
        picture, fine @ H @ own_from_drawn,
        (shape[1] * n, shape[0] * n), flags=cv2.INTER_LINEAR, borderValue=(1.0,)
    )  # fmt: skip
    drawn = cv2.resize(drawn, (shape[1], shape[0]), interpolation=cv2.INTER_AREA)
    return np.asarray(cv2.GaussianBlur(drawn.astype(float), (0, 0), fit.blur), dtype=float)


def _cells(dictionary: str) -> int:
    """Return the number of cells along a side of a marker, border included, margin not."""
    return marker_picture(dictionary, 0, 1).shape[0] - 2


def _first_blur(corners: Array) -> float:
    """Guess a blur to start from: 1/60 of the shortest side, within 0.6 to 2 px."""
    return float(np.clip(_shortest_side(corners) / 60, 0.6, 2.0))


def _sides(corners: Array) -> Array:
    """Compute the lengths of a quadrilateral's sides, shape (4,)."""
    return np.linalg.norm(corners - np.roll(corners, -1, axis=0), axis=1)


def _shortest_side(corners: Array) -> float:
    """Return the length of a quadrilateral's shortest side."""
    return float(_sides(corners).min())


def _longest_side(corners: Array) -> float:
    """Return the length of a quadrilateral's longest side."""
    return float(_sides(corners).max())
