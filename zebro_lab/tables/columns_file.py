# SPDX-License-Identifier: MIT
"""Read and check a `columns.toml`: of a rig, of a time series, and the map of each column.

The keys are described in docs/formats.md; `zebro-lab init FILE` writes a commented example.
"""

import math
from collections.abc import Mapping
from pathlib import Path

from zebro_lab.files.errors import NotFound, UnitError
from zebro_lab.files.settings_table import SettingsTable
from zebro_lab.files.units import factor_to_si
from zebro_lab.tables.columns import RIG, TRACK, Columns, MappedColumn
from zebro_lab.tables.columns_sections import read_nearest, read_section, read_source
from zebro_lab.tables.date_cells import is_date_unit
from zebro_lab.tables.header_units import scaled
from zebro_lab.tables.rig_columns import (
    RIG_UNITS,
    RigColumns,
    RigErrorsStated,
    RunRule,
    parse_definition,
)
from zebro_lab.tables.row_conditions import read_row_conditions

_CONSTANTS = {"radius_leg": "m", "radius_ground": "m", "normal_force": "N"}
LARGEST_LOAD_CELL_ERROR = {"dimensionless": 0.2}
"""Largest relative error or crosstalk of a load cell that a number without a unit can state."""
_LOAD_CELL = {
    "zero_stability": "N",
    "gain_sd": "dimensionless",
    "bias_sd": "N",
    "crosstalk_sd": "dimensionless",
}
LARGEST_RIG_ERROR = {"m": 0.005, "dimensionless": 0.2}
"""Largest standard deviation of a rig's error that a number without a unit can state, by unit."""
_RIG_ERRORS = {
    "radius": "m",
    "radius_ratio": "dimensionless",
    "rolling_resistance": "dimensionless",
    "run_out": "m",
}


def read_columns(file: Path) -> RigColumns:
    """Read and check a `columns.toml`.

    Raises:
        NotFound: There is no such file.
        SettingsError: The file cannot be read as TOML, has an unknown key, unit or value, or more
            than one run rule.
    """
    return parse_columns(read_section(RIG, file))


def rig_columns(table: Path, named: Path | None = None) -> RigColumns:
    """Read the column map of a table of a rig: that named, else the nearest, else the default.

    Args:
        table: Path of the table.
        named: A `columns.toml`; None for the nearest, from the table's folder upwards, if any.

    Raises:
        NotFound, SettingsError: As `read_columns`.
    """
    entries = read_section(RIG, named) if named else read_nearest(RIG, table.parent)
    return RigColumns() if entries is None else parse_columns(entries)


def parse_columns(table: SettingsTable) -> RigColumns:
    """Parse and check the content of a `columns.toml`.

    Args:
        table: Content of the file, or a section of it; no other keys are allowed.

    Raises:
        SettingsError: It has an unknown key, unit or value, or more than one run rule.
    """
    columns_file = RigColumns(
        file=Path(table.file),
        source=read_source(table),
        sheet=table.text("sheet") if "sheet" in table else None,
        columns=_mapped_columns(table, RIG_UNITS),
        constants=_quantities(table.table("constants"), _CONSTANTS, {}),
        runs=_runs(table),
        keep=read_row_conditions(table.table("rows")),
        load_cell=_quantities(
            table.table("load_cell"), _LOAD_CELL, LARGEST_LOAD_CELL_ERROR, least=0.0
        ),
        priors=_priors(table.table("priors")),
        rig_errors=RigErrorsStated(
            **_quantities(table.table("rig_errors"), _RIG_ERRORS, LARGEST_RIG_ERROR, above=0.0)
        ),
    )
    table.finish()
    return columns_file


def parse_mapped_columns(
    table: SettingsTable, units: Mapping[str, str], *, with_rows: bool = False
) -> Columns:
    """Parse a column map; columns without an entry keep their canonical name and unit.

    Args:
        table: Table with the keys `source`, `sheet` and `columns`, all optional; no others are
            allowed.
        units: SI unit of each column, by canonical name.
        with_rows: Whether it may have the section `rows`, too, which says which rows are read.

    Raises:
        SettingsError: A key, a header, a unit or a sign is invalid.
    """
    columns = _mapped_columns(table, units)
    source = table.text("source") if "source" in table else None
    sheet = table.text("sheet") if "sheet" in table else None
    keep = read_row_conditions(table.table("rows")) if with_rows else ()
    table.finish()
    where = f"{table.path}." if table.path else ""
    return Columns(units, columns, source, Path(table.file), where, sheet, keep)


def read_mapped_columns(
    kind: str, table: Path, named: Path | None, units: Mapping[str, str], *, alone: bool = False
) -> tuple[Columns, str | None]:
    """Read the column map of a time series from the `columns.toml` that applies to its table.

    Args:
        kind: Kind of the table: `legs`, `imu` or `track`.
        table: Path of the table, or of the ROS log.
        named: A `columns.toml`; None for the nearest, from the table's folder upwards, if any.
        units: SI unit of each column, by canonical name.
        alone: Whether all entries of a named file without sections are for this table.

    Returns:
        The map, canonical names and units without a `columns.toml`; and the topic of a ROS log
        that it states, if any.

    Raises:
        NotFound: The table or the named `columns.toml` does not exist.
        SettingsError: It cannot be read, or a key, a unit or a sign is invalid.
    """
    if not table.exists():  # else a columns.toml would be judged that may be for other tables
        raise NotFound(f"{table}: no such file")
    entries = read_section(kind, named, alone=alone) if named else read_nearest(kind, table.parent)
    if entries is None:
        return Columns(units, where=f"{kind}."), None
    topic = entries.text("topic") if "topic" in entries else None
    return parse_mapped_columns(entries, units, with_rows=kind == TRACK), topic


