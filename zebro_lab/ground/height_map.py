# SPDX-License-Identifier: MIT
"""Read a map of heights: a table of numbers, or a grey picture of 16 bits.

Both are seen from above: columns are x, to the right, and rows are y, the first row the farthest.
"""

import math
from pathlib import Path
from typing import Final

import numpy as np

from model.arrays import Array
from zebro_lab.files.errors import DataError
from zebro_lab.files.opening import MOST_TEXT, open_file, parsing, read_bytes
from zebro_lab.tables.text_encoding import decoded, possible_encodings

MOST_PLACES: Final = 16_777_216
"""Largest number of heights: 4096 by 4096."""
FULL: Final = 65_535
"""Largest value of a pixel of 16 bits."""
_GREY_16: Final = ("I;16", "I;16B", "I;16L", "I;16N")
_SEPARATORS: Final = {";": "semicolons", "\t": "tabs", ",": "commas"}
_ADVICE: Final = "ground.toml names it; its path is relative to that file"


def read_height_table(file: Path) -> Array:
    """Read rows of heights, without names, separated by commas, semicolons, tabs or blanks.

    Lines that are blank or begin with # are skipped. With semicolons, tabs or blanks a comma is a
    decimal sign.

    Args:
        file: The table.

    Returns:
        The numbers as they are in the file, its rows and columns, shape (rows, columns).

    Raises:
        NotFound: There is no such file.
        DataError: A cell is no finite number, rows differ in length, or there are fewer than two
            rows or columns, or too many; the message names row and value.
    """
    lines = _text(file).splitlines()
    rows: list[list[float]] = []
    separator = None
    for number, line in enumerate(lines, start=1):
        if not line.strip() or line.lstrip().startswith("#"):
            continue
        if separator is None:
            separator = next((each for each in _SEPARATORS if each in line.strip()), " ")
        row = _numbers(line, separator, file=file, row=len(rows) + 1, line_number=number)
        if rows and len(row) != len(rows[0]):
            raise DataError(
                f"has {len(row)} heights, the rows above have {len(rows[0])}; expected one height "
                "for each place of a grid: the same number in each row",
                file=file, row=len(rows) + 1, line=number,
            )  # fmt: skip
        rows.append(row)
    _require_size(len(rows), len(rows[0]) if rows else 0, file)
    return np.array(rows)


def _text(file: Path) -> str:
    data = read_bytes(file, most=MOST_TEXT, advice=_ADVICE)
    encodings = possible_encodings(data)
    if not encodings:
        raise DataError(
            "is no text; expected rows of heights such as 0.000,0.002 (.csv), or a grey picture of "
            "16 bits (.png)",
            file=file,
        )
    return decoded(data, encodings[0])


def _numbers(line: str, separator: str, *, file: Path, row: int, line_number: int) -> list[float]:
    """Return the heights of a line; raise `DataError` for a cell that is no finite number."""
    cells = line.split() if separator == " " else line.split(separator)
    if separator == "," and not cells[-1].strip():  # some programs end a row with a separator
        cells = cells[:-1]
    numbers = []
    for column, cell in enumerate(cells, start=1):
        text = cell.strip() if separator == "," else cell.strip().replace(",", ".")
        try:
            number = float(text)
        except ValueError:
            number = None
        if number is None or not math.isfinite(number):
            separated = _SEPARATORS.get(separator, "blanks")
            wrong = f"'{cell.strip()[:40]}'" if cell.strip() else "empty"
            raise DataError(
                f"cell {column} is {wrong}; expected a height as a finite number: cells are taken "
                f"to be separated by {separated}, and there are no rows of names and no gaps",
                file=file, row=row, line=line_number, value=cell,
            )  # fmt: skip
        numbers.append(number)
    return numbers


def read_height_picture(file: Path, lowest: float, highest: float) -> Array:
    """Read heights from the grey values of a picture of 16 bits.

    Args:
        file: The PNG.
        lowest: Height of a pixel of value 0 [m].
        highest: Height of a pixel of value 65535 [m].

    Returns:
        Heights, the picture's rows and columns, shape (rows, columns) [m].

    Raises:
        NotFound: There is no such file.
        DataError: It is no picture, has colours or another number of bits, or too many pixels.
    """
    from PIL import Image

    with (
        open_file(file, most=MOST_TEXT, advice=_ADVICE) as opened,
        parsing(file, "cannot be read as a picture", advice="save it as a grey PNG of 16 bits"),
        Image.open(opened) as picture,
    ):
        if picture.mode not in _GREY_16:
            raise DataError(
                f"is a picture of mode {picture.mode}; expected grey values of 16 bits (I;16): "
                "of 8 bits there are 256 heights only, which are steps",
                file=file,
            )
        _require_size(picture.height, picture.width, file)
        values = np.asarray(picture, dtype=float)
    return lowest + (highest - lowest) * values / FULL


def _require_size(rows: int, columns: int, file: Path) -> None:
    if min(rows, columns) < 2:
        raise DataError(
            f"has {rows} rows and {columns} columns of heights; expected two or more of each",
            file=file,
        )
    if rows * columns > MOST_PLACES:
        raise DataError(
            f"has {rows} by {columns} heights; expected at most {MOST_PLACES}: a larger step, or a "
            "smaller map",
            file=file,
        )
