# SPDX-License-Identifier: MIT
"""`columns.toml`: map the columns of a table to canonical columns in SI.

The keys are described in docs/formats.md; `zebro-lab init FILE` writes a commented example.
"""

import math
from collections.abc import Mapping
from dataclasses import dataclass, field, replace
from pathlib import Path
from types import MappingProxyType

import numpy as np
from numpy.typing import NDArray

from model.slip.definition import SlipDefinition
from rig.nearest_name import nearest
from zebro_lab.files.errors import SettingsError, UnitError
from zebro_lab.files.settings_table import SettingsTable
from zebro_lab.files.units import counts_turns, factor_to_si, is_unit_text, may_be_gradian
from zebro_lab.tables.column_sections import RIG, read_section
from zebro_lab.tables.date_cells import is_date_unit, seconds_of_dates
from zebro_lab.tables.header_units import unit_in_header
from zebro_lab.tables.raw_table import RawTable
from zebro_lab.tables.row_conditions import RowCondition, parse_row_condition

COLUMNS_FILE = "columns.toml"


@dataclass(frozen=True)
class CanonicalColumn:
    """A column that a calibration uses.

    Attributes:
        name: Canonical name of the column.
        unit: SI unit of the column; None if its cells are text.
        meaning: Description in one line, with the sign convention.
    """

    name: str
    unit: str | None
    meaning: str


CANONICAL: Mapping[str, CanonicalColumn] = MappingProxyType({
    column.name: column
    for column in (
        CanonicalColumn("t", "s", "time, increasing within a run"),
        CanonicalColumn("omega_leg", "rad/s", "angular speed of the leg disc"),
        CanonicalColumn("omega_ground", "rad/s", "angular speed of the ground disc"),
        CanonicalColumn("radius_leg", "m", "radius of the leg disc at the contact"),
        CanonicalColumn("radius_ground", "m", "radius of the ground disc at the contact"),
        CanonicalColumn("slip_ratio", "dimensionless", "slip ratio, with its definition"),
        CanonicalColumn("normal_force", "N", "normal force, positive when pressed together"),
        CanonicalColumn("traction_force", "N", "traction force, positive when driving"),
        CanonicalColumn("run", None, "name or number of the run"),
        CanonicalColumn("slip_definition", None, "material, travel or larger; one in each file"),
    )
})  # fmt: skip
_CONSTANTS = {"radius_leg": "m", "radius_ground": "m"}
_LOAD_CELL = {
    "zero_stability": "N",
    "gain_sd": "dimensionless",
    "bias_sd": "N",
    "crosstalk_sd": "dimensionless",
}
_SOURCES = ("real", "sim", "replay", "import", "mixed", "unknown")
"""Kinds of source; `import` and `mixed` only stand beside exported tables."""


