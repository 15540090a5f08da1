# SPDX-License-Identifier: MIT
"""Read the ground of a walk (`ground.toml`): a slope, and a map of heights."""

import math
from collections.abc import Mapping
from dataclasses import dataclass
from pathlib import Path
from typing import Final

import numpy as np

from model.arrays import Array
from model.errors import DomainError
from model.walk.ground import FLAT, Ground, with_slope
from zebro_lab.files.errors import DataError
from zebro_lab.files.opening import MOST_TEXT, read_bytes
from zebro_lab.files.settings_table import SettingsTable, read_settings
from zebro_lab.tables.csv_files import decoded, possible_encodings
from zebro_lab.tables.text_layout import BLANKS, SEPARATORS, split_line

_MAP_KEYS: Final = ("step", "origin", "unit")
_GONE: Final = ("roughness", "area")  # of earlier versions
_FAR: Final = 1000.0  # m without a unit, of places
MOST_RELIEF: Final = 2.0
"""Largest range of heights of a map whose unit is not given [m]."""
MOST_PLACES: Final = 16_777_216
"""Largest number of heights: 4096 by 4096."""
_ADVICE: Final = "ground.toml names it; its path is relative to that file"


@dataclass(frozen=True)
class GroundFile:
    """A ground as described in a file.

    Attributes:
        ground: The heights.
        what: The parts of the ground in words, for the terminal.
        settings: What was read, in SI, JSON-serialisable, for the manifest.
        files: The file, and its map of heights.
    """

    ground: Ground
    what: tuple[str, ...]
    settings: Mapping[str, object]
    files: tuple[Path, ...]


def read_ground(file: Path) -> GroundFile:
    """Read a ground; slope and heights add up.

    Args:
        file: The `ground.toml`; names of files in it are relative to its folder.

    Raises:
        NotFound: The file, or one that it names, does not exist.
        SettingsError: It is no TOML, a key or value is invalid, or it describes nothing.
        DataError: A map of heights cannot be read.
    """
    table = read_settings(file, advice="expected a ground.toml with slope_deg or heights")
    beside = {key: table.value(key) for key in _MAP_KEYS if key in table}
    gone = [key for key in _GONE if key in table]  # so is a list of numbers as step
    if gone or isinstance(beside.get("step"), list):
        key = gone[0] if gone else "step"
        raise table.fault("is no part of a ground; write its shape into a map of heights", key)
    ground, what, files, settings = FLAT, [], [file], {}
    if "heights" in table:
        ground, map_file, said = _heights(table, beside, settings)
        what.append(said)
        files.append(map_file)
    elif beside:
        raise table.fault("found without heights, which it belongs to", next(iter(beside)))
    if "slope_deg" in table:
        along_x, along_y = table.numbers("slope_deg", 2)
        try:
            ground = with_slope(ground, *np.radians([along_x, along_y]).tolist())
        except DomainError as error:
            raise table.fault(str(error), "slope_deg") from error
        what.append(f"slope of {along_x:g} deg along x, {along_y:g} deg along y")
        settings["slope_deg"] = [along_x, along_y]
    table.finish()
    if not what:
        raise table.fault("describes nothing; expected slope_deg, heights or both")
    return GroundFile(ground, tuple(what), settings, tuple(files))


def _heights(
    table: SettingsTable, beside: Mapping[str, object], settings: dict[str, object]
) -> tuple[Ground, Path, str]:
    """Read a map of heights, given by `heights = "FILE"` and keys beside it, or as a table.

    Args:
        table: Content of the `ground.toml`.
        beside: Values of `_MAP_KEYS` that stand beside `heights`.
        settings: Settings for the manifest, to which the map is added.

    Returns:
        The ground, the file of the map, and what it is in words.
    """
    found = table.value("heights")
    if isinstance(found, str):
        found = {"file": found, **beside}
    spec = table.as_table("heights", found, expected='a file such as "heights.csv"')
    name = spec.text("file", least=1)
    file = Path(table.file).parent / name
    step = spec.quantity("step", "m", above=0.0, usual=0.2)
    x, y = spec.quantities("origin", 2, "m", usual=_FAR)
    # From rows with the farthest first to indices that grow with x, then with y.
    height = np.ascontiguousarray(_in_metres(spec, file)[::-1].T)
    low, high = float(height.min()), float(height.max())
    m, n = height.shape
    settings["heights"] = {
        "file": str(file),
        "step": step,
        "origin": [x, y],
        "lowest": low,
        "highest": high,
    }
    said = (
        f"heights of {name}, x {x:g} to {x + step * (m - 1):g} m, y {y:g} to "
        f"{y + step * (n - 1):g} m in steps of {step:g} m, {1000 * low:.4g} to "
        f"{1000 * high:.4g} mm"
    )
    return Ground(x, y, step, height, high), file, said


