# SPDX-License-Identifier: MIT
"""Calibrate a camera from pictures of a board, with standard deviations of its parameters."""

import math
from collections.abc import Sequence
from dataclasses import dataclass

import cv2
import numpy as np
from numpy.typing import NDArray

from tracking.camera.boards import SeenBoard
from tracking.camera.lens import Array, Camera
from tracking.errors import CalibrationError

LENS_MODELS = {
    "none": cv2.CALIB_FIX_K1 | cv2.CALIB_FIX_K2 | cv2.CALIB_FIX_K3 | cv2.CALIB_ZERO_TANGENT_DIST,
    "k1": cv2.CALIB_FIX_K2 | cv2.CALIB_FIX_K3 | cv2.CALIB_ZERO_TANGENT_DIST,
    "k1-k2": cv2.CALIB_FIX_K3 | cv2.CALIB_ZERO_TANGENT_DIST,
    "full": 0,
}
"""Flags of OpenCV's calibration by name of the distortion model, simplest first."""

_FREE_TERMS = {"none": 0, "k1": 1, "k1-k2": 2, "full": 5}
_GRID = (8, 6)


@dataclass(frozen=True)
class CameraCalibration:
    """A calibrated camera with standard deviations, residuals and coverage.

    Attributes:
        camera: Camera intrinsics and distortion.
        lens_model: Distortion model that was fitted, a key of `LENS_MODELS`.
        sd: Standard deviations of fx, fy, cx, cy [px], k1, k2, p1, p2, k3 [-], shape (9,); zero
            where a term was not fitted.
        rms: Root mean square distance between corners detected and predicted [px].
        view_names: Names of the pictures used.
        view_rms: Root mean square distance of corners in each picture, shape (views,) [px].
        coverage: Share of the cells of `seen` with at least one corner, 0 to 1 [-].
        seen: Number of corners, of all pictures, in each cell of a grid over the picture, 8
            columns and 6 rows, shape (6, 8), first row on top.
    """

    camera: Camera
    lens_model: str
    sd: Array
    rms: float
    view_names: tuple[str, ...]
    view_rms: Array
    coverage: float
    seen: NDArray[np.int64]

    @property
    def warnings(self) -> tuple[str, ...]:
        """Warnings, one sentence each.

        Coverage below 0.6, fewer than 10 pictures, pictures of over 3 times the median residual.
        """
        return tuple(_warnings(self))


def calibrate(
    views: Sequence[SeenBoard], size: tuple[int, int], *, lens_model: str = "auto"
) -> CameraCalibration:
    """Calibrate a camera by least squares on the corners of a board in several pictures.

    Args:
        views: Corners of one board in several pictures, tilted differently.
        size: Width and height of the pictures [px].
        lens_model: A key of `LENS_MODELS`, or "auto": the one with the least Bayesian information
            criterion (BIC), against overfitting of the distortion.

    Returns:
        Camera intrinsics and distortion, their standard deviations, residuals and coverage.

    Raises:
        CalibrationError: When there are fewer than 3 views, `lens_model` is unknown, OpenCV fails
            for a model tried, or the standard deviation of the focal length is 0, not finite, or
            5 % of it or more.
    """
    if len(views) < 3:
        raise CalibrationError(
            f"the board was found in {len(views)} pictures; at least 3 are needed and 10 to 15 "
            f"advised, with the board tilted differently in each"
        )
    names = tuple(LENS_MODELS) if lens_model == "auto" else (lens_model,)
    if not set(names) <= set(LENS_MODELS):
        raise CalibrationError(
            f"lens model '{lens_model}' is unknown; choose from auto, {', '.join(LENS_MODELS)}"
        )
    fits = [_fit(views, size, name) for name in names]
    best = min(fits, key=lambda fit: _information(fit, views))
    _check_determined(best)
    return best


def _fit(views: Sequence[SeenBoard], size: tuple[int, int], lens_model: str) -> CameraCalibration:
    points = [view.points.astype(np.float32) for view in views]
    corners = [view.corners_px.astype(np.float32) for view in views]
    try:
        rms, matrix, distortion, _, _, sd, _, per_view = cv2.calibrateCameraExtended(
            points, corners, size, np.eye(3), np.zeros(5), flags=LENS_MODELS[lens_model]
        )
    except cv2.error as error:
        raise CalibrationError(
            f"OpenCV could not calibrate from {len(views)} pictures ({error.err}); take pictures "
            f"in which the board is tilted by 20 to 45 degrees, each time another way"
        ) from error
    camera = Camera(size, np.asarray(matrix, dtype=float), np.ravel(distortion)[:5].astype(float))
    seen = _corners_seen(views, size)
    return CameraCalibration(
        camera,
        lens_model,
        np.ravel(sd)[:9].astype(float),
        float(rms),
        tuple(view.name for view in views),
        np.ravel(per_view).astype(float),
        float((seen > 0).mean()),
        seen,
    )


def _information(fit: CameraCalibration, views: Sequence[SeenBoard]) -> float:
    # Bayesian information criterion; the poses of the views are parameters of all models alike.
    numbers = 2 * sum(len(view.points) for view in views)
    return numbers * math.log(fit.rms**2) + _FREE_TERMS[fit.lens_model] * math.log(numbers)


def _corners_seen(views: Sequence[SeenBoard], size: tuple[int, int]) -> NDArray[np.int64]:
    corners = np.concatenate([view.corners_px for view in views]) + 0.5
    edges = [np.linspace(0, length, cells + 1) for length, cells in zip(size, _GRID, strict=True)]
    counts, _, _ = np.histogram2d(corners[:, 0], corners[:, 1], bins=edges)
    return counts.T.astype(np.int64)


def _check_determined(fit: CameraCalibration) -> None:
    focal, sd = fit.camera.matrix[0, 0], fit.sd[0]
    if not np.isfinite(fit.camera.matrix).all() or not 0 < sd < 0.05 * focal:
        raise CalibrationError(
            f"focal length {focal:.0f} px has a standard deviation of {sd:.3g} px, expected over 0 "
            f"and below 5 %; photograph the board tilted by 20 to 45 degrees, each another way"
        )


def _warnings(fit: CameraCalibration) -> list[str]:
    messages = []
    if fit.coverage < 0.6:
        messages.append(
            f"corners cover {fit.coverage:.0%} of the picture, expected 60% or more; distortion is "
            f"extrapolated elsewhere: photograph the board near the picture's edges and corners too"
        )
    if len(fit.view_names) < 10:
        messages.append(f"{len(fit.view_names)} photographs are used; 10 to 15 are advised")
    limit = 3 * float(np.median(fit.view_rms))
    messages += [
        f"{name}: corners are off by {rms:.2f} px (rms), more than three times the median of all "
        f"photographs; remove it if the board is blurred, bent or covered, and calibrate again"
        for name, rms in zip(fit.view_names, fit.view_rms, strict=True)
        if rms > limit
    ]
    return messages
