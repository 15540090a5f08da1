# SPDX-License-Identifier: MIT
"""Lay out the printed tracking kit, to scale: markers, calibration board, ruler, instructions.

Pages are lists of shapes in millimetres from the lower left corner of the paper. A marker is drawn
cell by cell, so that nothing is resampled before it is printed.
"""

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from tracking.camera import Board, CharucoBoard
from tracking.floor import FloorMap, FloorMarker
from tracking.markers import marker_picture
from zebro_lab.files.errors import SettingsError
from zebro_lab.robot.marker_print import KIT_PRINT
from zebro_lab.track.floor_file import DICTIONARY

PAPERS = {"a4": (210.0, 297.0), "letter": (215.9, 279.4)}
"""Width and height of papers by name [mm]."""

FLOOR_MARKERS = (10, 11, 12, 13)
FLOOR_SIDE = 150.0
"""Side of the black square of the floor's markers [mm]."""

# Not the markers' dictionary, so that a board left in the picture is not taken for the floor.
BOARD = CharucoBoard(7, 5, 0.035, 0.026, "5x5_50")
"""The board that the kit prints and `camera calibrate` expects by default."""

_BAR = 100.0
_EDGE, _FOOT = 8.0, 19.0  # left free beside and below a board [mm]


@dataclass(frozen=True)
class Rectangle:
    """Black rectangle on a page, measured from the page's lower left corner.

    Attributes:
        x: Left edge [mm].
        y: Lower edge [mm].
        width: Width [mm].
        height: Height [mm].
    """

    x: float
    y: float
    width: float
    height: float


@dataclass(frozen=True)
class Text:
    """Line of text on a page, measured from the page's lower left corner.

    Attributes:
        x: Left end of the line, or its middle if centred [mm].
        y: Base line of the text [mm].
        text: The text.
        size: Font size [pt].
        centred: Whether `x` is the middle of the line.
    """

    x: float
    y: float
    text: str
    size: float = 10.0
    centred: bool = False


@dataclass(frozen=True)
class KitPage:
    """Page of the kit.

    Attributes:
        width: Width of the paper [mm].
        height: Height of the paper [mm].
        rectangles: Black rectangles on the page.
        texts: Lines of text on the page.
    """

    width: float
    height: float
    rectangles: tuple[Rectangle, ...]
    texts: tuple[Text, ...]


def kit_pages(paper: str = "a4", board: Board = BOARD) -> tuple[KitPage, ...]:
    """Lay out the pages: instructions with ruler, robot's marker, four floor markers, board.

    Args:
        paper: Size of the paper, a key of `PAPERS`; the board's page is landscape.
        board: Calibration board of the last page.

    Raises:
        SettingsError: The paper is unknown, or the board does not fit on it.
    """
    if paper not in PAPERS:
        raise SettingsError(f"'{paper}' is unknown; expected {' or '.join(PAPERS)}", key="--paper")
    size = PAPERS[paper]
    return (
        _instructions(size),
        _marker_page(size, KIT_PRINT.number, 1e3 * KIT_PRINT.side,
                     f"Robot: {DICTIONARY}, number {KIT_PRINT.number}",
                     "↑ ahead: this edge towards the robot's head"),
        *(_marker_page(size, number, FLOOR_SIDE, f"Floor: {DICTIONARY}, number {number}",
                       "x →   (yaw_deg = 0 where this arrow points along x)")
          for number in FLOOR_MARKERS),
        _board_page((size[1], size[0]), board),
    )  # fmt: skip


def starter_floor() -> FloorMap:
    """Return the four floor markers in a 2 m square, a suggestion to replace by measured places."""
    places = ((0.0, -0.5), (2.0, -0.5), (2.0, 1.5), (0.0, 1.5))
    markers = tuple(
        FloorMarker(number, FLOOR_SIDE / 1e3, x, y)
        for number, (x, y) in zip(FLOOR_MARKERS, places, strict=True)
    )
    return FloorMap(DICTIONARY, markers)


