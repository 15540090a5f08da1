# SPDX-License-Identifier: MIT
"""Read a trajectory from a table with headers."""

from collections.abc import Mapping
from dataclasses import dataclass
from pathlib import Path
from typing import Final, NamedTuple

import numpy as np

from model.arrays import Array
from model.counted import counted
from model.rigid_path import RigidPath, rotations_of_quaternions
from zebro_lab.files.errors import DataError
from zebro_lab.tables.mapped_columns import MappedColumns, canonical_columns
from zebro_lab.tables.raw_table import RawTable
from zebro_lab.tables.row_conditions import kept_rows
from zebro_lab.tables.table_files import read_table_file
from zebro_lab.track.trajectory.headers import named_columns
from zebro_lab.track.trajectory.heading_unit import are_degrees
from zebro_lab.track.trajectory.stamps import kept_stamps, stamp_factor

NEEDED: Final = ("t_s", "x_m", "y_m")
QUATERNION: Final = ("qx", "qy", "qz", "qw")
POSE_UNITS: Final = {
    "t_s": "s", "x_m": "m", "y_m": "m", "z_m": "m", "yaw_rad": "rad",
    **dict.fromkeys(QUATERNION, "dimensionless"),
}  # fmt: skip
"""SI unit of each column of poses, by canonical name."""
COVARIANCE: Final = {
    "cov_xx": "m^2", "cov_xy": "m^2", "cov_xyaw": "m rad", "cov_yy": "m^2", "cov_yyaw": "m rad",
    "cov_yawyaw": "rad^2",
}  # fmt: skip
FASTEST: Final = 20.0
"""Largest mean speed of a path whose unit of length nobody states [m/s]."""
_LEGS_OF_PATH: Final = 21  # so few that noise does not lengthen the path
MAPPED_UNITS: Final[Mapping[str, str]] = {**POSE_UNITS, "t_sigma": "s", **COVARIANCE}
"""SI unit of each column that `[track.columns]` maps; not every command reads all of them."""


@dataclass(frozen=True)
class TableTrajectory:
    """Trajectory in a table.

    Attributes:
        path: Poses in space; z is 0 where there is no column z.
        in_space: Whether there is a column z.
        source: Source as stated, else "unknown".
        notes: Notes from reading, one line each.
        files: The table, and its `columns.toml` if there is one.
    """

    path: RigidPath
    in_space: bool
    source: str
    notes: tuple[str, ...]
    files: tuple[Path, ...]


def read_table_trajectory(path: Path, mapping: MappedColumns | None) -> TableTrajectory:
    """Read time, position and quaternion, or yaw, from a table.

    Args:
        path: The table.
        mapping: Headers and units of the columns; those that it leaves at their canonical names are
            recognised by their headers.

    Raises:
        NotFound: There is no such file.
        DataError: The table is damaged, time, x or y is missing, a cell is no finite number, or
            a stamp is earlier than the one before or repeated with another pose.
    """
    mapping = mapping or canonical_columns(MAPPED_UNITS)
    table = read_table_file(path, sheet=mapping.sheet)
    read = read_table_columns(table, mapping, POSE_UNITS)
    columns = read.columns
    t = columns["t_s"]
    position = np.column_stack(
        [columns.get(name, np.zeros_like(t)) for name in ("x_m", "y_m", "z_m")]
    )
    return TableTrajectory(
        path=RigidPath(t, position, _rotation(columns, read.table)),
        in_space="z_m" in columns,
        source=mapping.source or table.source or "unknown",
        notes=(*table.notes, *read.notes),
        files=(path, *([mapping.file] if mapping.file else [])),
    )


class TableColumns(NamedTuple):
    """Columns of a path in a table.

    Attributes:
        columns: Columns in SI by canonical name, without empty rows and those that repeat a stamp,
            shape (n,) each.
        notes: Notes on rows and stamps, one line each.
        table: The rows of the table that they are.
    """

    columns: Mapping[str, Array]
    notes: tuple[str, ...]
    table: RawTable


def read_table_columns(
    table: RawTable, mapping: MappedColumns, units: Mapping[str, str], *, what: str = "trajectory"
) -> TableColumns:
    """Convert the columns of a path to SI, and check its stamps.

    Rows without any number of a pose are gaps, as motion-capture systems write them: left out.

    Args:
        table: The table.
        mapping: Headers and units of its columns, see `recognised`.
        units: Canonical names to look for; time, x and y are needed.
        what: Description of the path, for error messages.

    Raises:
        DataError: Time, x or y is missing, a cell is no finite number, or a stamp is earlier than
            the one before or, in many rows, repeated with another pose, or headings without a unit
            fit the path in degrees alone.
    """
    mapping = recognised(table, mapping)
    table, empty = _with_poses(table, mapping)
    columns = {
        name: mapping.numbers(
            table, name, what=f"{name} of the {what}", advice=_advice(mapping, name)
        )
        for name in units
        if name in NEEDED or mapping.has(table, name)
    }
    time = mapping.mapped["t_s"]

    def fault(problem: str, index: int) -> DataError:
        return table.fault(problem, time.name, index)

    notes = said = (*empty, *mapping.conversions(table))
    if time.name not in table.units and time.factor == 1.0:
        factor, more = stamp_factor(columns["t_s"], "s", fault=fault)
        notes = (*said, *more)
        columns["t_s"] = columns["t_s"] * factor
    _require_radians(table, mapping, columns)
    metres = _require_metres(table, mapping, columns)
    poses = np.column_stack([column for name, column in columns.items() if name != "t_s"])
    kept, more = kept_stamps(columns["t_s"], poses, fault=fault)
    notes = (*notes, *metres, *more)
    columns = {n: column[kept] for n, column in columns.items()}
    return TableColumns(columns, notes, table.part(kept))


