# SPDX-License-Identifier: MIT
"""Read tables of poses, and lines of numbers as such: TUM, KITTI and EuRoC trajectories."""

from dataclasses import replace
from pathlib import Path
from typing import Final

import numpy as np
import pandas as pd
from scipy.spatial.transform import Rotation

from model.arrays import Array
from model.rigid_path import plane_axes
from zebro_lab.files.errors import DataError
from zebro_lab.tables.raw_table import RawTable
from zebro_lab.tables.table_files import read_table_file
from zebro_lab.tables.text_layout import BLANKS
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


def read_pose_table(
    path: Path, layout: Layout | None, *, plane: str, sheet: str | None = None
) -> tuple[Layout, RawTable]:
    """Read a table of poses, or lines of numbers as one with canonical headers.

    Args:
        path: The file: lines of numbers under any name, or a table.
        layout: The layout that the user gives; None to find it by header or count of numbers.
        plane: Axes of the floor; a body that is upright on it shows whether w is first or last.
        sheet: Sheet of a workbook; None for the only one.

    Returns:
        The layout, and a table; without a header its columns are t_s (of KITTI numbers of rows),
        x_m, y_m, z_m, qx, qy, qz and qw.

    Raises:
        NotFound: There is no such file.
        DataError: The file is damaged, or its layout is not known or does not fit.
    """
    table = read_table_file(path, sheet=sheet, bare=layout is not Layout.TABLE)
    headers, count = list(table.columns), len(table.columns)
    named = named_columns(headers) if layout is None and table.commented else {}
    if set(COLUMNS[Layout.TUM]) <= set(named):
        found = Layout.TUM
        if headers.index(named["qw"]) < headers.index(named["qx"]):
            found = Layout.EUROC
    elif layout is Layout.TABLE or (layout is None and headers != _numbers(count)):
        return Layout.TABLE, table
    else:
        found = layout or _layout_of_count(table, plane)
        expected = len(COLUMNS[found]) if found else 0
        if not found or count < expected or (count > expected and found is not Layout.EUROC):
            raise DataError(
                f"has {count} numbers a line; expected {f'{expected} of {found}: ' * bool(found)}"
                "8 (TUM) between white space, 12 (KITTI), or a line above that names them (t, x, "
                f"y, perhaps yaw, or z and qx, qy, qz, qw); of 8 or more without it {_PLACE_OF_W}",
                file=path,
            )
        named = dict(zip(COLUMNS[found], headers, strict=False))
        table = replace(table, units={})
    columns = {name: table.column(named[name]) for name in COLUMNS[found]}
    units = {name: table.units[named[name]] for name in columns if named[name] in table.units}
    table = replace(table, columns=columns, units=units, notes=())
    # EuRoC files hold integer nanoseconds; other programs write the same columns in seconds.
    if found is Layout.EUROC and _is_whole(table.numbers("t_s")):
        table = replace(table, units={"t_s": "ns", **units})
    return found, _of_matrices(table) if found is Layout.KITTI else table


def _numbers(count: int) -> list[str]:
    """Return the headers given to columns without any: "1", "2" and so on up to `count`."""
    return [str(i + 1) for i in range(count)]


def _is_whole(values: Array) -> bool:
    """Return whether all values are whole numbers."""
    return bool(np.all(values == np.round(values)))


def _layout_of_count(table: RawTable, plane: str) -> Layout | None:
    """Infer the layout from the count of numbers: 12 are KITTI, 8 between blanks or tabs TUM.

    None for any other table.

    Raises:
        DataError: There are 8, but the body is upright only if w is the first number of the
            quaternion, not the last as in TUM files.
    """
    if len(table.columns) == len(COLUMNS[Layout.KITTI]):
        return Layout.KITTI
    between_blanks = table.separator in ("\t", BLANKS)
    if len(table.columns) != len(COLUMNS[Layout.TUM]) or not between_blanks:
        return None
    quaternion = np.column_stack([table.numbers(str(i)) for i in (5, 6, 7, 8)])
    size, in_plane = np.abs(quaternion), np.array(plane_axes(plane))
    if size[:, in_plane].max() > _UPRIGHT >= size[:, 1 + in_plane].max():
        raise DataError(
            "quaternions are upright if their first number is w, and upside down or tilted if the "
            f"last is w as in TUM files; {_PLACE_OF_W}",
            file=table.path,
        )
    return Layout.TUM


def _of_matrices(table: RawTable) -> RawTable:
    """Convert rotation matrices to quaternions; times are numbers of rows.

    Raises:
        DataError: A matrix is no rotation, within `_ROTATION_TOLERANCE`.
    """
    rotation = np.column_stack([table.numbers(name) for name in _ROTATION]).reshape(-1, 3, 3)
    with np.errstate(invalid="ignore", over="ignore"):
        product = np.swapaxes(rotation, 1, 2) @ rotation - np.eye(3)
        right = np.abs(product).max(axis=(1, 2)) <= _ROTATION_TOLERANCE
        right &= np.linalg.det(rotation) > 0
    table.require(
        "rotation", right,
        lambda _: "numbers 1-3, 5-7 and 9-11 are no rotation matrix; expected lines of a KITTI "
        "trajectory, the first three rows of a 4x4 matrix",
    )  # fmt: skip
    quaternion = Rotation.from_matrix(rotation).as_quat().T
    columns = {
        "t_s": pd.Series(np.arange(len(rotation), dtype=float)),
        **{name: table.columns[name] for name in _POSITION},
        **{name: pd.Series(part) for name, part in zip(QUATERNION, quaternion, strict=True)},
    }
    return replace(table, columns=columns, units={"t_s": "s"})