def marker_rectangles(
    dictionary: str, number: int, side: float, *, left: float, bottom: float
) -> tuple[Rectangle, ...]:
    """Compute a marker's black cells as rectangles, one for each run in rows and in columns.

    Args:
        dictionary: Name of the marker's dictionary, such as "4x4_50".
        number: Number of the marker in the dictionary.
        side: Side of the marker's black square [mm].
        left: Left edge of the black square [mm].
        bottom: Lower edge of the black square [mm].
    """
    black = marker_picture(dictionary, number, 1)[1:-1, 1:-1] < 0.5
    cell = side / len(black)
    # Rows and columns both: rows alone leave hairlines between them.
    across = [
        Rectangle(left + start * cell, bottom + side - (row + 1) * cell, count * cell, cell)
        for row, cells in enumerate(black)
        for start, count in _runs(cells)
    ]
    down = [
        Rectangle(left + column * cell, bottom + side - (start + count) * cell, cell, count * cell)
        for column, cells in enumerate(black.T)
        for start, count in _runs(cells)
    ]
    return (*across, *down)


def _runs(black: NDArray[np.bool_]) -> list[tuple[int, int]]:
    """Return (start index, length) of each run of True in a row of cells."""
    edges = np.flatnonzero(np.diff(np.concatenate(([0], black.astype(int), [0]))))
    return [(start, end - start) for start, end in edges.reshape(-1, 2).tolist()]


def squares_of(board: Board) -> tuple[int, int]:
    """Return the numbers of squares along a row and along a column of a board.

    Args:
        board: The board; `columns` and `rows` of a checkerboard count its inner corners.
    """
    more = 0 if isinstance(board, CharucoBoard) else 1
    return board.columns + more, board.rows + more


def board_rectangles(board: Board, *, left: float, bottom: float) -> tuple[Rectangle, ...]:
    """Compute a board's black rectangles: squares, and the cells of a ChArUco board's markers.

    A square is black where row plus column is even, both counted from 0, rows from the top. The
    other squares of a ChArUco board hold a marker each, numbered from 0 along the rows.

    Args:
        board: The board; a ChArUco board gets the pattern that OpenCV expects since version 4.6.
        left: Left edge of the board [mm].
        bottom: Lower edge of the board [mm].
    """
    square = 1e3 * board.square
    columns, rows = squares_of(board)
    rectangles: list[Rectangle] = []
    number = 0
    for row in range(rows):
        for column in range(columns):
            x, y = left + column * square, bottom + (rows - 1 - row) * square
            if (row + column) % 2 == 0:
                rectangles.append(Rectangle(x, y, square, square))
                continue
            if not isinstance(board, CharucoBoard):
                continue
            side = 1e3 * board.marker
            inset = (square - side) / 2
            rectangles += marker_rectangles(
                board.dictionary, number, side, left=x + inset, bottom=y + inset
            )
            number += 1
    return tuple(rectangles)


def _marker_page(
    size: tuple[float, float], number: int, side: float, title: str, direction: str
) -> KitPage:
    """Lay out a page with one marker in the middle: title, direction and cutting advice around it.

    Args:
        size: Width and height of the paper [mm].
        number: Number of the marker in `DICTIONARY`.
        side: Side of the marker's black square [mm].
        title: First line of the page.
        direction: Text that tells how to orient the marker.
    """
    width, height = size
    left, bottom = (width - side) / 2, (height - side) / 2 + 15
    cells = marker_rectangles(DICTIONARY, number, side, left=left, bottom=bottom)
    texts = (
        Text(width / 2, height - 22, title, 14, centred=True),
        Text(width / 2, height - 30, direction, 11, centred=True),
        Text(width / 2, bottom - 33, f"side of the black square: {side:g} mm. Keep a white margin "
             f"of {side / 6:.0f} mm or more around it when you cut.", 9, centred=True),
    )  # fmt: skip
    return KitPage(width, height, (*cells, *_bar(width)), (*texts, _bar_text(width)))


def _board_page(size: tuple[float, float], board: Board) -> KitPage:
    """Lay out the page of the calibration board; `SettingsError` if it does not fit on paper."""
    width, height = size
    columns, rows = squares_of(board)
    across, up = 1e3 * board.square * columns, 1e3 * board.square * rows
    left, bottom = (width - across) / 2, height - up - 12
    if left < _EDGE or bottom < _FOOT:
        raise SettingsError(
            f"{columns} x {rows} squares are {across:g} x {up:g} mm; the paper has room for "
            f"{width - 2 * _EDGE:g} x {height - 12 - _FOOT:g} mm: take smaller or fewer squares",
            key="--board",
        )
    text = f"Calibration board: {_in_words(board)}. Glue it flat on glass or aluminium."
    return KitPage(
        width, height, (*board_rectangles(board, left=left, bottom=bottom), *_bar(width)),
        (Text(12, 5, text, 7), _bar_text(width)),
    )  # fmt: skip


