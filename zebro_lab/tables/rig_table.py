# SPDX-License-Identifier: MIT
"""Read the columns of a rig table as checked arrays in SI."""

from collections.abc import Callable
from dataclasses import dataclass
from typing import Any

import numpy as np
import pandas as pd
from numpy.typing import NDArray

from model.arrays import Array
from zebro_lab.files.errors import DataError
from zebro_lab.tables.columns import MappedColumn
from zebro_lab.tables.date_cells import is_date_unit
from zebro_lab.tables.raw_table import OVERLOAD, RawTable
from zebro_lab.tables.rig_columns import CANONICAL, RigColumns


@dataclass(frozen=True)
class RigTable:
    """A raw table with its column map, restricted to the kept rows.

    Attributes:
        raw: The table as read from the file.
        columns: The column map.
        rows: Indices into the rows of `raw` of the n kept rows, increasing, shape (n,).
    """

    raw: RawTable
    columns: RigColumns
    rows: NDArray[np.intp]

    def source_of(self, name: str) -> MappedColumn | None:
        """Return how a canonical column is read: by the column map, else from a header of its name.

        None if the map has no entry and the table no such header. A unit in the column map prevails
        over that of the file, and without both the unit is SI. The table may lack the header that a
        column is mapped to.

        Raises:
            DataError: The file states a unit that is unknown or measures another quantity.
        """
        if name in self.columns.columns or self.columns.has(self.raw, name):
            return self.columns.mapped[name].in_unit_of(self.raw, self.columns.units[name])
        return None

    def conversions(self) -> tuple[str, ...]:
        """Return a note for each column whose factor to SI is not 1, with its unit and factor."""
        found = {name: self.source_of(name) for name in CANONICAL}
        return tuple(
            f"{name}: {column.said}" for name, column in found.items()
            if column and column.factor != 1
        )  # fmt: skip

    def required(self, name: str) -> MappedColumn:
        """Return the mapping of a canonical column: header, unit and factor, as `source_of`.

        Raises:
            DataError: The column is neither mapped nor a header of the table, or as in `source_of`.
        """
        source = self.source_of(name)
        if source is None:
            raise self.columns.missing(self.raw, name, what=CANONICAL[name].meaning.split(",")[0])
        return source

    def si(self, name: str) -> Array:
        """Return the kept rows of a canonical column in SI, with canonical sign, shape (n,).

        Raises:
            DataError: The column is missing or ambiguous, a cell of any row is not a number, or one
                of a kept row is empty or infinite.
        """
        source = self.required(name)
        values = source.in_si(self.raw)[self.rows]
        keep = f'"`{source.name}` > -{OVERLOAD:g}", "`{source.name}` < {OVERLOAD:g}"'
        expected = (
            f"finite numbers: delete such rows, or skip them with [rows] keep = [{keep}] in "
            f"{self.columns.stated_in}"
        )
        self.raw.require_finite(source.name, values, expected, rows=self.rows)
        return values

    def unused(self) -> dict[str, Array]:
        """Return the kept rows of columns that are not mapped, by header, shape (n,) each.

        Those that separate runs, that are no numbers, or that lack some, are left out.
        """
        used = {source.name for name in CANONICAL if (source := self.source_of(name))}
        found = {}
        for name, cells in self.raw.columns.items():
            if name in used or name in self.columns.runs.by or name in self.raw.repeated:
                continue
            numbers: Any = pd.to_numeric(cells, errors="coerce")  # pandas' stub has every result
            values = np.asarray(numbers, dtype=float)[self.rows]
            if np.isfinite(values).all():
                found[name] = values
        return found

    def texts(self, name: str) -> NDArray[np.object_]:
        """Return the kept rows of a canonical column as in the file, not converted, shape (n,).

        Raises:
            DataError: The column is missing or ambiguous.
        """
        return self.raw.column(self.required(name).name).to_numpy(dtype=object)[self.rows]

    def radii(self) -> dict[str, float]:
        """Return the radii that are given, a column's as its median, by their names [m]."""
        known = ("radius_leg", "radius_ground")
        given = [name for name in known if name in self.columns.constants or self.source_of(name)]
        return {name: float(np.median(self.constant_or_column(name))) for name in given}

    def constant_or_column(self, name: str) -> float | Array:
        """Return a radius [m] or the normal force [N]: a number from `[constants]`, or a column.

        Raises:
            DataError: It is missing, given as both, or not a positive finite number.
        """
        constant, source = self.columns.constants.get(name), self.source_of(name)
        unit = CANONICAL[name].unit
        if constant is not None and source is not None:
            raise self.raw.fault(
                f"is given twice, in this column and as [constants] {name} = {constant:g} {unit} "
                f"in {self.columns.stated_in}; delete one of them",
                source.name,
            )
        if constant is None:
            if source is None:
                raise self.raw.fault(
                    "the radius is missing, but needed with the speeds of the discs; give it in "
                    f'{self.columns.stated_in}, such as [constants] {name} = "35 mm", or in a '
                    "column",
                    name,
                )
            values = self.si(name)
            self.require(name, values > 0, lambda v: f"is {v}; expected more than 0 {unit}")
            return values
        if constant <= 0:
            raise DataError(
                f"{name} in [constants] is {constant:g} {unit}; expected more than 0 {unit}",
                file=self.columns.file or self.raw.path, column=name, value=constant, unit=unit,
            )  # fmt: skip
        return constant

    @property
    def traction(self) -> str:
        """Canonical column that gives the traction: the force, or where it lacks a coefficient."""
        names = ("traction_force", "traction_coefficient")
        return next((name for name in names if self.source_of(name)), names[0])

    def require(self, name: str, good: NDArray[np.bool_], problem: Callable[[str], str]) -> None:
        """Check a condition on a column; the error names the first row that fails it.

        Args:
            name: Canonical name of the column.
            good: Whether each kept row is valid, shape (n,).
            problem: Formats the message, given the cell's value with its unit.

        Raises:
            DataError: A row is invalid.
        """
        if good.all():
            return
        source, row = self.required(name), int(self.rows[np.argmin(good)])
        # The message quotes the cell as it is in the file, unless more than a unit was converted.
        si = is_date_unit(source.unit) or source.offset or source.nanoseconds or source.scale != 1
        value = float((source.in_si(self.raw) if si else self.raw.numbers(source.name))[row])
        unit = CANONICAL[name].unit or "" if si else source.unit
        unit = "" if unit == "dimensionless" else unit
        text = problem(f"{value:g} {unit}".rstrip())
        raise self.raw.fault(text, source.name, row, value=value, unit=unit or source.unit)


