# SPDX-License-Identifier: MIT
"""Column map of a time series: canonical names and units for the columns of a table."""

import re
from collections.abc import Mapping
from dataclasses import dataclass, field, replace
from pathlib import Path
from typing import Final

import numpy as np

from model.arrays import Array
from model.similar_name import nearest
from zebro_lab.files.settings_table import SettingsTable
from zebro_lab.tables.columns import COLUMNS_FILE, MappedColumn
from zebro_lab.tables.columns_file import parse_mapped_column
from zebro_lab.tables.columns_sections import read_nearest, read_section
from zebro_lab.tables.raw_table import RawTable
from zebro_lab.tables.row_conditions import RowCondition, read_row_conditions
from zebro_lab.tables.table_kinds import TRACK, looks_like_other

INTERVALS: Final = (2e-5, 2.0)
"""Range of the median time between samples of a table whose unit of time is not stated [s]."""

_FRAMES: Final = re.compile(
    r"(frame|sample|packet|record|scan|index|bild)[ _]*(#|no\.?|nr\.?|number|counter|index)?",
    re.IGNORECASE,
)


@dataclass(frozen=True)
class MappedColumns:
    """Column map of a time series: header, unit and sign of each canonical column.

    Attributes:
        mapped: Mapped columns, by canonical name; every canonical column has one.
        source: Source as stated in the file; None if not stated.
        file: The `columns.toml`; None without one.
        where: Dotted section in the file, with a final dot; "" for the whole file.
        sheet: Sheet of a workbook to read; None for the only one.
        units: SI unit of each canonical column.
        keep: Conditions that rows must meet to be read.
    """

    mapped: Mapping[str, MappedColumn]
    source: str | None = None
    file: Path | None = None
    where: str = ""
    sheet: str | None = None
    units: Mapping[str, str] = field(default_factory=dict)
    keep: tuple[RowCondition, ...] = ()

    @property
    def stated_in(self) -> str:
        """The `columns.toml` by its path, for messages; by its name alone where there is none."""
        return str(self.file or COLUMNS_FILE)

    def has(self, table: RawTable, name: str) -> bool:
        """Return whether a table has a column, once or repeatedly, by the header it is mapped to.

        Args:
            table: Table to look in.
            name: Canonical name of the column.
        """
        header = self.mapped[name].name
        return header in table.columns or header in table.repeated

    def states_unit(self, table: RawTable, name: str) -> bool:
        """Return whether the map or the file state the unit of a column.

        Args:
            table: Table with the column.
            name: Canonical name of the column.
        """
        mapped = self.mapped[name]
        return mapped.unit_stated or table.unit_of(mapped.name, self.units[name]) is not None

    def conversions(self, table: RawTable) -> tuple[str, ...]:
        """Return a note of the columns that are converted by the units that the file states.

        Args:
            table: Table with the columns.

        Raises:
            DataError: A unit of the file is unknown or measures another quantity.
        """
        found = [
            column.in_unit_of(table, self.units[name])
            for name, column in self.mapped.items()
            if not column.unit_stated and self.has(table, name)
        ]
        said = ", ".join(column.said for column in found if abs(column.factor) != 1)
        return (f"{table.path.name}: units are those that the file states: {said}",) * bool(said)

    def called(self, name: str, header: str) -> "MappedColumns":
        """Return a copy of the map with another header for a column; unit and sign are kept.

        Args:
            name: Canonical name of the column.
            header: New header in the file.
        """
        mapped = replace(self.mapped[name], name=header)
        return replace(self, mapped={**self.mapped, name: mapped})

    def numbers(self, table: RawTable, name: str, *, what: str, advice: str) -> Array:
        """Return a column in SI with the canonical sign, finite throughout, shape (n,).

        Args:
            table: The table.
            name: Canonical name.
            what: Description of the column, for the error message.
            advice: What to do about a cell without a number, for the error message.

        Raises:
            DataError: The column is missing, ambiguous or of dates, or a cell has no finite number;
                names the cell.
        """
        mapped = self.mapped[name]
        if not self.has(table, name):
            other = looks_like_other(table.columns, self.mapped)
            known = nearest(mapped.name, list(table.columns))
            frames = _frames(table) if self.units[name] == "s" else ""
            raise table.fault(
                f"the column of the {what} is missing{other}; {known}; if its header differs, map "
                f"it in {self.stated_in}: [{self.where}columns.{name}]{frames}",
                mapped.name,
            )
        mapped = mapped.in_unit_of(table, self.units[name])
        values = mapped.in_si(table)
        table.require_finite(mapped.name, values, f"a number in {mapped.unit}: {advice}")
        return values

    def times(self, table: RawTable, name: str, *, advice: str) -> Array:
        """Return the times of samples, as `numbers`; their unit must fit if it is not stated.

        Args:
            table: The table.
            name: Canonical name.
            advice: What to do about a cell without a number, for the error message.

        Raises:
            DataError: As in `numbers`; or neither file nor map state the unit, and in seconds the
                samples would be more than `INTERVALS` apart, or less.
        """
        values = self.numbers(table, name, what="time", advice=advice)
        mapped = self.mapped[name]
        stated = mapped.unit_stated or mapped.name in table.units
        if mapped.name != name:  # the ending of t_s itself is no statement of who wrote the file
            stated = stated or table.unit_of(mapped.name, "s") is not None
        if not stated:
            require_usual_steps(table, mapped.name, np.diff(values), f"{self.where}columns.{name}")
        return values