def _in_metres(spec: SettingsTable, file: Path) -> Array:
    """Read heights [m]; `DataError` if they differ by over `MOST_RELIEF` without a stated unit.

    The rows of the result are those of the file, the farthest first.
    """
    stated = "unit" in spec
    _, factor = spec.factor("unit", "m")
    height = factor * _height_table(file)
    if not stated and np.ptp(height) > MOST_RELIEF:
        middle = np.abs(height - np.median(height))
        row, column = np.unravel_index(middle.argmax(), height.shape)
        raise DataError(
            f"cell {column + 1} is {height[row, column]:g}, and heights differ by "
            f"{np.ptp(height):g} m, which is improbable under this robot; if they are in "
            'millimetres, add unit = "mm" (or unit = "m") beside heights; a decimal comma between '
            "commas is read as two cells",
            file=file, row=int(row) + 1,
        )  # fmt: skip
    return height


def _height_table(file: Path) -> Array:
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
    lines = [
        (number, line.strip())
        for number, line in enumerate(_text(file).splitlines(), start=1)
        if line.strip() and not line.lstrip().startswith("#")
    ]
    separator = next((each for each in ";\t," if lines and each in lines[0][1]), BLANKS)
    rows: list[list[float]] = []
    for row, (number, line) in enumerate(lines, start=1):
        cells = split_line(line.removesuffix(separator), separator)  # some end a row with one
        heights = [_number(each if separator == "," else each.replace(",", ".")) for each in cells]
        wrong = next((i for i, each in enumerate(heights) if not math.isfinite(each)), None)
        problem = ""
        if wrong is not None:
            cell = f"'{cells[wrong][:40]}'" if cells[wrong] else "empty"
            problem = (
                f"cell {wrong + 1} is {cell}; expected a height as a finite number: cells are "
                f"taken to be separated by {SEPARATORS[separator]}, and there are no rows of names "
                "and no gaps"
            )
        elif rows and len(heights) != len(rows[0]):
            problem = (
                f"has {len(heights)} heights, the rows above have {len(rows[0])}; expected one "
                "height for each place of a grid: the same number in each row"
            )
        if problem:
            raise DataError(problem, file=file, row=row, line=number)
        rows.append(heights)
    _require_size(len(rows), len(rows[0]) if rows else 0, file)
    return np.array(rows)


def _text(file: Path) -> str:
    """Read a table's text in the likeliest encoding; raise `DataError` if it is none."""
    data = read_bytes(file, most=MOST_TEXT, advice=_ADVICE)
    encodings = possible_encodings(data)
    if not encodings:
        raise DataError(
            "is no text; expected rows of heights such as 0.000,0.002",
            file=file,
        )
    return decoded(data, encodings[0])


def _number(text: str) -> float:
    """Parse a number; NaN if the text is not a number."""
    try:
        return float(text)
    except ValueError:
        return math.nan


def _require_size(rows: int, columns: int, file: Path) -> None:
    """Raise `DataError` for fewer than two rows or columns, or over `MOST_PLACES` heights."""
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


TEMPLATE: Final = """\
# Ground of a walk: zebro-lab walk --ground {name} --slip thesis --duration 20 --figures
# Change the values, take # away from what you need, and delete what you do not. All parts are
# optional, and they add up. x is ahead of the robot at its start, y to its left, z up.
# Lengths are in m, or texts with a unit such as "5 mm". docs/formats.md explains every key.

# By which a plane through the start rises along x and along y, from -45 to 45.
slope_deg = [0.0, 0.0]

# A map of heights seen from above, a table of numbers alone, the first row the farthest. step:
# distance of its places; origin: x and y of the lower left one; unit: m by default.
# heights = {{ file = "h.csv", step = 0.005, origin = [-0.5, -0.5], unit = "mm" }}
"""
