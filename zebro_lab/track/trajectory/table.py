# SPDX-License-Identifier: MIT
"""Read a trajectory from a table with headers."""

from dataclasses import dataclass
from pathlib import Path
from typing import Final

import numpy as np

from model.rigid_path import RigidPath, rotations_of_quaternions
from model.slip.law import Array
from zebro_lab.files.errors import DataError
from zebro_lab.tables.mapped_columns import MappedColumns, canonical_columns
from zebro_lab.tables.raw_table import RawTable
from zebro_lab.tables.table_files import read_table_file
from zebro_lab.track.trajectory.headers import named_columns
from zebro_lab.track.trajectory.stamps import Fault, kept_stamps, stamp_factor

QUATERNION: Final = ("qx", "qy", "qz", "qw")
TABLE_UNITS: Final = {
    "t_s": "s", "x_m": "m", "y_m": "m", "z_m": "m", "yaw_rad": "rad",
    **dict.fromkeys(QUATERNION, "dimensionless"),
}  # fmt: skip


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
    table = read_table_file(path)
    mapping = recognised(table, mapping or canonical_columns(TABLE_UNITS))
    names = [
        name for name in TABLE_UNITS if name in ("t_s", "x_m", "y_m") or mapping.has(table, name)
    ]
    columns = {name: _column(table, mapping, name) for name in names}
    t = columns.pop("t_s")
    header = mapping.mapped["t_s"].name

    def fault(problem: str, index: int) -> DataError:
        return table.fault(problem, header, index)

    notes: tuple[str, ...] = ()
    if header not in table.units and mapping.mapped["t_s"].unit == "s":
        factor, notes = stamp_factor(t, "s", fault=fault)
        t = t * factor
    poses = np.column_stack(list(columns.values()))
    kept, more = kept_stamps(t, poses, fault=fault)
    zero = np.zeros(len(t))
    position = np.column_stack([columns.get(name, zero) for name in ("x_m", "y_m", "z_m")])
    rotation = _rotation(columns, fault)
    return TableTrajectory(
        path=RigidPath(t, position, rotation).part(kept),
        in_space="z_m" in columns,
        source=mapping.source or table.source or "unknown",
        notes=(*table.notes, *notes, *more),
        files=(path, *([mapping.file] if mapping.file else [])),
    )


def recognised(table: RawTable, mapping: MappedColumns) -> MappedColumns:
    """Map columns that are missing and not mapped in a file to headers that are recognised."""
    for name, seen in named_columns(list(table.columns)).items():
        free = name in mapping.mapped and mapping.mapped[name].name == name
        if free and not mapping.has(table, name):
            mapping = mapping.called(name, seen.header)
    return mapping


def _column(table: RawTable, mapping: MappedColumns, name: str) -> Array:
    return mapping.numbers(
        table, name, what=f"{name} of the trajectory", advice="leave such poses out"
    )


def _rotation(columns: dict[str, Array], fault: Fault) -> Array | None:
    if set(QUATERNION) <= set(columns):
        quaternion = np.column_stack([columns[name] for name in QUATERNION])
        length = np.linalg.norm(quaternion, axis=1)
        wrong = np.abs(length - 1) > 0.05
        if wrong.any():
            index = int(np.argmax(wrong))
            raise fault(f"quaternion length {length[index]:.4g}; expected 0.95 to 1.05", index)
        return rotations_of_quaternions(quaternion)
    if "yaw_rad" not in columns:
        return None
    half = columns["yaw_rad"] / 2
    zero = np.zeros_like(half)
    return rotations_of_quaternions(np.column_stack([zero, zero, np.sin(half), np.cos(half)]))
