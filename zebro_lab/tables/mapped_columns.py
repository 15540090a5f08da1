# SPDX-License-Identifier: MIT
"""Columns of a lab's own table under the names and units that a stage knows: time series."""

from collections.abc import Mapping
from dataclasses import dataclass, replace
from pathlib import Path
from typing import Any

import numpy as np

from model.slip.law import Array
from zebro_lab.files.errors import DataError, SettingsError, UnitError
from zebro_lab.files.known_keys import nearest, require_known
from zebro_lab.files.units import factor_to_si
from zebro_lab.tables.cells import cell_error
from zebro_lab.tables.columns import COLUMNS_FILE, MappedColumn
from zebro_lab.tables.raw_table import RawTable


@dataclass(frozen=True)
class MappedColumns:
    """Where the columns of a time series come from.

    Attributes:
        mapped: Every column that the stage knows, by its canonical name.
        source: "real", "sim:what", "replay:what"; None where nobody said.
        file: The `columns.toml`; None without one.
        where: Place in it, with a final dot; "" for all of it.
    """

    mapped: Mapping[str, MappedColumn]
    source: str | None = None
    file: Path | None = None
    where: str = ""

    def has(self, table: RawTable, name: str) -> bool:
        """Tell whether a table has a column, under the name it is mapped to."""
        header = self.mapped[name].name
        return header in table.columns or header in table.repeated

    def called(self, name: str, header: str) -> "MappedColumns":
        """Return the map with another header for a column, its unit kept."""
        mapped = replace(self.mapped[name], name=header)
        return replace(self, mapped={**self.mapped, name: mapped})

    def numbers(self, table: RawTable, name: str, *, what: str, advice: str) -> Array:
        """Return a column in SI with the canonical sign, finite throughout, shape (n,).

        Args:
            table: The table.
            name: Canonical name.
            what: What the column is, for a person.
            advice: What to do about a cell that holds no number.

        Raises:
            DataError: The column is missing, or a cell holds no finite number; names the cell.
        """
        mapped = self.mapped[name]
        if not self.has(table, name):
            raise self._missing(table, name, what)
        values = table.numbers(mapped.name)
        good = np.isfinite(values)
        if not good.all():
            index = int(np.argmin(good))
            found = "infinite" if np.isinf(values[index]) else "empty"
            expected = f"is {found}; expected a number in {mapped.unit}: {advice}"
            raise cell_error(table, mapped.name, index, expected)
        return values * mapped.factor

    def _missing(self, table: RawTable, name: str, what: str) -> DataError:
        header = self.mapped[name].name
        return DataError(
            f"missing, the {what}; {nearest(header, list(table.columns))}; map it in "
            f"{COLUMNS_FILE} as [{self.where}columns.{name}]",
            file=table.path, column=header,
        )  # fmt: skip


def canonical_columns(units: Mapping[str, str]) -> MappedColumns:
    """Return the map of a table whose names and units are the canonical ones.

    Args:
        units: SI unit of every column that the stage knows.
    """
    return MappedColumns({name: MappedColumn(name, unit) for name, unit in units.items()})


def parse_mapped_columns(
    document: Mapping[str, Any], units: Mapping[str, str], *, file: Path, where: str = ""
) -> MappedColumns:
    """Read names, units and signs; what is not mapped keeps its canonical name and unit.

    Args:
        document: The keys `source` and `columns`.
        units: SI unit of every column that the stage knows.
        file: File that is named in errors.
        where: Place of the document in the file, with a final dot; "" for all of it.

    Raises:
        SettingsError: A key, a unit or a sign cannot be followed.
    """
    require_known(document, ("source", "columns"), file=file, where=where)
    tables = document.get("columns", {})
    if not isinstance(tables, dict):
        raise SettingsError("expected a table", file=file, key=f"{where}columns")
    require_known(tables, units, file=file, where=f"{where}columns.")
    mapped = {
        name: _mapped(table, name, units[name], file, f"{where}columns.{name}")
        for name, table in tables.items()
    }
    source = document.get("source")
    canonical = canonical_columns(units).mapped
    stated = None if source is None else str(source)
    return MappedColumns({**canonical, **mapped}, stated, file, where)


def _mapped(table: Any, name: str, si_unit: str, file: Path, key: str) -> MappedColumn:
    if isinstance(table, str):  # theta1 = "th1": a name alone, in SI
        table = {"name": table}
    if not isinstance(table, dict):
        raise SettingsError("expected a table with name, unit, sign", file=file, key=key)
    require_known(table, ("name", "unit", "sign"), file=file, where=f"{key}.")
    sign, unit = table.get("sign", 1), str(table.get("unit", si_unit))
    if sign not in (1, -1) or isinstance(sign, bool):
        raise SettingsError(f"{sign!r} is neither 1 nor -1", file=file, key=f"{key}.sign")
    try:
        factor = sign * factor_to_si(unit, si_unit)
    except UnitError as error:
        raise SettingsError(str(error), file=file, key=f"{key}.unit") from error
    return MappedColumn(str(table.get("name", name)), unit, factor)
