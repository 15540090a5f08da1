# SPDX-License-Identifier: MIT
"""Columns of a table as canonical columns in SI: what a `columns.toml` states, as values."""

import math
import re
from collections.abc import Collection, Mapping
from dataclasses import dataclass, field, replace
from pathlib import Path
from typing import Final

import numpy as np

from model.arrays import Array
from model.similar_name import nearest
from model.slip.definition import SlipDefinition
from zebro_lab.files.errors import DataError, UnitError
from zebro_lab.files.units import counts_turns, factor_to_si, is_unit_text, may_be_gradian
from zebro_lab.tables.date_cells import is_date_unit, seconds_of_dates
from zebro_lab.tables.header_units import scaled, unit_in_header
from zebro_lab.tables.raw_table import RawTable
from zebro_lab.tables.row_conditions import RowCondition

LEGS, IMU, TRACK, RIG = "legs", "imu", "track", "rig"
KINDS: Final = (LEGS, IMU, TRACK, RIG)
"""Kinds of tables; their names are those of the sections of a `columns.toml`."""

_MARKS: Final = tuple(
    (frozenset(names.split()), kind)
    for names, kind in (
        ("normal_force traction_force", RIG),
        ("theta1 theta2 theta3 theta4 theta5 theta6", LEGS),
        ("x_m y_m", TRACK),
        ("x y", TRACK),
        ("roll pitch", IMU),  # last: tracks may have an orientation, too
        ("qw qx qy qz", IMU),
    )
)
"""Canonical names, in lower case, that together tell the kind of a table."""
_TAKERS: Final = {
    RIG: "a slip rig, which calibrate-slip takes",
    LEGS: "leg angles, which zebro-lab predict and import --legs take",
    TRACK: "a track, which zebro-lab validate and import --track take",
    IMU: "an IMU, which zebro-lab import takes as --imu, beside --legs",
}
"""What a table of each kind is of, and the commands and options that take it."""


def looks_like_other(headers: Collection[str], expected: Collection[str]) -> str:
    """Say which other kind of table the headers are of, and what takes it, for error messages.

    Only canonical names are recognised, in upper or lower case: other headers may mean anything.

    Args:
        headers: Headers of the table.
        expected: Canonical names of the columns that a table of the expected kind may have.

    Returns:
        A clause that begins with "; "; "" where no other kind is recognised.

    >>> looks_like_other(["t", "Roll", "Pitch"], ["t", "normal_force", "traction_force"])
    '; it looks like a table of an IMU, which zebro-lab import takes as --imu, beside --legs'
    """
    found, wanted = _kind(headers), _kind(expected)
    return "" if found in (None, wanted) else f"; it looks like a table of {_TAKERS[found]}"


def _kind(names: Collection[str]) -> str | None:
    """Return the first kind in `_MARKS` whose names all occur in any letter case; else None."""
    lower = {name.lower() for name in names}
    return next((kind for marks, kind in _MARKS if marks <= lower), None)


COLUMNS_FILE: Final = "columns.toml"
INTERVALS: Final = (2e-5, 2.0)
"""Range of the median time between samples of a table whose unit of time is not stated [s]."""