@dataclass(frozen=True)
class MappedColumn:
    """The column of a file that a canonical column is read from.

    Attributes:
        name: Header of the column in the file, which may lack it.
        unit: Unit of the column in the file; "" for text.
        factor: Multiplies the file's numbers to give SI with the canonical sign.
        definition: Slip definition, for `slip_ratio` only; None if not stated.
        unit_stated: Whether the column map states the unit; else that of the file holds, if any.
        offset: Added to the numbers in SI: where zero is elsewhere than the canonical column's.
        nanoseconds: Header of a column of nanoseconds to add to a time; None without one.
        scale: Multiplies the file's numbers to give numbers in the unit; contained in `factor`.
    """

    name: str
    unit: str = ""
    factor: float = 1.0
    definition: SlipDefinition | None = None
    unit_stated: bool = False
    offset: float = 0.0
    nanoseconds: str | None = None
    scale: float = 1.0

    @property
    def said(self) -> str:
        """The header with the unit that its numbers are in: `'FT_mN' in mN times 0.001`."""
        scale = f"{self.scale:g} " if self.scale != 1 else ""
        turns = ", revolutions per minute," if counts_turns(self.unit, "rad/s") else ""
        factor = f" times {self.factor:g}" if self.factor != 1 else ""
        return f"'{self.name}' in {scale}{self.unit}{turns}{factor}"

    def in_si(self, table: RawTable) -> NDArray[np.float64]:
        """Return the column's numbers in SI with the canonical sign, shape (n,); NaN where empty.

        The unit that the file states is taken into account by `in_unit_of`.

        Args:
            table: The table that the column is read from.

        Raises:
            DataError: The column is missing or ambiguous, or a cell is not a number (a date, if the
                unit says so).
        """
        if is_date_unit(self.unit):
            values = self.factor * seconds_of_dates(table, self.name, self.unit)
        else:
            values = table.numbers(self.name) * self.factor
        if self.nanoseconds is not None:
            values = values + 1e-9 * table.numbers(self.nanoseconds)
        return values + self.offset if self.offset else values

    def in_unit_of(self, table: RawTable, si_unit: str | None) -> "MappedColumn":
        """Return the column with the unit that the file states for it, unless the map states one.

        Args:
            table: The table that the column is read from.
            si_unit: SI unit of the canonical column; None if its cells are text.

        Raises:
            DataError: The unit of the file is unknown or measures another quantity.
        """
        if self.unit_stated or si_unit is None:
            return self
        unit = table.unit_of(self.name, si_unit)
        if unit is None:
            return self
        advice = f'state unit = "{si_unit}" or what it is in {COLUMNS_FILE}, {_scaled(si_unit)}'
        if unit == unit_in_header(self.name) and not is_unit_text(unit):
            problem = f"'{unit}' in the header is no unit that is known; {advice}"
            raise table.fault(problem, self.name)
        if may_be_gradian(unit):
            problem = f"the file states 'grad', which may be degrees or gradians; {advice}"
            raise table.fault(problem, self.name)
        try:
            factor = factor_to_si(unit, si_unit)
        except UnitError as error:
            problem = f"the file states its unit: {error}; {advice}"
            raise table.fault(problem, self.name) from error
        return replace(self, unit=unit, factor=math.copysign(factor, self.factor))


@dataclass(frozen=True)
class RunRule:
    """Rule that separates the rows of one file into runs; at most one attribute is given.

    Without a rule, a change in the `run` column starts a run; without that, the file is one run.

    Attributes:
        by: Columns, by their headers in the file; a change of value in one starts a new run.
        gap: Interval between samples beyond which a new run starts [s]; None if not given.
        each_row: Whether every row is the mean of one trial, and therefore a run.
    """

    by: tuple[str, ...] = ()
    gap: float | None = None
    each_row: bool = False


@dataclass(frozen=True)
class Columns:
    """Content of a `columns.toml`.

    Attributes:
        file: The `columns.toml` itself; None without one: headers are canonical names, in SI.
        source: "real", "sim:what", "replay:what" or "unknown"; None if not stated.
        sheet: Sheet of a workbook to read; None for the only one.
        columns: Mapped columns by canonical name; only those with an entry.
        constants: Given radii of the discs, `radius_leg` and `radius_ground` [m], by name.
        runs: Rule that separates rows into runs.
        keep: Conditions that every kept row must meet, all of them.
        load_cell: Given standard deviations from the load cell's certificate by name, SI:
            `zero_stability`, `gain_sd`, `bias_sd`, `crosstalk_sd`.
    """

    file: Path | None = None
    source: str | None = None
    sheet: str | None = None
    columns: Mapping[str, MappedColumn] = field(default_factory=dict)
    constants: Mapping[str, float] = field(default_factory=dict)
    runs: RunRule = RunRule()
    keep: tuple[RowCondition, ...] = ()
    load_cell: Mapping[str, float] = field(default_factory=dict)


def read_columns(file: Path) -> Columns:
    """Read and check a `columns.toml`.

    Raises:
        NotFound: There is no such file.
        SettingsError: The file cannot be read as TOML, has an unknown key, unit or value, or more
            than one run rule.
    """
    return parse_columns(read_section(RIG, file))


def parse_columns(table: SettingsTable) -> Columns:
    """Parse and check the content of a `columns.toml`.

    Args:
        table: Content of the file, or a section of it; no other keys are allowed.

    Raises:
        SettingsError: It has an unknown key, unit or value, or more than one run rule.
    """
    columns = table.table("columns")
    columns_file = Columns(
        file=Path(table.file),
        source=_source(table),
        sheet=table.text("sheet") if "sheet" in table else None,
        columns={
            name: parse_mapped_column(columns, name, column.unit)
            for name, column in CANONICAL.items()
            if name in columns
        },
        constants=_quantities(table.table("constants"), _CONSTANTS),
        runs=_runs(table),
        keep=_keep(table.table("rows")),
        load_cell=_quantities(table.table("load_cell"), _LOAD_CELL, least=0.0),
    )
    table.finish()
    return columns_file


