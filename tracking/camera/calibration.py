# SPDX-License-Identifier: MIT
"""Calibrate a camera from pictures of a board, with standard deviations of its parameters."""

from collections.abc import Sequence
from dataclasses import dataclass, replace
from typing import NamedTuple

import cv2
import numpy as np
from numpy.typing import ArrayLike, NDArray

from model.arrays import Array
from tracking.camera.boards import SeenBoard
from tracking.camera.corner_errors import CornerErrors, FittedBoard, corner_errors
from tracking.camera.lens import Camera, CameraPose, project, project_with_derivatives
from tracking.camera.omitted_terms import with_omitted_terms
from tracking.errors import CalibrationError

LENS_MODELS = {
    "none": cv2.CALIB_FIX_K1 | cv2.CALIB_FIX_K2 | cv2.CALIB_FIX_K3 | cv2.CALIB_ZERO_TANGENT_DIST,
    "k1": cv2.CALIB_FIX_K2 | cv2.CALIB_FIX_K3 | cv2.CALIB_ZERO_TANGENT_DIST,
    "k1-k2": cv2.CALIB_FIX_K3 | cv2.CALIB_ZERO_TANGENT_DIST,
    "full": 0,
}
"""Flags of OpenCV's calibration by name of the distortion model, simplest first."""

# Indices, of fx, fy, cx, cy, k1, k2, p1, p2, k3, that a model fits.
_FITTED = {"none": list(range(4)), "k1": list(range(5)), "k1-k2": list(range(6)),
           "full": list(range(9))}  # fmt: skip
_FOLDS, _AS_GOOD = 5, 1.01  # of cross-validation; largest ratio to the least mean square
_IMPROBABLE = 0.05  # probability that no term left out matters, below which more are fitted
_ALIKE, _LEAST_ALIKE = 3.0, 0.3  # smooth error over noise [-], and [px], that is worth a remark
_BLURRED = 0.5  # noise of a corner that is worth a remark [px]
_LONGEST_FOCAL = 100.0  # picture widths; the longest telephoto lenses have 30
_GRID = (8, 6)


@dataclass(frozen=True)
class CameraCalibration:
    """A calibrated camera with standard deviations, residuals and coverage.

    Attributes:
        camera: Camera intrinsics and distortion with their covariance, in which terms that were
            not fitted have a variance too, unless the model was named.
        lens_model: Distortion model that was fitted, a key of `LENS_MODELS`.
        errors: Errors of corners, alone and alike in a photograph.
        rms: Root mean square distance between corners detected and predicted [px].
        view_names: Names of the pictures used.
        view_rms: Root mean square distance of corners in each picture, shape (views,) [px].
        coverage: Share of the cells of `seen` with at least one corner, 0 to 1 [-].
        seen: Number of corners, of all pictures, in each cell of a grid over the picture, 8
            columns and 6 rows, shape (6, 8), first row on top.
    """

    camera: Camera
    lens_model: str
    errors: CornerErrors
    rms: float
    view_names: tuple[str, ...]
    view_rms: Array
    coverage: float
    seen: NDArray[np.int64]

    @property
    def sd(self) -> Array:
        """Standard deviations of fx, fy, cx, cy [px], k1, k2, p1, p2, k3 [-], shape (9,)."""
        return np.sqrt(np.diag(self.camera.covariance))

    @property
    def warnings(self) -> tuple[str, ...]:
        """Warnings, one sentence each.

        Coverage below 0.6; fewer than 10 pictures; pictures of over 3 times the median residual;
        an error alike in neighbouring corners of over 0.3 px and 3 times a corner's own error; and
        an own error of over 0.5 px.
        """
        return tuple(_warnings(self))