def _in_words(board: Board) -> str:
    """Describe a board for its page in the form that --board accepts."""
    square = f"{1e3 * board.square:g}mm"
    if isinstance(board, CharucoBoard):
        marker = f"{1e3 * board.marker:g}mm"
        return f"charuco:{board.columns}x{board.rows}:{square}:{marker}:{board.dictionary}"
    columns, rows = squares_of(board)
    return (
        f"{columns} x {rows} squares, with {board.columns} x {board.rows} corners between them: "
        f"--board checkerboard:{board.columns}x{board.rows}:{square}"
    )


def _bar(width: float) -> tuple[Rectangle, ...]:
    """Return the 100 mm bar with an end mark at either end, centred at the foot of a page."""
    left = (width - _BAR) / 2
    ends = tuple(Rectangle(x, 10, 0.3, 4) for x in (left - 0.15, left + _BAR - 0.15))
    return (Rectangle(left, 11.85, _BAR, 0.3), *ends)


def _bar_text(width: float) -> Text:
    """Return the line of text above the 100 mm bar of a page of this width [mm]."""
    return Text(width / 2, 15.5, "100 mm: measure this bar before you use the page", 7, True)


def _ruler(width: float, bottom: float, length: float) -> tuple[list[Rectangle], list[Text]]:
    """Lay out a centred ruler in millimetres; the ticks of 5 mm and 10 mm are taller.

    Args:
        width: Width of the paper [mm].
        bottom: Height of the ruler's base line on the page [mm].
        length: Length of the ruler [mm].
    """
    left = (width - length) / 2
    ticks = [Rectangle(left - 0.1, bottom, length + 0.2, 0.2)]
    numbers = []
    for millimetre in range(int(length) + 1):
        tall = 7.0 if millimetre % 10 == 0 else 5.0 if millimetre % 5 == 0 else 3.0
        ticks.append(Rectangle(left + millimetre - 0.06, bottom, 0.12, tall))
        if millimetre % 10 == 0:
            numbers.append(Text(left + millimetre, bottom + 8, str(millimetre), 6, centred=True))
    return ticks, numbers


def _instructions(size: tuple[float, float]) -> KitPage:
    """Lay out the page of instructions, with a ruler of 170 mm."""
    width, height = size
    texts = [Text(20, height - 25, "Tracking kit", 18)]
    y = height - 37
    for line in _TEXT.splitlines():
        texts.append(Text(20, y, line, 9.5))
        y -= 5.2
    ticks, numbers = _ruler(width, 28, 170)
    return KitPage(
        width, height, (*ticks, *_bar(width)), (*texts, *numbers, _bar_text(width))
    )  # fmt: skip


_TEXT = """\
PRINT at 100 % ("actual size", never "fit to page") on stiff matt paper: gloss gives glare.
Measure the 100 mm bar of every page. If it is off, write the true side into floor.toml
and robot.toml; a printer that stretches one direction only cannot be used.

CAMERA  Fix zoom and focus, and keep them fixed from here on. Photograph the board 12 to 15
times, tilted by 20 to 45 degrees another way each time, also in the picture's corners.
    zebro-lab camera calibrate BOARD_PHOTOS

ROBOT  Glue the robot's marker flat on its top plate, the arrow towards the head, the middle
over the body's middle. Measure, while the robot stands, how high it is above the floor;
write its place and height into robot.toml: marker.position, marker.height.

FLOOR  Lay the four floor markers flat around the walk, as far apart as the picture allows,
arrows along x, and tape them down. Choose x along the walk; y grows to the LEFT of x.
Measure the middle of each with a tape, to a millimetre; check both diagonals.
Write what the tape says into floor.toml, which came with this kit:

        13 ------------------- 12        y
         |                     |         ^
         |    walk  - - >      |         |
         |                     |         |
        10 ------------------- 11        +-----> x

TRIPOD  1.5 to 2.5 m high, looking down steeply: the robot's height then matters less.
Do not touch it while the robot walks: use a timer. It must see three floor markers or more.

CLOCK  Photograph the code of `zebro-lab camera clock` once: it ties the camera's clock to the
computer's. Give that photograph as --clock.

CHECK  zebro-lab track PHOTOS --camera camera.toml --floor floor.toml --robot robot.toml \\
           --preview preview.png
before the long run: it lists distances between floor markers to compare with the tape."""