def parse_mapped_column(columns: SettingsTable, name: str, si_unit: str | None) -> MappedColumn:
    """Parse header, unit, scale and sign of one mapped column, and the definition of a slip ratio.

    By default the header is the canonical name, the unit SI, scale and sign 1.

    Args:
        columns: Section with an entry for the column: a table, or only the header as a string.
        name: Canonical name of the column.
        si_unit: SI unit of the column; None if its cells are text.

    Raises:
        SettingsError: Header, unit, scale, sign or slip definition is invalid.
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


def parse_definition(text: object, *, file: Path | None, key: str) -> SlipDefinition:
    """Parse the name of a slip definition.

    Args:
        text: Name of the definition: material, travel or larger.
        file: File that it was read from, for the error message.
        key: Key or column that it was read from, for the error message.

    Raises:
        SettingsError: There is no definition of this name.
    """
    try:
        return SlipDefinition(str(text))
    except ValueError as error:
        advice = nearest(str(text), list(SlipDefinition))
        raise SettingsError(
            f"unknown slip definition '{text}'; {advice}", file=file, key=key
        ) from error


def _unit(table: SettingsTable, si_unit: str) -> tuple[str, float]:
    unit = table.text("unit") if "unit" in table else si_unit
    if si_unit == "s" and is_date_unit(unit):
        return unit, 1.0
    try:
        return unit, factor_to_si(unit, si_unit)
    except UnitError as error:
        raise table.fault(f"{error}, {_scaled(si_unit)}", "unit") from error


def _scaled(si_unit: str) -> str:
    unit = "" if si_unit == "dimensionless" else f" {si_unit}"
    return f'or scale = NUMBER, unit = "{si_unit}" if 1 in the file is NUMBER{unit}'


def _scale(table: SettingsTable, unit: str) -> float:
    """Read the number that converts the file's numbers to the unit, which must be stated then."""
    if "scale" not in table:
        return 1.0
    if not unit or is_date_unit(unit):
        found = f"the unit '{unit}'" if unit else "no unit"
        raise table.fault(f'stands beside {found}; expected one, such as unit = "ms"', "scale")
    return table.quantity("scale", "dimensionless", above=0.0)


def _sign(table: SettingsTable) -> int:
    """Read a sign: a number, or a text as where a question mark was deleted."""
    if "sign" not in table:
        return 1
    found = table.value("sign")
    if isinstance(found, bool) or found not in (1, -1, "1", "+1", "-1"):
        raise table.fault(f"found {found!r}; expected 1 or -1", "sign")
    return int(found)


def _source(table: SettingsTable) -> str | None:
    if "source" not in table:
        return None
    source = table.text("source")
    if source.split(":")[0] not in _SOURCES:
        raise table.fault(f"found '{source}'; expected real, sim:WHAT or replay:WHAT", "source")
    return source


def _runs(table: SettingsTable) -> RunRule:
    runs = table.table("runs")
    given = [key for key in ("by", "gap", "each_row") if key in runs]
    if len(given) > 1:
        raise table.fault(f"found {' and '.join(given)}; keep only one of them", "runs")
    return RunRule(
        by=runs.texts("by"),
        gap=runs.quantity("gap", "s", above=0.0) if "gap" in runs else None,
        each_row=runs.flag("each_row", False),
    )


def _keep(rows: SettingsTable) -> tuple[RowCondition, ...]:
    try:
        return tuple(map(parse_row_condition, rows.texts("keep")))
    except SettingsError:
        raise
    except ValueError as error:
        raise rows.fault(str(error), "keep") from error


def _quantities(
    table: SettingsTable, units: Mapping[str, str], *, least: float = -math.inf
) -> dict[str, float]:
    return {
        key: table.quantity(key, unit, least=least) for key, unit in units.items() if key in table
    }
