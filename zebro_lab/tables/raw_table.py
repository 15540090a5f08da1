# SPDX-License-Identifier: MIT
"""A table as read from a file, before columns are mapped."""

import re
from collections.abc import Mapping
from dataclasses import dataclass, field
from pathlib import Path
from typing import TYPE_CHECKING

import numpy as np
from numpy.typing import NDArray

from rig.nearest_name import nearest
from zebro_lab.files.errors import DataError
from zebro_lab.files.opening import parsing
from zebro_lab.files.unpacking import open_unpacked

_BLOCK = 1 << 16  # cells converted to numbers at a time

if TYPE_CHECKING:
    import pandas as pd


@dataclass(frozen=True)
class RawTable:
    """A table as read from a file.

    Attributes:
        path: The file, or the run folder.
        columns: Columns by header, numbers or strings, each of shape (n,).
        repeated: Headers of more than one column, which are therefore ambiguous.
        source: Source stated in the file; None if not stated.
        decimal_comma: Whether numbers may be written with a decimal comma, e.g. 0,5.
        notes: Notes on how the file was read, one line each.
        header_line: Line of the header in a text file, from 1; None for others.
        unreadable: Cell type of columns that are neither numbers nor strings, by header.
    """

    path: Path
    columns: "Mapping[str, pd.Series]"
    repeated: frozenset[str] = frozenset()
    source: str | None = None
    decimal_comma: bool = False
    notes: tuple[str, ...] = ()
    header_line: int | None = None
    unreadable: Mapping[str, str] = field(default_factory=dict)

    def __len__(self) -> int:
        """Count the data rows."""
        return len(next(iter(self.columns.values()), ()))

    def column(self, name: str) -> "pd.Series":
        """Return a column.

        Raises:
            DataError: The file has no column, or more than one, with this header.
        """
        if name in self.repeated:
            raise DataError(
                "heads more than one column; give each a name of its own",
                file=self.path, column=name,
            )  # fmt: skip
        if name not in self.columns:
            raise DataError(
                f"missing; {nearest(name, list(self.columns))}", file=self.path, column=name
            )
        if name in self.unreadable:
            raise DataError(
                f"holds cells of type {self.unreadable[name]}; expected numbers or texts",
                file=self.path, column=name,
            )  # fmt: skip
        return self.columns[name]

    def numbers(self, name: str) -> NDArray[np.float64]:
        """Return a column as numbers, NaN for empty cells, shape (n,).

        Raises:
            DataError: The column is missing, or a cell is not a number.
        """
        import pandas as pd

        cells = self.column(name)
        if pd.api.types.is_datetime64_any_dtype(cells) or pd.api.types.is_timedelta64_dtype(cells):
            raise DataError("holds dates, expected numbers", file=self.path, column=name)
        with parsing(self.path, f"cannot take column '{name}' for numbers"):
            empty = cells.isna().to_numpy(dtype=bool)
            values = _as_numbers(cells)
            bad = np.isnan(values) & ~empty
            if bad.any() and self.decimal_comma and not _has_points(cells):
                values = _as_numbers(cells.astype(str).str.replace(",", ".", regex=False))
                bad = np.isnan(values) & ~empty
        if bad.any():
            raise self._not_a_number(name, int(np.argmax(bad)))
        return values

    def line(self, row: int) -> int | None:
        """Return the line number of a data row in a text file; None for other files.

        Rows and lines count from 1. The file is read again, as this is only called for error
        messages.
        """
        if self.header_line is None:
            return None
        with open_unpacked(self.path) as file:
            for number, line in enumerate(file, start=1):
                row -= number > self.header_line and bool(line.strip())
                if row == 0:
                    return number
        return None

    def _not_a_number(self, name: str, index: int) -> DataError:
        text = str(self.column(name).iloc[index])
        if re.fullmatch(r"\s*[-+]?\d+,\d+\s*", text):
            advice = "; write decimals with a point"
        elif index == 0:
            advice = "; delete a row of units, give them in columns.toml"
        else:
            advice = "; correct or delete the row"
        return DataError(
            f"'{text}' is not a number{advice}",
            file=self.path, column=name, row=index + 1, line=self.line(index + 1), value=text,
        )  # fmt: skip


def _as_numbers(cells: "pd.Series") -> NDArray[np.float64]:
    """Convert cells to numbers; NaN for empty cells, for other text, and after a block with text.

    Converting text takes pandas some microseconds per cell: a column of names would take minutes.
    """
    import pandas as pd

    if pd.api.types.is_numeric_dtype(cells):
        return np.asarray(cells, dtype=float)
    values = np.full(len(cells), np.nan)
    for start in range(0, len(cells), _BLOCK):
        block = cells.iloc[start : start + _BLOCK]
        found = np.asarray(pd.to_numeric(block, errors="coerce"), dtype=float)
        values[start : start + _BLOCK] = found
        if np.any(np.isnan(found) & ~block.isna().to_numpy(dtype=bool)):
            break
    return values


def _has_points(cells: "pd.Series") -> bool:
    # 1,234.5 and 1.234,5 are both possible: if points occur, the comma is not the decimal sign.
    return bool(cells.astype(str).str.contains(".", regex=False, na=False).any())
