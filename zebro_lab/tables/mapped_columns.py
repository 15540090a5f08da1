# SPDX-License-Identifier: MIT
"""Columns of a lab's own table under the names and units that a stage knows: time series."""

from collections.abc import Mapping
from dataclasses import dataclass, replace
from pathlib import Path

import numpy as np

from model.slip.law import Array
from rig.nearest_name import nearest
from zebro_lab.files.errors import DataError
from zebro_lab.files.settings_table import SettingsTable
from zebro_lab.tables.cells import cell_error
from zebro_lab.tables.columns import COLUMNS_FILE, MappedColumn, parse_mapped_column
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


def parse_mapped_columns(table: SettingsTable, units: Mapping[str, str]) -> MappedColumns:
    """Read names, units and signs; what is not mapped keeps its canonical name and unit.

    Args:
        table: The keys `source` and `columns`; every key is taken.
        units: SI unit of every column that the stage knows.

    Returns:
        The map.

    Raises:
        SettingsError: A key, a unit or a sign cannot be followed.
    """
    columns = table.table("columns")
    mapped = {
        name: parse_mapped_column(columns, name, unit)
        for name, unit in units.items()
        if name in columns
    }
    source = table.text("source") if "source" in table else None
    table.finish()
    where = f"{table.path}." if table.path else ""
    return MappedColumns(
        {**canonical_columns(units).mapped, **mapped}, source, Path(table.file), where
    )
