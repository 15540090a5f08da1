# SPDX-License-Identifier: MIT
"""`columns.toml`: how a lab's own tables map to the canonical columns in SI.

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
    """A column the calibration knows.

    Attributes:
        name: Its canonical name.
        unit: Its SI unit; None where it holds no number.
        meaning: One line, with the sign.
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
    """Where a canonical column comes from.

    Attributes:
        name: Its header in the file.
        unit: Its unit in the file.
        factor: What takes the file's numbers to SI with the canonical sign; `unit` and sign.
        definition: Slip definition, for `slip_ratio` alone.
    """

    name: str
    unit: str = ""
    factor: float = 1.0
    definition: SlipDefinition | None = None


@dataclass(frozen=True)
class RunRule:
    """What separates the runs of one file; without any of them a `run` column, else the file.

    Attributes:
        by: Columns, by their names in the file, whose change starts a run.
        gap: Pause that starts a run when it is exceeded [s]; None for no such rule.
        each_row: Every row is the average of a trial and so a run of its own.
    """

    by: tuple[str, ...] = ()
    gap: float | None = None
    each_row: bool = False


@dataclass(frozen=True)
class Columns:
    """What a `columns.toml` says.

    Attributes:
        file: The file itself; None for the canonical names in SI, without a file.
        source: "real", "sim:what" or "replay:what"; None where it does not say.
        columns: Mapped columns by canonical name.
        constants: Canonical columns that are one number for the whole rig, SI.
        runs: What separates runs.
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
        SettingsError: It is no TOML, or holds an unknown key, unit or value.
    """
    return parse_columns(read_settings(file, advice=f"expected a {COLUMNS_FILE}"))


def parse_columns(table: SettingsTable) -> Columns:
    """Check what a `columns.toml` holds.

    Args:
        table: Its content, or a section of one; every key is taken.

    Returns:
        What it says.

    Raises:
        SettingsError: It holds an unknown key, unit or value.
    """
    columns = table.table("columns")
    said = Columns(
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
    return said


def parse_mapped_column(columns: SettingsTable, name: str, si_unit: str | None) -> MappedColumn:
    """Take header, unit and sign of one column.

    Args:
        columns: The section that has an entry for it: a table, or its header alone.
        name: Its canonical name.
        si_unit: Its SI unit; None where it holds no number.

    Returns:
        Where the column comes from.

    Raises:
        SettingsError: Header, unit or sign cannot be followed.
    """
    found = columns.value(name)
    if isinstance(found, str):  # t = "ET": a name alone, in SI
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
    """Read the name of a slip definition.

    Raises:
        SettingsError: It is none.
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
