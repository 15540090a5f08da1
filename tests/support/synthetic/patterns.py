# SPDX-License-Identifier: MIT
"""Printed patterns as small grids of albedo: each cell is flat, its edges infinitely sharp.

A grid has its top row first, as an image has. Albedo is the share of light a surface returns, in
[0, 1].
"""

import cv2
import numpy as np
from numpy.typing import NDArray

Grid = NDArray[np.float32]

INK, PAPER = 0.04, 0.88  # albedo of print [-]
FLOOR_TEXTURE_SIDE = 4.0  # what `floor_texture` covers before it repeats [m]

_CHARUCO_CELLS = 8  # cells a square: a 4x4 marker with its border is 6, with a margin of 1


def marker_cells(marker_id: int, *, dictionary: str = "DICT_4X4_50", quiet: int = 1) -> Grid:
    """Draw a square marker, one cell a bit.

    Args:
        marker_id: Its number in the dictionary.
        dictionary: Name of a dictionary in `cv2.aruco`.
        quiet: Width of the white border around the black one [cells].

    Returns:
        Albedo, shape (n, n).

    Raises:
        ValueError: There is no such dictionary, or no such marker in it.

    >>> marker_cells(0).shape
    (8, 8)
    """
    known = _dictionary(dictionary)
    if not 0 <= marker_id < len(known.bytesList):
        raise ValueError(
            f"marker {marker_id} is not in {dictionary}; expected 0 to {len(known.bytesList) - 1}"
        )
    bits = cv2.aruco.generateImageMarker(known, marker_id, known.markerSize + 2)
    return np.pad(_printed(bits), quiet, constant_values=PAPER)


def checkerboard_cells(columns: int, rows: int, *, quiet: int = 1) -> Grid:
    """Draw a checkerboard, one cell a square, with a white border.

    Args:
        columns: Squares across; inner corners are one fewer.
        rows: Squares down.
        quiet: Width of the border [squares].

    Returns:
        Albedo, shape (rows + 2 quiet, columns + 2 quiet).
    """
    white = np.indices((rows, columns)).sum(axis=0) % 2
    return np.pad(_printed(white), quiet, constant_values=PAPER)


def charuco_cells(columns: int, rows: int, *, dictionary: str = "DICT_4X4_50") -> Grid:
    """Draw a ChArUco board: a checkerboard with a marker in each white square.

    The markers' side is 3/4 of the squares'. Corners and numbers are those of
    `cv2.aruco.CharucoBoard((columns, rows), square, 0.75 * square, dictionary)`.

    Args:
        columns: Squares across.
        rows: Squares down.
        dictionary: Name of a dictionary of 4x4 markers in `cv2.aruco`.

    Returns:
        Albedo, shape (8 rows, 8 columns).
    """
    n = _CHARUCO_CELLS
    board = np.full((rows * n, columns * n), np.float32(PAPER))
    next_id = 0
    for row in range(rows):
        for column in range(columns):
            square = board[row * n : (row + 1) * n, column * n : (column + 1) * n]
            if (row + column) % 2 == 0:
                square[:] = INK
            else:
                square[1:-1, 1:-1] = marker_cells(next_id, dictionary=dictionary, quiet=0)
                next_id += 1
    return board


def plate_cells(rng: np.random.Generator, *, cells: int = 34, parts: int = 18) -> Grid:
    """Draw a top plate with electronics on it, by which a robot without a marker is tracked.

    Args:
        rng: Random numbers for the places of the parts.
        cells: Cells across and down.
        parts: Rectangular parts on the plate.

    Returns:
        Albedo in blue, green and red, shape (cells, cells, 3).
    """
    plate = np.full((cells, cells, 3), (0.42, 0.45, 0.44), dtype=np.float32)
    for _ in range(parts):
        top, left = rng.integers(1, cells - 4, 2)
        height, width = rng.integers(2, cells // 3, 2)
        colour = rng.choice([0.06, 0.2, 0.7, 0.85]) * rng.uniform(0.6, 1.0, 3)
        plate[top : min(top + height, cells - 1), left : min(left + width, cells - 1)] = colour
    return plate


def floor_texture(rng: np.random.Generator, *, size: int = 1024) -> Grid:
    """Draw a speckled floor that repeats without a seam every `FLOOR_TEXTURE_SIDE`.

    Args:
        rng: Random numbers for the speckles.
        size: Samples along each side.

    Returns:
        Albedo in blue, green and red, shape (size, size, 3).
    """
    shade = np.zeros((size, size), dtype=np.float32)
    for octave, weight in ((2, 0.4), (8, 0.3), (32, 0.3), (128, 0.5), (512, 0.7)):
        grain = rng.normal(size=(octave, octave)).astype(np.float32)
        wrapped = np.pad(grain, 2, mode="wrap")
        scale = size // octave
        smooth = cv2.resize(wrapped, None, fx=scale, fy=scale, interpolation=cv2.INTER_CUBIC)
        shade += weight * smooth[2 * scale : -2 * scale, 2 * scale : -2 * scale]
    tint = np.array((0.42, 0.50, 0.56), dtype=np.float32)
    return np.clip((1 + 0.1 * shade)[..., None] * tint, 0.0, 1.0)


def look_up(grid: Grid, across: NDArray, down: NDArray) -> Grid:
    """Look up the cell under each point (nearest neighbour).

    Args:
        grid: Albedo, shape (rows, columns) or (rows, columns, 3).
        across: From the left edge (0) to the right edge (1), any shape.
        down: From the top edge (0) to the bottom edge (1), the same shape.

    Returns:
        Albedo in blue, green and red, the points' shape and a last axis of 3.
    """
    rows, columns = grid.shape[:2]
    row = np.clip((down * rows).astype(np.intp), 0, rows - 1)
    column = np.clip((across * columns).astype(np.intp), 0, columns - 1)
    found = grid[row, column]
    return found if grid.ndim == 3 else np.repeat(found[..., None], 3, axis=-1)


def _printed(white: NDArray) -> Grid:
    return np.where(white > 0, PAPER, INK).astype(np.float32)


def _dictionary(name: str) -> cv2.aruco.Dictionary:
    number = getattr(cv2.aruco, name, None) if name.startswith("DICT_") else None
    if number is None:
        raise ValueError(f"no dictionary {name!r} in cv2.aruco; expected one such as DICT_4X4_50")
    return cv2.aruco.getPredefinedDictionary(number)
