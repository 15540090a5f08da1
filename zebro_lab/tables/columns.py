# SPDX-License-Identifier: MIT
"""`columns.toml`: map the columns of a table to canonical columns in SI.

The keys are described in docs/formats.md; `zebro-lab init FILE` writes a commented example.
"""

import math
from collections.abc import Mapping
from dataclasses import dataclass, field
from pathlib import Path
from types import MappingProxyType

from model.slip.definition import SlipDefinition
from rig.nearest_name import nearest
from zebro_lab.files.errors import SettingsError
from zebro_lab.files.settings_table import SettingsTable, read_settings
from zebro_lab.tables.row_conditions import RowCondition, parse_row_condition

COLUMNS_FILE = "columns.toml"


@dataclass(frozen=True)
class CanonicalColumn:
    """A column that a calibration uses.

    Attributes:
        name: Its canonical name.
        unit: Its SI unit; None if it is not numeric.
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
        CanonicalColumn("slip_ratio", "dimensionless", "slip, where it is given: with definition"),
        CanonicalColumn("normal_force", "N", "normal force, positive when pressed together"),
        CanonicalColumn("traction_force", "N", "traction force, positive when driving"),
        CanonicalColumn("run", None, "name or number of the run"),
        CanonicalColumn("slip_definition", None, "material, travel or larger; one a file"),
    )
})  # fmt: skip
_CONSTANTS = {"radius_leg": "m", "radius_ground": "m"}
_LOAD_CELL = {
    "zero_stability": "N",
    "gain_sd": "dimensionless",
    "bias_sd": "N",
    "crosstalk_sd": "dimensionless",
}
_SOURCES = ("real", "sim", "replay", "unknown")


@dataclass(frozen=True)
class MappedColumn:
    """The column of a file that a canonical column is read from.

    Attributes:
        name: Its header in the file.
        unit: Its unit in the file.
        factor: Factor from the file's numbers to SI with the canonical sign.
        definition: Slip definition, for `slip_ratio` only.
    """

    name: str
    unit: str = ""
    factor: float = 1.0
    definition: SlipDefinition | None = None


@dataclass(frozen=True)
class RunRule:
    """Rule that separates the rows of one file into runs.

    Without a rule, runs are separated by the `run` column; without that, the file is one run.

    Attributes:
        by: Columns, by their headers in the file; a change of value starts a run.
        gap: A longer interval between samples starts a run [s]; None for no such rule.
        each_row: Every row is the average of a trial and therefore a run.
    """

    by: tuple[str, ...] = ()
    gap: float | None = None
    each_row: bool = False


@dataclass(frozen=True)
class Columns:
    """Content of a `columns.toml`.

    Attributes:
        file: The file itself; None for the canonical names in SI, without a file.
        source: "real", "sim:what" or "replay:what"; None if not stated.
        columns: Mapped columns by canonical name.
        constants: Canonical columns that are constant for the whole rig, in SI.
        runs: Rule that separates runs.
        keep: Conditions that every row must meet.
        load_cell: Standard deviations from the load cell's certificate, SI.
    """

    file: Path | None = None
    source: str | None = None
    columns: Mapping[str, MappedColumn] = field(default_factory=dict)
    constants: Mapping[str, float] = field(default_factory=dict)
    runs: RunRule = RunRule()
    keep: tuple[RowCondition, ...] = ()
    load_cell: Mapping[str, float] = field(default_factory=dict)


def read_columns(file: Path) -> Columns:
    """Read and check a `columns.toml`.

    Raises:
        NotFound: There is no such file.
        SettingsError: It is not TOML, or has an unknown key, unit or value.
    """
    return parse_columns(read_settings(file, advice=f"expected a {COLUMNS_FILE}"))


def parse_columns(table: SettingsTable) -> Columns:
    """Parse and check the content of a `columns.toml`.

    Args:
        table: Its content, or a section of one; no other keys are allowed.

    Raises:
        SettingsError: It has an unknown key, unit or value.
    """
    columns = table.table("columns")
    columns_file = Columns(
        file=Path(table.file),
        source=_source(table),
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
    """Parse header, unit and sign of one mapped column.

    Args:
        columns: Section that has an entry for the column: a table, or only its header.
        name: Its canonical name.
        si_unit: Its SI unit; None if it is not numeric.

    Raises:
        SettingsError: Header, unit or sign is invalid.
    """
    found = columns.value(name)
    if isinstance(found, str):  # t = "ET": only a header, in SI
        found = {"name": found}
    table = columns.as_table(name, found, expected="a table with name, unit, sign")
    unit, factor = table.factor("unit", si_unit) if si_unit else ("", 1.0)
    sign = table.sign("sign") if si_unit else 1
    definition = None
    if name == "slip_ratio" and "definition" in table:
        key = table.dotted("definition") or ""
        definition = parse_definition(table.value("definition"), file=Path(table.file), key=key)
    return MappedColumn(table.text("name", name), unit, sign * factor, definition)


def parse_definition(text: object, *, file: Path | None, key: str) -> SlipDefinition:
    """Parse the name of a slip definition.

    Args:
        text: Name of the definition.
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


def _source(table: SettingsTable) -> str | None:
    if "source" not in table:
        return None
    source = table.text("source")
    if source.split(":")[0] not in _SOURCES:
        raise table.fault(f"'{source}' is none of 'real', 'sim:WHAT', 'replay:WHAT'", "source")
    return source


def _runs(table: SettingsTable) -> RunRule:
    runs = table.table("runs")
    given = [key for key in ("by", "gap", "each_row") if key in runs]
    if len(given) > 1:
        raise table.fault(f"{' and '.join(given)} at once; give one of them", "runs")
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
