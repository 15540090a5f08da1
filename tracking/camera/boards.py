# SPDX-License-Identifier: MIT
"""Calibration boards (checkerboard, ChArUco) and detection of their corners."""

from dataclasses import dataclass
from typing import TypeAlias

import cv2
import numpy as np
from numpy.typing import NDArray

from model.arrays import Array
from tracking.markers.dictionaries import dictionary_named


@dataclass(frozen=True)
class Checkerboard:
    """A plain checkerboard.

    Attributes:
        columns: Number of inner corners along a row (squares minus 1).
        rows: Number of inner corners along a column (squares minus 1).
        square: Side of a square [m].
    """

    columns: int
    rows: int
    square: float


@dataclass(frozen=True)
class CharucoBoard:
    """A checkerboard with a marker in every white square; part of it in a picture suffices.

    Attributes:
        columns: Number of squares along a row.
        rows: Number of squares along a column.
        square: Side of a square [m].
        marker: Side of a marker [m].
        dictionary: Name of the markers' dictionary, such as "4x4_50".
        legacy: Pattern of OpenCV before 4.6, which starts with a white square where `rows` is even.
    """

    columns: int
    rows: int
    square: float
    marker: float
    dictionary: str
    legacy: bool = False


Board: TypeAlias = Checkerboard | CharucoBoard


@dataclass(frozen=True)
class SeenBoard:
    """Corners of a calibration board detected in one picture.

    Attributes:
        name: Name of the picture.
        points: Positions of the inner corners on the board, shape (n, 3), z = 0 [m].
        corners_px: Pixels of the same corners in the picture, shape (n, 2) [px].
    """

    name: str
    points: Array
    corners_px: Array


def find_board(
    pixels: NDArray[np.uint8], board: Board, *, name: str = "", quick: bool = False
) -> SeenBoard | None:
    """Detect a calibration board's inner corners with subpixel accuracy.

    Args:
        pixels: The picture, grey or BGR, shape (height, width) or (height, width, 3).
        board: The board.
        name: Name of the picture, for the report.
        quick: Leave out the slow search for checkerboards that are blurred or small; it also finds
            parts of larger boards.

    Returns:
        The corners detected; None where a checkerboard is not detected whole, or fewer than 6
        corners of a ChArUco board are.

    Raises:
        MarkerError: When the dictionary that a ChArUco board names is unknown.
    """
    grey = cv2.cvtColor(pixels, cv2.COLOR_BGR2GRAY) if pixels.ndim == 3 else pixels
    if isinstance(board, Checkerboard):
        return _find_checkerboard(grey, board, name, quick=quick)
    return _find_charuco(grey, board, name)


def _find_checkerboard(
    grey: NDArray, board: Checkerboard, name: str, *, quick: bool
) -> SeenBoard | None:
    """Detect all corners of a checkerboard, in rows; None where not all are found."""
    shape = (board.columns, board.rows)
    found, corners = cv2.findChessboardCorners(grey, shape)
    if not found:
        if quick:
            return None
        # Slower, but it sees boards that are blurred or small.
        found, corners = cv2.findChessboardCornersSB(grey, shape, flags=cv2.CALIB_CB_EXHAUSTIVE)
        if not found:
            return None
    corners_px = np.asarray(corners, dtype=np.float32).reshape(-1, 1, 2)
    reach = _refinement_reach(corners_px.reshape(board.rows, board.columns, 2))
    stop = (cv2.TERM_CRITERIA_EPS + cv2.TERM_CRITERIA_COUNT, 100, 1e-4)
    corners_px = cv2.cornerSubPix(grey, corners_px, (reach, reach), (-1, -1), stop)
    row, column = np.divmod(np.arange(board.rows * board.columns), board.columns)
    points = np.column_stack((column, row, np.zeros(len(row)))) * board.square
    return SeenBoard(name, points, np.asarray(corners_px, dtype=float).reshape(-1, 2))


def _refinement_reach(grid: NDArray) -> int:
    """Compute half the window of subpixel refinement for corners (rows, columns, 2) [px].

    It is 0.4 of the least distance between neighbours, within 2 to 11: as wide as possible without
    a neighbour's edges under any perspective in which a board can be detected.
    """
    steps = [np.linalg.norm(np.diff(grid, axis=axis), axis=2).min() for axis in (0, 1)]
    return int(np.clip(0.4 * min(steps), 2, 11))


def _find_charuco(grey: NDArray, board: CharucoBoard, name: str) -> SeenBoard | None:
    """Detect corners of a ChArUco board by its markers; None where fewer than 6 are found."""
    target = cv2.aruco.CharucoBoard(
        (board.columns, board.rows), board.square, board.marker, dictionary_named(board.dictionary)
    )
    target.setLegacyPattern(board.legacy)
    corners, ids, _, _ = cv2.aruco.CharucoDetector(target).detectBoard(grey)
    if ids is None or len(ids) < 6:
        return None
    points = np.array(target.getChessboardCorners(), dtype=float)[np.array(ids, dtype=int).ravel()]
    return SeenBoard(name, points, np.asarray(corners, dtype=float).reshape(-1, 2))