def calibrate(
    views: Sequence[SeenBoard], size: tuple[int, int], *, lens_model: str = "auto"
) -> CameraCalibration:
    """Calibrate a camera by least squares on the corners of a board in several pictures.

    Args:
        views: Corners of one board in several pictures, tilted differently.
        size: Width and height of the pictures [px].
        lens_model: A key of `LENS_MODELS`, whose terms alone are taken to differ from zero, or
            "auto": the simplest that predicts left-out pictures as well as the best, within 1 % of
            the mean squared distance, unless all pictures show that other terms matter.

    Returns:
        Camera intrinsics and distortion, their standard deviations, residuals and coverage.

    Raises:
        CalibrationError: When there are fewer than 3 views, `lens_model` is unknown, OpenCV fails
            for a model tried, the standard deviation of the focal length is 0, not finite, or
            5 % of it or more, or the focal length is over 100 widths of the picture.
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
    chosen = names[0] if len(names) == 1 else _best_of_left_out(views, size, names)
    fit = _fit(views, size, chosen)
    _check_determined(fit)
    if chosen == names[-1]:
        return fit
    general, richer = _fit(views, size, names[-1]), names[names.index(chosen) + 1 :]
    unsure = _unsure_of_terms(fit, general)
    while unsure is None:
        fit, richer = _fit(views, size, richer[0]), richer[1:]
        unsure = _unsure_of_terms(fit, general)
    _check_determined(unsure)
    return unsure


def _unsure_of_terms(
    fit: CameraCalibration, general: CameraCalibration
) -> CameraCalibration | None:
    """Add to a fit's covariance what the distortion terms that it leaves out may change.

    Args:
        fit: Fit of a simpler lens model.
        general: Fit of all terms, which tells how large those left out may be.

    Returns:
        The fit with the larger covariance; None where the probability that no term left out
        matters is below `_IMPROBABLE`, so that a model with more terms must be fitted.
    """
    covariance, none_matters = with_omitted_terms(
        _parameters(fit), fit.camera.covariance, _FITTED[fit.lens_model],
        _parameters(general), general.camera.covariance,
    )  # fmt: skip
    if none_matters < _IMPROBABLE:
        return None
    return replace(fit, camera=replace(fit.camera, covariance=covariance))


def _parameters(fit: CameraCalibration) -> Array:
    """Return fx, fy, cx, cy, k1, k2, p1, p2, k3, shape (9,)."""
    return np.array([*fit.camera.matrix[[0, 1, 0, 1], [0, 1, 2, 2]], *fit.camera.distortion])


def _best_of_left_out(
    views: Sequence[SeenBoard], size: tuple[int, int], names: Sequence[str]
) -> str:
    """Return the simplest lens model that predicts left-out pictures as the best one, within 1 %.

    Of a picture that was left out only the pose of the board is fitted; compared is the mean
    squared distance of its corners, which a term too many raises by less than 1 %.
    """
    missed = [_left_out(views, size, name) for name in names]
    return next(
        name for name, each in zip(names, missed, strict=True) if each <= _AS_GOOD * min(missed)
    )


def _left_out(views: Sequence[SeenBoard], size: tuple[int, int], lens_model: str) -> float:
    """Compute the mean squared distance of corners from their projection by cross-validation [px²].

    Pictures are split into `_FOLDS` parts; each part is predicted by the lens fitted to the others.
    """
    missed = np.empty(len(views))
    fold = np.arange(len(views)) % min(_FOLDS, len(views))
    for number in np.unique(fold):
        others = [view for view, of in zip(views, fold, strict=True) if of != number]
        camera = _calibrated(others, size, lens_model).camera
        for k in np.flatnonzero(fold == number).tolist():
            view = views[k]
            _, turn, shift = cv2.solvePnP(
                view.points, view.corners_px, camera.matrix, camera.distortion
            )
            pose = CameraPose(_vector(turn), _vector(shift), np.zeros((6, 6)))
            residual = view.corners_px - project(camera, pose, view.points)
            missed[k] = np.sum(residual**2, axis=1).mean()
    return float(missed.mean())


class _Calibrated(NamedTuple):
    """A lens without covariance, rotations (3,) and translations (3,) of boards, misfits [px]."""

    camera: Camera
    turns: list[Array]
    shifts: list[Array]
    rms: float
    per_view: Array


def _calibrated(views: Sequence[SeenBoard], size: tuple[int, int], lens_model: str) -> _Calibrated:
    """Fit lens and poses of the board by OpenCV's unweighted least squares.

    Raises:
        CalibrationError: OpenCV fails.
    """
    points = [view.points.astype(np.float32) for view in views]
    corners = [view.corners_px.astype(np.float32) for view in views]
    try:
        rms, matrix, distortion, turns, shifts, _, _, per_view = cv2.calibrateCameraExtended(
            points, corners, size, np.eye(3), np.zeros(5), flags=LENS_MODELS[lens_model]
        )
    except cv2.error as error:
        raise CalibrationError(
            f"OpenCV could not calibrate from {len(views)} pictures ({error.err}); take pictures "
            f"in which the board is tilted by 20 to 45 degrees, each time another way"
        ) from error
    camera = Camera(size, np.asarray(matrix, dtype=float), np.ravel(distortion)[:5].astype(float))
    return _Calibrated(
        camera, [_vector(turn) for turn in turns], [_vector(shift) for shift in shifts],
        float(rms), _vector(per_view),
    )  # fmt: skip


def _vector(found: ArrayLike) -> Array:
    """Return OpenCV's column of numbers as a vector of floats."""
    return np.asarray(found, dtype=float).ravel()


