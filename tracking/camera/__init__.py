# SPDX-License-Identifier: MIT
"""Camera model with lens distortion, camera pose, and calibration from pictures of a board."""

from tracking.camera.boards import Board, CharucoBoard, Checkerboard, SeenBoard, find_board
from tracking.camera.calibration import CameraCalibration, calibrate
from tracking.camera.lens import (
    Camera,
    CameraPose,
    project,
    project_with_derivatives,
    rays,
    to_floor,
    undistort,
)

__all__ = [
    "Board",
    "Camera",
    "CameraCalibration",
    "CameraPose",
    "CharucoBoard",
    "Checkerboard",
    "SeenBoard",
    "calibrate",
    "find_board",
    "project",
    "project_with_derivatives",
    "rays",
    "to_floor",
    "undistort",
]
