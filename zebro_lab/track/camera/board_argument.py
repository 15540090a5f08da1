# SPDX-License-Identifier: MIT
"""Parse `--board`, the description of a calibration board."""

from tracking.camera import Board, CharucoBoard, Checkerboard
from tracking.errors import TrackingError
from tracking.markers import dictionary_named
from zebro_lab.files.errors import SettingsError
from zebro_lab.files.units import option_to_si
from zebro_lab.track.camera.kit import BOARD

_EXPECTED = (
    "expected kit, checkerboard:COLUMNSxROWS:SQUARE (inner corners) such as "
    "checkerboard:9x6:25mm, or charuco:COLUMNSxROWS:SQUARE:MARKER:DICTIONARY (squares) such as "
    "charuco:7x5:35mm:26mm:5x5_50"
)


def parse_board(text: str) -> Board:
    """Parse `--board`: `kit`, `checkerboard:COLUMNSxROWS:SQUARE`, or a ChArUco board.

    A ChArUco board is `charuco:COLUMNSxROWS:SQUARE:MARKER:DICTIONARY`.

    Raises:
        SettingsError: The form, a number, a length (above 0, below 1 m), its unit or the dictionary
            is invalid, or markers are not smaller than squares.

    >>> parse_board("checkerboard:9x6:25mm")
    Checkerboard(columns=9, rows=6, square=0.025)
    """
    kind, *parts = text.split(":")
    if kind == "kit" and not parts:
        return BOARD
    if kind == "checkerboard" and len(parts) == 2:
        columns, rows = _grid(text, parts[0])
        return Checkerboard(columns, rows, _length(text, parts[1]))
    if kind == "charuco" and len(parts) == 4:
        columns, rows = _grid(text, parts[0])
        square, marker = _length(text, parts[1]), _length(text, parts[2])
        if marker >= square:
            raise _error(text, f"markers of {parts[2]} do not fit into squares of {parts[1]}")
        try:
            dictionary_named(parts[3])
        except TrackingError as error:
            raise SettingsError(str(error), key="--board") from error
        return CharucoBoard(columns, rows, square, marker, parts[3])
    raise _error(text, "is not a board")


def _grid(text: str, part: str) -> tuple[int, int]:
    columns, _, rows = part.partition("x")
    if not (columns.isdigit() and rows.isdigit() and int(columns) > 1 and int(rows) > 1):
        raise _error(text, f"'{part}' is not COLUMNSxROWS, 2 or more each")
    return int(columns), int(rows)


def _length(text: str, part: str) -> float:
    length = option_to_si(part, "m", key="--board")
    if not 0 < length < 1:
        raise _error(text, f"'{part}' is not above 0 and below 1 m; give a unit, as in 25mm")
    return length


def _error(text: str, problem: str) -> SettingsError:
    return SettingsError(f"'{text}': {problem}; {_EXPECTED}", key="--board")