_FRAMES: Final = re.compile(
    r"(frame|sample|packet|record|scan|index|bild)[ _]*(#|no\.?|nr\.?|number|counter|index)?",
    re.IGNORECASE,
)


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

    def in_si(self, table: RawTable) -> Array:
        """Return the column's numbers in SI with the canonical sign, shape (n,); NaN where empty.

        A unit that the file states counts only if `in_unit_of` has set it before.

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
            DataError: The unit of the file is unknown, ambiguous ("grad") or of another quantity.
        """
        if self.unit_stated or si_unit is None:
            return self
        unit = table.unit_of(self.name, si_unit)
        if unit is None:
            return self
        other = scaled(si_unit, unit)
        advice = f'state unit = "{si_unit}" or what it is in {COLUMNS_FILE}, {other}'
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
class Columns:
    """Column map of a table: header, unit and sign of each canonical column.

    Attributes:
        units: SI unit of each canonical column, by name; None if its cells are text.
        columns: Mapped columns by canonical name; only those with an entry.
        source: "real", "sim:what", "replay:what" or "unknown"; None if not stated.
        file: The `columns.toml`; None without one: headers are canonical names, in SI.
        where: Dotted section in the file, with a final dot; "" for the whole file.
        sheet: Sheet of a workbook to read; None for the only one.
        keep: Conditions that rows must meet to be read, all of them.
    """

    units: Mapping[str, str | None]
    columns: Mapping[str, MappedColumn] = field(default_factory=dict)
    source: str | None = None
    file: Path | None = None
    where: str = ""
    sheet: str | None = None
    keep: tuple[RowCondition, ...] = ()

    @property
    def mapped(self) -> Mapping[str, MappedColumn]:
        """The column of every canonical name; without an entry one of that header, in SI."""
        plain = {name: MappedColumn(name, unit or "") for name, unit in self.units.items()}
        return plain | dict(self.columns)

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
        return mapped.unit_stated or table.unit_of(mapped.name, mapped.unit) is not None

    def conversions(self, table: RawTable) -> tuple[str, ...]:
        """Return a note of the columns converted by units that the file states; empty if none is.

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

    def called(self, name: str, header: str) -> "Columns":
        """Return a copy of the map with another header for a column; unit and sign are kept.

        Args:
            name: Canonical name of the column.
            header: New header in the file.
        """
        mapped = replace(self.mapped[name], name=header)
        return replace(self, columns={**self.columns, name: mapped})

    def numbers(self, table: RawTable, name: str, *, what: str, advice: str) -> Array:
        """Return a column in SI with the canonical sign, finite throughout, shape (n,).

        Args:
            table: The table.
            name: Canonical name.
            what: Description of the column, for the error message.
            advice: What to do about a cell without a number, for the error message.

        Raises:
            DataError: The column is missing, ambiguous or of dates, its unit in the file does not
                fit, or a cell has no finite number; names the cell.
        """
        mapped = self.mapped[name]
        if not self.has(table, name):
            raise self.missing(table, name, what=what)
        mapped = mapped.in_unit_of(table, self.units[name])
        values = mapped.in_si(table)
        table.require_finite(mapped.name, values, f"a number in {mapped.unit}: {advice}")
        return values

    def missing(self, table: RawTable, name: str, *, what: str) -> DataError:
        """Return, without raising, an error that a table lacks a column, and how to map it.

        Args:
            table: The table.
            name: Canonical name.
            what: Description of the column.
        """
        header = self.mapped[name].name
        other = looks_like_other(table.columns, self.mapped)
        names = table.columns if self.units[name] == "s" else ()
        frames = next((each for each in names if _FRAMES.fullmatch(each)), None)
        rate = f'; of frames at 100 Hz: name = "{frames}", unit = "s", scale = 0.01'
        return table.fault(
            f"the column of the {what} is missing{other}; {nearest(header, list(table.columns))}; "
            f"if its header differs, map it in {self.stated_in}: [{self.where}columns.{name}] "
            f"(zebro-lab init writes that file){rate if frames else ''}",
            header,
        )

    def times(self, table: RawTable, name: str, *, advice: str) -> Array:
        """Return the times of samples, as `numbers`; their unit must fit if it is not stated.

        Args:
            table: The table.
            name: Canonical name.
            advice: What to do about a cell without a number, for the error message.

        Raises:
            DataError: As in `numbers`; or neither file nor map state the unit, and the median
                step, taken in seconds, is outside `INTERVALS`.
        """
        values = self.numbers(table, name, what="time", advice=advice)
        mapped = self.mapped[name]
        stated = mapped.unit_stated or mapped.name in table.units
        if mapped.name != name:  # the ending of t_s itself is no statement of who wrote the file
            stated = stated or table.unit_of(mapped.name, "s") is not None
        if not stated:
            self.require_usual_steps(table, name, np.diff(values))
        return values

    def require_usual_steps(self, table: RawTable, name: str, steps: Array) -> None:
        """Check that times whose unit nobody states are those of samples, if they are in seconds.

        Args:
            table: The table.
            name: Canonical name of its column of times.
            steps: Differences of successive times, without those between runs, shape (n,) [s].

        Raises:
            DataError: The median step is positive and outside `INTERVALS`.
        """
        usual = float(np.median(steps)) if len(steps) else 0.0
        if usual > 0 and not INTERVALS[0] <= usual <= INTERVALS[1]:
            found = (
                f"samples are {usual:.3g} s apart, {steps.sum():.5g} s in all, if times are in s; "
                f"expected {INTERVALS[0]:g} to {INTERVALS[1]:g} s between samples"
            )
            raise self.unstated(table, name, found, unit="ms" if usual > 1 else "min")

    def unstated(
        self, table: RawTable, name: str, found: str, *, unit: str, others: str = ""
    ) -> DataError:
        """Return, without raising, an error that numbers without a stated unit do not fit SI.

        Args:
            table: The table.
            name: Canonical name of the column.
            found: What was found, and what was expected.
            unit: Unit that the numbers probably are in.
            others: Canonical names of further columns in the same unit.
        """
        return table.fault(
            f"{found}; state the unit in {self.stated_in}, such as [{self.where}columns.{name}] "
            f'unit = "{unit}"{others and f", and so for {others}"}, or "{self.units[name]}" if '
            "that is right",
            self.mapped[name].name,
        )
