# SPDX-License-Identifier: MIT
"""Read measured leg angles from a table, a walk folder or a recorded run."""

from collections.abc import Sequence
from pathlib import Path

from model.robot import N_LEGS
from zebro_lab.files.errors import DataError
from zebro_lab.files.names import PATH_CSV
from zebro_lab.files.replacement import settle
from zebro_lab.robot.leg_log import ANGLES, LEG_UNITS, LegLog, legs_of_table
from zebro_lab.runs.recorded_legs import is_recorded, read_recorded_legs
from zebro_lab.tables.column_sections import LEGS, read_section
from zebro_lab.tables.columns import COLUMNS_FILE
from zebro_lab.tables.mapped_columns import MappedColumns, canonical_columns, parse_mapped_columns
from zebro_lab.tables.table_files import read_table_file


def read_leg_log(
    path: Path, *, columns: Path | None = None, leg_sign: Sequence[int] = (1,) * N_LEGS
) -> LegLog:
    """Read leg angles over time from CSV or Parquet: `t` [s] and `theta1` to `theta6` [rad].

    Other names and units are mapped by a `columns.toml`. Angles may be wrapped to one turn.

    Args:
        path: Table file; a walk folder, read from its path.csv; or a recorded run, to be decoded.
        columns: A `columns.toml` instead of the one beside the table; ignored for a recorded run.
        leg_sign: Factor of each leg's angles, 1 or -1, shape (6,); see robot.toml.

    Raises:
        NotFound: A file does not exist.
        SettingsError: The `columns.toml` has an invalid value.
        DataError: The file or run cannot be read, a leg is missing, a cell holds no finite number,
            there are not two rows, time does not increase or has a gap of over 5 median intervals,
            or a leg turns by more than 2.5 rad between samples; names the cell, if it is one.
    """
    if is_recorded(path):
        table, files = read_recorded_legs(path)
        return legs_of_table(table, _read_columns(None), files=files, leg_sign=leg_sign)
    file = _table_of(path)
    mapping = _read_columns(_columns_file(file, columns))
    return legs_of_table(
        read_table_file(file, sheet=mapping.sheet), mapping, files=(file,), leg_sign=leg_sign
    )


def _table_of(path: Path) -> Path:
    settle(path)
    if not path.is_dir():
        return path
    if (path / PATH_CSV).is_file():
        return path / PATH_CSV
    raise DataError(
        f"is a folder without {PATH_CSV} or run.json; give a walk folder, a run folder, or a CSV "
        f"or Parquet file with the columns t and {ANGLES[0]} to {ANGLES[-1]}",
        file=path,
    )


def _columns_file(table: Path, named: Path | None) -> Path | None:
    beside = table.parent / COLUMNS_FILE
    return named or (beside if beside.is_file() else None)


def _read_columns(file: Path | None) -> MappedColumns:
    if file is None:
        return canonical_columns(LEG_UNITS)
    return parse_mapped_columns(read_section(LEGS, file), LEG_UNITS)