def _mapped_columns(
    table: SettingsTable, units: Mapping[str, str | None]
) -> dict[str, MappedColumn]:
    """Parse the entries of the section `columns`, by canonical name."""
    columns = table.table("columns")
    return {
        name: parse_mapped_column(columns, name, unit)
        for name, unit in units.items()
        if name in columns
    }


def parse_mapped_column(columns: SettingsTable, name: str, si_unit: str | None) -> MappedColumn:
    """Parse header, unit, scale and sign of one mapped column, and the definition of a slip ratio.

    By default the header is the canonical name, the unit SI, scale and sign 1.

    Args:
        columns: Section with an entry for the column: a table, or only the header as a string.
        name: Canonical name of the column.
        si_unit: SI unit of the column; None if its cells are text.

    Raises:
        SettingsError: Header, unit, scale, sign, offset or slip definition is invalid.
    """
    found = columns.value(name)
    if isinstance(found, str):  # t = "ET": only a header, in SI
        found = {"name": found}
    table = columns.as_table(name, found, expected="a header, or a table with name, unit, sign")
    stated = si_unit is not None and "unit" in table
    unit, factor = _unit(table, si_unit) if si_unit else ("", 1.0)
    sign, scale = (_sign(table), _scale(table, unit if stated else "")) if si_unit else (1, 1.0)
    offset = table.quantity("offset", si_unit) if si_unit and "offset" in table else 0.0
    is_time = si_unit == "s" and "nanoseconds" in table
    nanoseconds = table.text("nanoseconds", least=1) if is_time else None
    definition = None
    if name == "slip_ratio" and "definition" in table:
        key = table.dotted("definition") or ""
        definition = parse_definition(table.value("definition"), file=Path(table.file), key=key)
    header = table.text("name", name)
    factor *= sign * scale
    return MappedColumn(header, unit, factor, definition, stated, offset, nanoseconds, scale)


def _unit(table: SettingsTable, si_unit: str) -> tuple[str, float]:
    """Read the unit of a column, by default SI; return it, and the factor that converts it to SI.

    The factor of a unit of dates is 1. Raises `SettingsError` for an unknown unit or one of another
    quantity.
    """
    unit = table.text("unit") if "unit" in table else si_unit
    if si_unit == "s" and is_date_unit(unit):
        return unit, 1.0
    try:
        return unit, factor_to_si(unit, si_unit)
    except UnitError as error:
        raise table.fault(f"{error}, {scaled(si_unit, unit)}", "unit") from error


def _scale(table: SettingsTable, unit: str) -> float:
    """Read the number that converts the file's numbers to `unit`; 1 if it is not stated.

    Raises `SettingsError` if it is stated and not above 0, or beside no unit or one of dates.
    """
    if "scale" not in table:
        return 1.0
    if not unit or is_date_unit(unit):
        found = f"the unit '{unit}'" if unit else "no unit"
        raise table.fault(f'stands beside {found}; expected one, such as unit = "ms"', "scale")
    return table.quantity("scale", "dimensionless", above=0.0)


def _sign(table: SettingsTable) -> int:
    """Read a sign, 1 or -1 as a number or a text; 1 if none is stated.

    It may be a text, since a guess such as "-1?" leaves one when its "?" is deleted. Raises
    `SettingsError` for anything else.
    """
    if "sign" not in table:
        return 1
    found = table.value("sign")
    if isinstance(found, bool) or found not in (1, -1, "1", "+1", "-1"):
        raise table.fault(f"found {found!r}; expected 1 or -1", "sign")
    return int(found)


def _runs(table: SettingsTable) -> RunRule:
    """Read the rule that separates runs; `SettingsError` if more than one of its keys is given."""
    runs = table.table("runs")
    given = [key for key in ("by", "gap", "each_row") if key in runs]
    if len(given) > 1:
        raise table.fault(f"found {' and '.join(given)}; keep only one of them", "runs")
    return RunRule(
        by=runs.texts("by"),
        gap=runs.quantity("gap", "s", above=0.0) if "gap" in runs else None,
        each_row=runs.flag("each_row", False),
        leave_out=runs.wholes("leave_out", least=1, most=10**9) if "leave_out" in runs else (),
    )


def _quantities(
    table: SettingsTable, units: Mapping[str, str], usual: Mapping[str, float], **limit: float
) -> dict[str, float]:
    """Read the quantities that are stated, in SI.

    Args:
        table: Section of the file.
        units: SI unit of each known key.
        usual: Largest number without a unit, by SI unit.
        limit: `above` or `least` of `SettingsTable.quantity`.
    """
    return {
        key: table.quantity(key, unit, usual=usual.get(unit, math.inf), **limit)
        for key, unit in units.items()
        if key in table
    }


def _priors(table: SettingsTable) -> tuple[str, ...]:
    """Return each prior as one text: a Gaussian `NAME = MEAN ± SD`, a family `NAME ~ FAMILY(…)`."""
    texts = {key: table.text(key, least=1) for key in table.unread}
    return tuple(
        f"{key} {'~' if '(' in text else '='} {text.lstrip('~= ')}" for key, text in texts.items()
    )
