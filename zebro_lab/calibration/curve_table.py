# SPDX-License-Identifier: MIT
"""Read a table of a slip curve: slip ratio and traction force at loads.

The format is described in docs/formats.md under "Table of a curve".
"""

from dataclasses import dataclass
from pathlib import Path

from model.arrays import Array
from model.slip.definition import SlipDefinition
from zebro_lab.files.errors import DataError
from zebro_lab.runs.data_paths import DataSource
from zebro_lab.tables.columns_file import read_columns
from zebro_lab.tables.rig_table import RigTable, normal_force
from zebro_lab.tables.row_conditions import kept_rows
from zebro_lab.tables.slip_source import slip
from zebro_lab.tables.table_files import read_table_file

_FEWEST = 3


@dataclass(frozen=True)
class CurveTable:
    """Points of slip curves as a table gives them.

    Attributes:
        slip: Slip ratio of each point, shape (n,) [-].
        load: Normal force of each point, shape (n,) [N].
        traction: Traction force of each point, shape (n,) [N].
        definition: Slip definition.
        source: Source as stated; "unknown" if not stated.
        files: Files that were read.
        notes: How slip was obtained and units were converted, one line each.
    """

    slip: Array
    load: Array
    traction: Array
    definition: SlipDefinition
    source: str
    files: tuple[Path, ...]
    notes: tuple[str, ...]


def is_curve_table(path: Path) -> bool:
    """Return whether a file is a table whose rows are points of a curve, not samples of runs.

    Its headers have no time, run or disc speed, and the `columns.toml` for it states no runs.
    """
    if not path.is_file():
        return False
    columns = DataSource(path, path.parent).columns()
    raw = read_table_file(path, sheet=columns.sheet)
    samples = {"t", "run", "omega_leg", "omega_ground"}
    has_runs = bool(columns.runs.by) or columns.runs.gap is not None
    return not (has_runs or samples & {*raw.columns, *columns.columns})


def read_curve_table(path: Path, *, columns: Path | None = None) -> CurveTable:
    """Read a table whose rows are points of slip curves.

    Args:
        path: The table; its columns are canonical, or mapped by the nearest `columns.toml`.
        columns: A `columns.toml` to use instead.

    Raises:
        ZebroLabError: The table or its column map cannot be read, a column or the slip definition
            is missing, a value is not finite or impossible, or there are fewer than 3 points.
    """
    entries = DataSource(path, path.parent).columns() if columns is None else read_columns(columns)
    raw = read_table_file(path, sheet=entries.sheet)
    table = RigTable(raw, entries, kept_rows(raw, entries.keep))
    if len(table.rows) < _FEWEST:
        raise DataError(f"has {len(table.rows)} points; a curve needs {_FEWEST} or more", file=path)
    ratio = slip(table)
    if table.source_of("traction_force") is None:
        raise raw.fault(
            "is missing; a table of a curve has slip_ratio, traction_force [N] and normal_force "
            f"[N]; map other headers in {table.columns.stated_in}",
            "traction_force",
        )
    sources = [each for each in (entries.source, raw.source) if each]
    return CurveTable(
        slip=ratio.ratio,
        load=normal_force(table),
        traction=table.si("traction_force"),
        definition=ratio.definition,
        source=sources[0] if sources else "unknown",
        files=(path,) if entries.file is None else (path, entries.file),
        notes=(*raw.notes, *table.conversions()),
    )
