# SPDX-License-Identifier: MIT
"""Read and format `camera.toml`: the lens, its standard deviations and its photographs."""

from collections.abc import Mapping
from pathlib import Path

import numpy as np

from model.arrays import Array
from tracking.camera import Camera, CameraCalibration
from zebro_lab.files.settings_table import SettingsTable, fill_in, read_settings

CAMERA_FILE = "camera.toml"
# Keys that are accepted, but not used.
_FOR_PEOPLE = ("lens_model", "rms_px", "corner_noise_px", "smooth_error_px", "coverage", "photos")
_SDS = (("focal_sd", 2), ("centre_sd", 2), ("distortion_sd", 5))
_PAIRS = np.triu_indices(9, 1)
_ROUNDED = 1e-4  # negative eigenvalue of correlations, by rounding


def read_camera_file(file: Path) -> Camera:
    """Read and validate the lens of a `camera.toml`: size, camera matrix, distortion, covariance.

    Distortion is zero if the file has none. The covariance is computed from the standard deviations
    and correlations in `[calibration]`: if it has no standard deviations, the covariance is zero;
    if it has no correlations, diagonal.

    Raises:
        NotFound: The file does not exist.
        SettingsError: The file is not TOML, or holds an unknown key or an impossible value.
    """
    table = read_settings(file, advice="`zebro-lab camera calibrate PHOTOS` writes one")
    if "markers" in table or "points" in table:
        raise table.fault("lists markers or points as a floor.toml does; expected a camera.toml: "
                          "are --camera and --floor exchanged?")  # fmt: skip
    fx, fy = table.quantities("focal", 2, "dimensionless")
    cx, cy = table.quantities("centre", 2, "dimensionless")
    if min(fx, fy) <= 0:
        raise table.fault(f"is {fx:g}, {fy:g} px; expected more than 0", "focal")
    matrix = np.array([[fx, 0.0, cx], [0.0, fy, cy], [0.0, 0.0, 1.0]])
    distortion = np.zeros(5)
    if "distortion" in table:
        distortion = np.array(table.quantities("distortion", 5, "dimensionless"))
    size = _size(table)
    fit = table.table("calibration")
    covariance = _covariance(fit)
    for key in _FOR_PEOPLE:
        if key in fit:
            fit.value(key)
    table.finish()
    return Camera(size, matrix, distortion, covariance)


def _covariance(fit: SettingsTable) -> Array:
    """Read the lens's covariance, shape (9, 9), from standard deviations and correlations.

    What the file does not state is 0. The order is fx, fy, cx, cy [px], k1, k2, p1, p2, k3 [-].

    Raises:
        SettingsError: A standard deviation is negative, or the correlations are impossible: not
            from -1 to 1, or with an eigenvalue below `-_ROUNDED`.
    """
    sd: list[float] = []
    for key, count in _SDS:
        values = fit.quantities(key, count, "dimensionless") if key in fit else count * (0.0,)
        if min(values) < 0:
            raise fit.fault(f"is {min(values):g}; expected standard deviations of 0 or more", key)
        sd += values
    correlation = np.eye(9)
    if "correlation" in fit:
        stated = np.array(fit.quantities("correlation", len(_PAIRS[0]), "dimensionless"))
        correlation[_PAIRS] = stated
        correlation = correlation + correlation.T - np.eye(9)
        smallest = float(np.linalg.eigvalsh(correlation)[0])
        if np.abs(stated).max() > 1 or smallest < -_ROUNDED:
            raise fit.fault(
                "are not correlations of nine numbers (upper triangle, row by row); expected those "
                "that `zebro-lab camera calibrate` writes, or none", "correlation",
            )  # fmt: skip
    return correlation * np.outer(sd, sd)


def _size(table: SettingsTable) -> tuple[int, int]:
    """Read width and height [px]; `SettingsError` unless both are whole numbers of 16 or more."""
    width, height = table.quantities("size", 2, "dimensionless")
    if min(width, height) < 16 or width % 1 or height % 1:
        raise table.fault(f"is {width:g} x {height:g} px; expected integers of at least 16", "size")
    return int(width), int(height)


def render_camera_file(fit: CameraCalibration, *, photos: Mapping[str, str]) -> str:
    """Format a calibration as commented TOML, from which `read_camera_file` reads the lens.

    Args:
        fit: The calibration.
        photos: SHA-256 of the photographs used in the calibration, by name.
    """
    camera, sd = fit.camera, fit.sd
    unit = np.where(sd > 0, sd, 1.0)  # a term that was left out has sd 0, and correlations of 0
    correlation = (camera.covariance / np.outer(unit, unit))[_PAIRS]
    return fill_in(_TEMPLATE, {
        "size": camera.size,
        "focal": [camera.matrix[0, 0], camera.matrix[1, 1]],
        "centre": [camera.matrix[0, 2], camera.matrix[1, 2]],
        "distortion": camera.distortion,
        "calibration": {
            "lens_model": fit.lens_model,
            "rms_px": round(fit.rms, 4),
            "corner_noise_px": round(fit.errors.noise, 4),
            "smooth_error_px": round(fit.errors.smooth, 4),
            "coverage": round(fit.coverage, 3),
            "focal_sd": sd[:2].round(4),
            "centre_sd": sd[2:4].round(4),
            "distortion_sd": sd[4:].round(7),
            "correlation": correlation.round(6),
            "photos": photos,
        },
    })  # fmt: skip


HEADING = "# The camera's lens, in pixels."
"""Begin of the file, by which it is recognised as written by `camera calibrate`."""
_TEMPLATE = (
    HEADING
    + """ The centre of the first pixel is (0, 0), as in OpenCV.
# Photographs of another size are used scaled, if they are not cropped.

size = []  # width, height
focal = []  # fx, fy
centre = []  # cx, cy
distortion = []  # k1, k2, p1, p2, k3 of OpenCV's lens model

[calibration]  # how well it is known; `track` reads standard deviations and correlations
lens_model = ""
rms_px = 0  # distance between corners seen and predicted
corner_noise_px = 0  # error of a corner alone, in x and in y
smooth_error_px = 0  # error that neighbouring corners of a photograph share, as of a bent board
coverage = 0  # share of the picture in which corners were seen
focal_sd = []  # standard deviations
centre_sd = []
distortion_sd = []
correlation = []  # of fx, fy, cx, cy, k1, k2, p1, p2, k3: each with those after it

[calibration.photos]  # SHA-256
"""
)
