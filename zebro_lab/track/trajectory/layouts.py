# SPDX-License-Identifier: MIT
"""Read text files of lines of numbers as tables of poses: TUM, KITTI and EuRoC trajectories."""

import re
from pathlib import Path
from typing import Final, NamedTuple

import numpy as np
import pandas as pd
from scipy.spatial.transform import Rotation

from model.arrays import Array
from model.counted import counted
from model.rigid_path import plane_axes
from zebro_lab.files.errors import DataError
from zebro_lab.files.opening import read_text
from zebro_lab.tables.header_units import unit_in_header
from zebro_lab.tables.raw_table import RawTable
from zebro_lab.tables.table_files import has_table_name
from zebro_lab.track.trajectory.request import Layout
from zebro_lab.track.trajectory.table import named_columns

_TUM: Final = ("t_s", "x_m", "y_m", "z_m", "qx", "qy", "qz", "qw")
_EUROC: Final = ("t_s", "x_m", "y_m", "z_m", "qw", "qx", "qy", "qz")
_MATRIX: Final = 12  # numbers of a KITTI line
_ROTATION_TOLERANCE: Final = 0.05  # of a product of two columns; files round to a few digits
_UPRIGHT: Final = 0.1
"""Largest part of a quaternion across the normal of the floor for a body that is upright."""
_EXPECTED: Final = {
    None: "8 (TUM) or 12 (KITTI)",
    Layout.TUM: "8 (time, position, quaternion)",
    Layout.EUROC: "8 or more (time, position, quaternion)",
    Layout.KITTI: "12 (three rows of a matrix)",
}  # fmt: skip
_PLACE_OF_W: Final = "give --layout tum (w last) or --layout euroc (w first)"


class NumberLines(NamedTuple):
    """Lines of equally many numbers.

    Attributes:
        rows: The numbers, shape (n, columns).
        line: Line of the first of them in the file, counted from 1.
        separated: Whether commas or semicolons, not white space, separate them.
        header: Words of the last comment line before them if they are as many as the columns, else
            empty.
    """

    rows: Array
    line: int
    separated: bool
    header: tuple[str, ...]


def read_number_lines(path: Path) -> NumberLines | None:
    """Read a text file of numbers; None if its first line that is no comment has other words.

    Empty lines and those that begin with # are skipped. Numbers are separated by commas, by
    semicolons, or by white space.

    Raises:
        NotFound: There is no such file.
        DataError: The file is no text or too large, has no numbers, or a line has more or fewer
            numbers than the first, a word that is none, or one that is not finite.
    """
    # Not splitlines: it also splits at characters that editors do not count as line ends.
    lines = pd.Series(re.split(r"\r\n|\n|\r", read_text(path))).str.strip()
    comments = lines.str.startswith("#")
    kept = lines[(lines != "") & ~comments]
    if kept.empty:
        raise DataError("has no pose; expected lines of numbers, or a table", file=path)
    first = int(kept.index[0])
    separator = next((sign for sign in (";", ",") if sign in lines[first]), None)
    words = kept.str.rstrip(separator).str.split(separator, expand=True)
    count = int(words.iloc[0].notna().sum())
    rows = words.apply(pd.to_numeric, errors="coerce").to_numpy(dtype=float)
    finite = np.isfinite(rows)
    if not finite[0, :count].all():
        return None
    wrong = np.flatnonzero(finite.sum(axis=1) != count)
    if len(wrong):
        line = int(kept.index[wrong[0]])
        raise DataError(
            f"found '{lines[line][:60]}'; expected {counted(count, 'finite number')} as in the "
            "first line; correct or delete the line",
            file=path, row=int(wrong[0]) + 1, line=line + 1,
        )  # fmt: skip
    comment = next(iter(lines[:first][comments[:first]].iloc[::-1]), "").lstrip("# ")
    # A unit in brackets belongs to the word before it.
    header = [word.strip() for word in re.sub(r"\s+(?=[\[(])", "", comment).split(separator)]
    matching = tuple(header) if len(header) == count else ()
    return NumberLines(rows, first + 1, separator is not None, matching)