def _fit(views: Sequence[SeenBoard], size: tuple[int, int], lens_model: str) -> CameraCalibration:
    """Fit a lens model to all pictures, with the covariance that correlated corners give."""
    found, fitted = _calibrated(views, size, lens_model), _FITTED[lens_model]
    errors = corner_errors([
        _compared(view, found.camera, turn, shift, fitted)
        for view, turn, shift in zip(views, found.turns, found.shifts, strict=True)
    ])  # fmt: skip
    covariance = np.zeros((9, 9))
    covariance[np.ix_(fitted, fitted)] = errors.covariance
    seen = _corners_seen(views, size)
    return CameraCalibration(
        replace(found.camera, covariance=covariance),
        lens_model,
        errors,
        found.rms,
        tuple(view.name for view in views),
        found.per_view,
        float((seen > 0).mean()),
        seen,
    )


def _compared(
    view: SeenBoard, camera: Camera, turn: Array, shift: Array, fitted: list[int]
) -> FittedBoard:
    """Compare a board with the fitted lens and pose, with derivatives by pose and `fitted`."""
    pose = CameraPose(turn, shift, np.zeros((6, 6)))
    seen = project_with_derivatives(camera, pose, view.points)
    return FittedBoard(
        view.points[:, :2], view.corners_px - seen.pixels, seen.by_pose, seen.by_lens[:, :, fitted]
    )


def _corners_seen(views: Sequence[SeenBoard], size: tuple[int, int]) -> NDArray[np.int64]:
    """Count the corners of all pictures in each cell of `_GRID`, shape (6, 8)."""
    corners = np.concatenate([view.corners_px for view in views]) + 0.5
    edges = [np.linspace(0, length, cells + 1) for length, cells in zip(size, _GRID, strict=True)]
    counts, _, _ = np.histogram2d(corners[:, 0], corners[:, 1], bins=edges)
    return counts.T.astype(np.int64)


def _check_determined(fit: CameraCalibration) -> None:
    """Raise `CalibrationError` for a focal length not known to 5 %, or an impossible one."""
    focal, sd = fit.camera.matrix[0, 0], fit.sd[0]
    tilted = "photograph the board tilted by 20 to 45 degrees, each another way"
    if not np.isfinite(fit.camera.matrix).all() or not 0 < sd < 0.05 * focal:
        raise CalibrationError(
            f"focal length {focal:.0f} px has a standard deviation of {sd:.3g} px, expected over 0 "
            f"and below 5 %; {tilted}"
        )
    width = fit.camera.size[0]
    if not focal < _LONGEST_FOCAL * width:
        raise CalibrationError(
            f"focal length {focal:.3g} px is {focal / width:.3g} times the width of the picture, "
            f"expected below {_LONGEST_FOCAL:g}; {tilted}"
        )


def _warnings(fit: CameraCalibration) -> list[str]:
    """List the warnings of `CameraCalibration.warnings`."""
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
    noise, smooth = fit.errors.noise, fit.errors.smooth
    if smooth > max(_ALIKE * noise, _LEAST_ALIKE):
        messages.append(
            f"neighbouring corners are off alike by {smooth:.2f} px, a corner alone by {noise:.2f}"
            " px: the board is not flat, the focus changed, or the camera moved in the exposure. "
            "The standard deviations include it; for a better known lens glue the board to a flat "
            "plate, fix the focus, and photograph it again"
        )
    if noise > _BLURRED:
        messages.append(
            f"corners are off by {noise:.2f} px each, expected below {_BLURRED:g} px: photographs "
            "are blurred or noisy; use more light, and keep camera and board still"
        )
    return messages