def _with_poses(table: RawTable, mapping: MappedColumns) -> tuple[RawTable, tuple[str, ...]]:
    """Return the rows that `[rows] keep` asks for and that hold a pose, and a note on the rest."""
    if mapping.keep:
        table = table.part(kept_rows(table, mapping.keep, where=mapping.where))
    names = [name for name in POSE_UNITS if name != "t_s" and name in mapping.mapped]
    headers = [mapping.mapped[name].name for name in names]
    cells = [table.columns[header].isna() for header in headers if header in table.columns]
    empty = np.all(cells, axis=0) if cells else np.zeros(len(table), dtype=bool)
    if not empty.any() or empty.all():
        return table, ()
    gaps = int(np.count_nonzero(np.diff(empty.astype(int), prepend=0) > 0))
    where = f"in {counted(gaps, 'gap')}, the first from row {table.row(int(np.argmax(empty)))}"
    note = f"{table.path.name}: {counted(int(empty.sum()), 'empty pose')} left out {where}"
    return table.part(np.flatnonzero(~empty)), (note,)


def _advice(mapping: MappedColumns, name: str) -> str:
    header = mapping.mapped[name].name
    return (
        f'leave such poses out, as by [{mapping.where}rows] keep = ["`{header}` > -1e9"] in '
        f"{mapping.stated_in}"
    )


def _require_radians(table: RawTable, mapping: MappedColumns, columns: Mapping[str, Array]) -> None:
    heading = mapping.mapped.get("yaw_rad")
    if "yaw_rad" not in columns or heading is None:
        return
    if heading.unit_stated or heading.name in table.units:
        return
    position = np.column_stack([columns["x_m"], columns["y_m"]])
    if are_degrees(columns["yaw_rad"], position):
        largest = float(np.abs(columns["yaw_rad"]).max())
        raise table.fault(
            f"the heading goes up to {largest:.4g} rad and fits the direction of travel only in "
            f"degrees; state its unit in {mapping.stated_in}: [track.columns.yaw_rad] "
            'unit = "deg", or "rad" if that is right',
            heading.name,
        )


def _require_metres(
    table: RawTable, mapping: MappedColumns, columns: Mapping[str, Array]
) -> tuple[str, ...]:
    """Return a note on positions whose unit nobody states: they are taken in metres.

    Raises:
        DataError: In metres they would be those of no robot.
    """
    east, t = mapping.mapped["x_m"], columns["t_s"]
    if east.name == "x_m" or mapping.states_unit(table, "x_m"):
        return ()
    at = np.linspace(0, len(t) - 1, _LEGS_OF_PATH).astype(int)
    position = np.column_stack([columns["x_m"], columns["y_m"]])[at]
    way = float(np.linalg.norm(np.diff(position, axis=0), axis=1).sum())
    speed = way / float(np.ptp(t) or np.inf)
    if speed > FASTEST:
        raise table.fault(
            f"the path goes at {speed:.3g} m/s, if positions are in m; expected at most "
            f"{FASTEST:g} m/s where their unit is not stated: state it in {mapping.stated_in}, "
            f'such as [{mapping.where}columns.x_m] unit = "mm", and so for y_m, or "m" if that is '
            "right",
            east.name,
        )
    return (f"positions ('{east.name}', …) are taken in m, since no unit of them is stated",)


def recognised(table: RawTable, mapping: MappedColumns) -> MappedColumns:
    """Map columns that are missing and not mapped in a file to headers that are recognised."""
    for name, seen in named_columns(list(table.columns)).items():
        free = name in mapping.mapped and mapping.mapped[name].name == name
        if free and not mapping.has(table, name):
            mapping = mapping.called(name, seen.header)
    return mapping


def _rotation(columns: Mapping[str, Array], table: RawTable) -> Array | None:
    if set(QUATERNION) <= set(columns):
        quaternion = np.column_stack([columns[name] for name in QUATERNION])
        length = np.linalg.norm(quaternion, axis=1)
        wrong = np.abs(length - 1) > 0.05
        if wrong.any():
            index = int(np.argmax(wrong))
            raise table.fault(
                f"quaternion length {length[index]:.4g}; expected 0.95 to 1.05", "qw", index
            )
        return rotations_of_quaternions(quaternion)
    if "yaw_rad" not in columns:
        return None
    half = columns["yaw_rad"] / 2
    zero = np.zeros_like(half)
    return rotations_of_quaternions(np.column_stack([zero, zero, np.sin(half), np.cos(half)]))