def normal_force(table: RigTable) -> Array:
    """Return the normal force, positive everywhere, shape (n,) [N].

    Raises:
        DataError: The column is missing, there is one beside a constant, or a row's normal force is
            not finite or not positive; the message proposes the other sign if more than 90 % are
            negative.
    """
    if "normal_force" in table.columns.constants:
        return np.full(len(table.rows), table.constant_or_column("normal_force"))
    force = table.si("normal_force")
    mostly_negative = np.mean(force < 0) > 0.9
    advice = (
        "nearly all rows are negative: set [columns.normal_force] sign = "
        f"{-1 if table.required('normal_force').factor > 0 else 1} in {table.columns.stated_in}"
        if mostly_negative
        else f"skip unloaded rows with [rows] keep in {table.columns.stated_in}"
    )
    table.require(
        "normal_force",
        force > 0,
        lambda value: f"the normal force is {value}; expected more than 0 when pressed; {advice}",
    )
    return force


def traction(table: RigTable, pressed: Array) -> tuple[Array, Array | None]:
    """Return the traction force and its standard deviation, None without, each of shape (n,) [N].

    Args:
        table: The table, with a force, or with a coefficient, which the normal force multiplies.
        pressed: Normal force of its rows, shape (n,) [N].

    Raises:
        DataError: There is neither column, a cell is not a finite number, or a standard deviation
            is not above 0.
    """
    name, of_it = table.traction, f"{table.traction}_sd"
    scale = 1.0 if name == "traction_force" else pressed
    if table.source_of(of_it) is None:
        return scale * table.si(name), None
    sd = table.si(of_it)
    advice = f"expected more than 0: correct it, or delete [columns.{of_it}]"
    table.require(of_it, sd > 0, lambda value: f"the standard deviation is {value}; {advice}")
    return scale * table.si(name), scale * sd