def require_usual_steps(table: RawTable, header: str, steps: Array, section: str) -> None:
    """Check that times whose unit nobody states are those of samples, if they are in seconds.

    Args:
        table: The table.
        header: Header of its column of times.
        steps: Differences of successive times, those between runs left out, shape (n,) [s].
        section: Dotted section of the column in a `columns.toml`, for the message.

    Raises:
        DataError: Half of the steps or more are outside `INTERVALS`.
    """
    usual = float(np.median(steps)) if len(steps) else 0.0
    if usual <= 0 or INTERVALS[0] <= usual <= INTERVALS[1]:
        return
    unit = "ms" if usual > 1 else "min"
    raise table.fault(
        f"samples are {usual:.3g} s apart, {steps.sum():.5g} s in all, if times are in s; "
        f"expected {INTERVALS[0]:g} to {INTERVALS[1]:g} s between samples: state the unit in "
        f'{COLUMNS_FILE}, such as [{section}] unit = "{unit}", or "s" if that is right',
        header,
    )


def _frames(table: RawTable) -> str:
    """Return advice for a table whose time is a number of frames; "" for others."""
    frames = next((name for name in table.columns if _FRAMES.fullmatch(name)), None)
    if frames is None:
        return ""
    return f'; of frames at 100 Hz: name = "{frames}", unit = "s", scale = 0.01'


def canonical_columns(units: Mapping[str, str]) -> MappedColumns:
    """Return the column map of a table whose headers are the canonical names, in SI units.

    Args:
        units: SI unit of each column, by canonical name.
    """
    columns = {name: MappedColumn(name, unit) for name, unit in units.items()}
    return MappedColumns(columns, units=units)


def parse_mapped_columns(
    table: SettingsTable, units: Mapping[str, str], *, with_rows: bool = False
) -> MappedColumns:
    """Parse a column map; columns without an entry keep their canonical name and unit.

    Args:
        table: Table with the keys `source`, `sheet` and `columns`, all optional; no others are
            allowed.
        units: SI unit of each column, by canonical name.
        with_rows: Whether it may have the section `rows`, too, which says which rows are read.

    Raises:
        SettingsError: A key, a header, a unit or a sign is invalid.
    """
    columns = table.table("columns")
    mapped = {
        name: parse_mapped_column(columns, name, unit)
        for name, unit in units.items()
        if name in columns
    }
    source = table.text("source") if "source" in table else None
    sheet = table.text("sheet") if "sheet" in table else None
    keep = read_row_conditions(table.table("rows")) if with_rows else ()
    table.finish()
    where = f"{table.path}." if table.path else ""
    return MappedColumns(
        {**canonical_columns(units).mapped, **mapped}, source, Path(table.file), where, sheet,
        units, keep,
    )  # fmt: skip


def read_mapped_columns(
    kind: str, table: Path, named: Path | None, units: Mapping[str, str], *, alone: bool = False
) -> tuple[MappedColumns, str | None]:
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
        NotFound: The named `columns.toml` does not exist.
        SettingsError: It cannot be read, or a key, a unit or a sign is invalid.
    """
    entries = read_section(kind, named, alone=alone) if named else read_nearest(kind, table.parent)
    if entries is None:
        return replace(canonical_columns(units), where=f"{kind}."), None
    topic = entries.text("topic") if "topic" in entries else None
    return parse_mapped_columns(entries, units, with_rows=kind == TRACK), topic