def read_number_table(
    path: Path, layout: Layout | None, *, plane: str | None
) -> tuple[Layout, RawTable] | None:
    """Read lines of numbers as a table with canonical headers; None for another file.

    Args:
        path: The file, a table of any kind or lines of numbers.
        layout: The layout that the user gives; None to find it by header and count of numbers.
        plane: Axes of the floor, None for xy; a body that is upright on it shows whether w is first
            or last.

    Returns:
        The layout, and columns t_s (of KITTI numbers of rows), x_m, y_m, z_m, qx, qy, qz and qw.

    Raises:
        NotFound: There is no such file.
        DataError: The file is damaged, or its layout is not known or does not fit.
    """
    if layout is Layout.TABLE or path.suffix.lower() in (".parquet", ".xlsx", ".gz"):
        return None
    try:
        numbers = read_number_lines(path)
    except DataError as error:
        if has_table_name(path) and isinstance(error.__cause__, UnicodeDecodeError):
            return None  # a table in another encoding
        raise
    if numbers is None and (layout is not None or not has_table_name(path)):
        raise DataError("has a line of words; expected lines of 8 (TUM) or 12 (KITTI) numbers, or "
                        "a table with a suffix such as .csv", file=path)  # fmt: skip
    return None if numbers is None else _ordered(path, numbers, layout, plane or "xy")


def _ordered(
    path: Path, numbers: NumberLines, given: Layout | None, plane: str
) -> tuple[Layout, RawTable]:
    """Name the columns by the layout given, by the header, or by their number."""
    count = numbers.rows.shape[1]
    if given is Layout.KITTI or (given is None and count == _MATRIX and not numbers.header):
        return Layout.KITTI, _of_matrices(path, numbers)
    named = {} if given else named_columns(numbers.header)
    units = {}
    if set(_TUM) <= set(named):
        place = {name: numbers.header.index(named[name]) for name in _TUM}
        layout = Layout.EUROC if place["qw"] < place["qx"] else Layout.TUM
        units = {name: unit for name in _TUM if (unit := unit_in_header(named[name]))}
    else:
        layout = given or (Layout.TUM if count == len(_TUM) and not numbers.separated else None)
        if layout is None or count < len(_TUM) or (layout is Layout.TUM and count > len(_TUM)):
            raise _unknown(path, count, given)
        names = _EUROC if layout is Layout.EUROC else _TUM
        place = {name: names.index(name) for name in names}
        if given is None:
            _require_w_last(path, numbers.rows[:, 4:], plane)
    rows = numbers.rows[:, [place[name] for name in _TUM]]
    if layout is Layout.EUROC and np.all(rows[:, 0] == np.round(rows[:, 0])):
        units.setdefault("t_s", "ns")
    return layout, _table(path, rows, numbers.line, units)


def _table(path: Path, rows: Array, line: int, units: dict[str, str]) -> RawTable:
    columns = {name: pd.Series(values) for name, values in zip(_TUM, rows.T, strict=True)}
    return RawTable(path, columns, header_line=line - 1, units=units)


def _of_matrices(path: Path, numbers: NumberLines) -> RawTable:
    """Convert the first three rows of 4x4 matrices to positions and quaternions."""
    if numbers.rows.shape[1] != _MATRIX:
        raise _unknown(path, numbers.rows.shape[1], Layout.KITTI)
    matrix = numbers.rows.reshape(-1, 3, 4)
    rotation = matrix[:, :, :3]
    with np.errstate(invalid="ignore", over="ignore"):
        product = np.swapaxes(rotation, 1, 2) @ rotation - np.eye(3)
        right = np.abs(product).max(axis=(1, 2)) <= _ROTATION_TOLERANCE
        right &= np.linalg.det(rotation) > 0
    if not right.all():
        raise RawTable(path, {}, header_line=numbers.line - 1).fault(
            "numbers 1-3, 5-7 and 9-11 are no rotation matrix; expected lines of a KITTI "
            "trajectory, the first three rows of a 4x4 matrix",
            "rotation",
            int(np.argmin(right)),
        )
    quaternion = Rotation.from_matrix(rotation).as_quat()
    rows = np.column_stack((np.arange(len(matrix), dtype=float), matrix[:, :, 3], quaternion))
    return _table(path, rows, numbers.line, {"t_s": "s"})


def _require_w_last(path: Path, quaternion: Array, plane: str) -> None:
    """Raise where a body stands upright if w is read first, and does not if it is read last."""
    size, in_plane = np.abs(quaternion), np.array(plane_axes(plane))
    if size[:, in_plane].max() > _UPRIGHT >= size[:, 1 + in_plane].max():
        raise DataError(
            "quaternions are upright if their first number is w, and upside down or tilted if the "
            f"last is w as in TUM files; {_PLACE_OF_W}",
            file=path,
        )


def _unknown(path: Path, count: int, given: Layout | None) -> DataError:
    problem = (
        f"expected {_EXPECTED[given]}, or a table with a header line (t, x, y, perhaps yaw, or z "
        "and qx, qy, qz, qw)"
    )
    if count in (len(_TUM), 17) and given is None:  # 17: EuRoC with speeds and biases
        problem = f"no header names them, so that the place of w is open; {_PLACE_OF_W}"
    return DataError(f"has {count} numbers a line; {problem}", file=path)
