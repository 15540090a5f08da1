# SPDX-License-Identifier: MIT
"""The camera: its lens, where it stands, and how the lens is calibrated."""

from tracking.camera.boards import Board, BoardView, CharucoBoard, Checkerboard, find_board
from tracking.camera.calibration import Calibration, calibrate
from tracking.camera.lens import (
    Camera,
    CameraPose,
    plane_homography,
    project,
    project_with_derivatives,
    rays,
    to_floor,
    undistort,
)

__all__ = [
    "Board",
    "BoardView",
    "Calibration",
    "Camera",
    "CameraPose",
    "CharucoBoard",
    "Checkerboard",
    "calibrate",
    "find_board",
    "plane_homography",
    "project",
    "project_with_derivatives",
    "rays",
    "to_floor",
    "undistort",
]
