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
from zebro_lab.track.trajectory.table import QUATERNION, named_columns

_POSITION: Final = ("x_m", "y_m", "z_m")
_ROTATION: Final = tuple(f"r{row}{column}" for row in "123" for column in "123")
COLUMNS: Final = {
    Layout.TUM: ("t_s", *_POSITION, *QUATERNION),
    Layout.EUROC: ("t_s", *_POSITION, "qw", "qx", "qy", "qz"),
    Layout.KITTI: tuple(f"r{i}{j}" if j < 4 else _POSITION[i - 1] for i in (1, 2, 3)
                        for j in (1, 2, 3, 4)),
}  # fmt: skip
"""Columns of the numbers of a line; of KITTI three rows of a 4x4 matrix, rotation and position."""
_ROTATION_TOLERANCE: Final = 0.05  # of a product of two columns; files round to a few digits
_UPRIGHT: Final = 0.1
"""Largest part of a quaternion across the normal of the floor for a body that is upright."""
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
    path: Path, layout: Layout | None, *, plane: str
) -> tuple[Layout, RawTable] | None:
    """Read lines of numbers as a table with canonical headers; None for another file.

    Args:
        path: The file, a table of any kind or lines of numbers.
        layout: The layout that the user gives; None to find it by header and count of numbers.
        plane: Axes of the floor; a body that is upright on it shows whether w is first or last.

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
    if numbers is None:
        return None
    named = {} if layout else named_columns(numbers.header)
    if set(COLUMNS[Layout.TUM]) <= set(named):
        place = {name: numbers.header.index(named[name]) for name in COLUMNS[Layout.TUM]}
        layout = Layout.EUROC if place["qw"] < place["qx"] else Layout.TUM
        units = {name: unit for name in place if (unit := unit_in_header(named[name]))}
    else:
        layout, units = _layout_of_count(path, numbers, layout, plane), {}
        place = {name: i for i, name in enumerate(COLUMNS[layout])}
    columns = {name: numbers.rows[:, i] for name, i in place.items()}
    if layout is Layout.KITTI:
        columns, units = _of_matrices(path, numbers.line, columns), {"t_s": "s"}
    if layout is Layout.EUROC and np.all(columns["t_s"] == np.round(columns["t_s"])):
        units.setdefault("t_s", "ns")
    series = {name: pd.Series(values) for name, values in columns.items()}
    return layout, RawTable(path, series, header_line=numbers.line - 1, units=units)


def _layout_of_count(path: Path, numbers: NumberLines, given: Layout | None, plane: str) -> Layout:
    """Return the layout that is given, else the only one of as many numbers; check their count."""
    count = numbers.rows.shape[1]
    layout = given
    if given is None and count == len(COLUMNS[Layout.KITTI]) and not numbers.header:
        layout = Layout.KITTI
    elif given is None and count == len(COLUMNS[Layout.TUM]) and not numbers.separated:
        layout = Layout.TUM
        _require_w_last(path, numbers.rows[:, 4:], plane)
    expected = len(COLUMNS[layout]) if layout else 0
    if layout and (count == expected or (layout is Layout.EUROC and count > expected)):
        return layout
    raise DataError(
        f"has {count} numbers a line; expected {f'{expected} ({layout})' if layout else '8 or 12'}"
        f": 8 (TUM) between white space, 12 (KITTI), or a line above that names them (t, x, y, "
        f"perhaps yaw, or z and qx, qy, qz, qw); of 8 or more without it {_PLACE_OF_W}",
        file=path,
    )


def _of_matrices(path: Path, line: int, columns: dict[str, Array]) -> dict[str, Array]:
    """Convert rotation matrices to quaternions; times are numbers of rows."""
    rotation = np.column_stack([columns[name] for name in _ROTATION]).reshape(-1, 3, 3)
    with np.errstate(invalid="ignore", over="ignore"):
        product = np.swapaxes(rotation, 1, 2) @ rotation - np.eye(3)
        right = np.abs(product).max(axis=(1, 2)) <= _ROTATION_TOLERANCE
        right &= np.linalg.det(rotation) > 0
    RawTable(path, {}, header_line=line - 1).require(
        "rotation", right,
        lambda _: "numbers 1-3, 5-7 and 9-11 are no rotation matrix; expected lines of a KITTI "
        "trajectory, the first three rows of a 4x4 matrix",
    )  # fmt: skip
    quaternion = Rotation.from_matrix(rotation).as_quat().T
    return {
        "t_s": np.arange(len(rotation), dtype=float),
        **{name: columns[name] for name in _POSITION},
        **dict(zip(QUATERNION, quaternion, strict=True)),
    }


def _require_w_last(path: Path, quaternion: Array, plane: str) -> None:
    """Raise where a body stands upright if w is read first, and does not if it is read last."""
    size, in_plane = np.abs(quaternion), np.array(plane_axes(plane))
    if size[:, in_plane].max() > _UPRIGHT >= size[:, 1 + in_plane].max():
        raise DataError(
            "quaternions are upright if their first number is w, and upside down or tilted if the "
            f"last is w as in TUM files; {_PLACE_OF_W}",
            file=path,
        )
