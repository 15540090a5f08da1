# SPDX-License-Identifier: MIT
"""`camera.toml`: the lens, how well it is known, and from which photographs."""

from collections.abc import Mapping
from dataclasses import dataclass
from pathlib import Path

import numpy as np

from tracking.camera import Camera, CameraCalibration
from zebro_lab.files.toml_table import TomlTable, listed, quoted, read_toml, spelled

CAMERA_FILE = "camera.toml"
_TOP = ("size", "focal", "centre", "distortion", "calibration")
_CALIBRATION = (
    "lens_model", "rms_px", "focal_sd", "centre_sd", "distortion_sd", "coverage", "photos",
)  # fmt: skip


@dataclass(frozen=True)
class CameraFile:
    """What a `camera.toml` says.

    Attributes:
        camera: The lens.
        file: The file.
    """

    camera: Camera
    file: Path


def read_camera_file(file: Path) -> CameraFile:
    """Read and check a `camera.toml`.

    Raises:
        NotFound: There is no such file.
        SettingsError: It is no TOML, or holds an unknown key or an impossible value.
    """
    table = read_toml(file, advice="`zebro-lab camera calibrate PHOTOS` writes one")
    table.require_known(_TOP)
    table.table("calibration").require_known(_CALIBRATION)
    fx, fy = table.numbers("focal", 2)
    cx, cy = table.numbers("centre", 2)
    if min(fx, fy) <= 0:
        raise table.error("focal", f"is {fx:g}, {fy:g} px; expected more than 0")
    matrix = np.array([[fx, 0.0, cx], [0.0, fy, cy], [0.0, 0.0, 1.0]])
    distortion = np.array(table.numbers("distortion", 5)) if "distortion" in table else np.zeros(5)
    return CameraFile(Camera(_size(table), matrix, distortion), file)


def _size(table: TomlTable) -> tuple[int, int]:
    width, height = table.numbers("size", 2)
    if min(width, height) < 16 or width % 1 or height % 1:
        raise table.error("size", f"is {width:g} x {height:g} px; expected whole numbers of pixels")
    return int(width), int(height)


def render_camera_file(fit: CameraCalibration, *, photos: Mapping[str, str]) -> str:
    """Write a calibration as commented TOML that `read_camera_file` reads back.

    Args:
        fit: The calibration.
        photos: SHA-256 of the photographs it is from, by name.
    """
    camera, sd = fit.camera, fit.sd
    used = "".join(f'{quoted(name)} = "{digest}"\n' for name, digest in photos.items())
    return _TEMPLATE.format(
        size=list(camera.size),
        focal=listed([camera.matrix[0, 0], camera.matrix[1, 1]]),
        centre=listed([camera.matrix[0, 2], camera.matrix[1, 2]]),
        distortion=listed(camera.distortion),
        lens_model=fit.lens_model,
        rms=spelled(round(fit.rms, 4)),
        coverage=spelled(round(fit.coverage, 3)),
        focal_sd=listed(sd[:2].round(4)),
        centre_sd=listed(sd[2:4].round(4)),
        distortion_sd=listed(sd[4:].round(7)),
        photos=used,
    )


HEADING = "# The camera's lens, in pixels."
"""What the file begins with: by this it is known for what `camera calibrate` wrote."""
_TEMPLATE = (
    HEADING
    + """ The centre of the first pixel is (0, 0), as in OpenCV.
# Photographs of another size are used scaled, if they are not cropped.

size = {size}  # width, height
focal = {focal}  # fx, fy
centre = {centre}  # cx, cy
distortion = {distortion}  # k1, k2, p1, p2, k3 of OpenCV's lens model

[calibration]  # how well it is known: nothing reads this but people
lens_model = "{lens_model}"
rms_px = {rms}  # distance between corners seen and predicted
coverage = {coverage}  # share of the picture in which corners were seen
focal_sd = {focal_sd}  # standard deviations
centre_sd = {centre_sd}
distortion_sd = {distortion_sd}

[calibration.photos]  # SHA-256
{photos}"""
)
