# SPDX-License-Identifier: MIT
"""A table as read from a file, before columns are mapped."""

import io
import re
from collections.abc import Callable, Collection, Iterator, Mapping
from dataclasses import dataclass, field, replace
from pathlib import Path
from typing import Any, Final

import numpy as np
import pandas as pd
from numpy.typing import NDArray

from model.arrays import Array
from model.format_distinct import format_distinct
from model.similar_name import nearest
from zebro_lab.files.errors import DataError
from zebro_lab.files.opening import parsing, read_unpacked
from zebro_lab.tables.cells import kind_of, may_be_thousands
from zebro_lab.tables.header_units import suffix_unit

_MINUS = "\u2212"  # as typesetters write it
_BLOCK = 1 << 16  # cells converted to numbers at a time
_ADVICE: Final = (
    (r"[-+]?\d+,\d+", "write decimals with a point"),
    (r"[-+]?\d{1,3}([ .,'’\u00a0\u202f]\d{3})+([.,]\d+)?", "write it without thousands separators"),
    (
        r"[-+]?[\d.,]+ ?[^\d\s.,:/-][^\d]*",
        "write the number alone, and its unit in the header or in columns.toml",
    ),
)
"""What to do about a cell of a form that is not a number, the first that fits."""
OVERLOAD: Final = 1e30
"""Least size of a number that stands for an overload, such as 9.9e37 of instruments with SCPI."""


@dataclass(frozen=True)
class RawTable:
    """A table as read from a file.

    Attributes:
        path: The file, or the run folder.
        columns: Columns by header, numbers, strings or dates, each of shape (n,).
        repeated: Headers that columns with different cells have in the file, which are therefore
            ambiguous.
        source: Source stated in the file; None if not stated.
        decimal: Decimal sign of the table, "," or ".", where it is known; then a number such as
            1.234 or 1,234 is not ambiguous.
        notes: Notes on how the file was read, one line each.
        header_line: Line above the first row in a text file, counted from 1; None for other files.
        encoding: Encoding of a text file.
        rows_from: Number of the first row of data in the sheet of a workbook; None for other files.
        units: Unit that the file states for a column, by header, as written in it.
        unreadable: Cell type of each column that has neither numbers nor strings, by header.
        kept: Which rows of the file the columns hold, counted from 0, shape (n,); None for all.
        separator: Separator of cells in a text file, as of `pandas.read_csv`; None for other files.
        commented: Whether the header of a text file is a comment, or made of numbers of columns.
        headings: Numbers of the lines of a text file that stand between its rows.
    """

    path: Path
    columns: Mapping[str, pd.Series]
    repeated: frozenset[str] = frozenset()
    source: str | None = None
    decimal: str | None = None
    notes: tuple[str, ...] = ()
    header_line: int | None = None
    encoding: str = "utf-8"
    rows_from: int | None = None
    units: Mapping[str, str] = field(default_factory=dict)
    unreadable: Mapping[str, str] = field(default_factory=dict)
    kept: NDArray[np.intp] | None = None
    separator: str | None = None
    commented: bool = False
    headings: frozenset[int] = frozenset()

    def __len__(self) -> int:
        """Return the number of data rows; 0 for a table without columns."""
        return len(next(iter(self.columns.values()), ()))

    def fault(self, problem: str, column: str, index: int | None = None, **found: Any) -> DataError:
        """Return, without raising, an error that names a column or one of its cells.

        Args:
            problem: What was found, what was expected, what to try.
            column: Header of the column.
            index: Row of the columns, counted from 0; None for the whole column.
            found: `value` and `unit` of the cell.
        """
        row = None if index is None else self.row(index)
        line = None if row is None else self._line(row)
        return DataError(problem, file=self.path, column=column, row=row, line=line, **found)

    def part(self, rows: NDArray[np.intp]) -> "RawTable":
        """Return some rows, by indices that increase; errors still name the rows of the file."""
        columns = {
            name: cells.iloc[rows].reset_index(drop=True) for name, cells in self.columns.items()
        }
        return replace(self, columns=columns, kept=rows if self.kept is None else self.kept[rows])

    def unit_of(self, name: str, si_unit: str) -> str | None:
        """Return the unit that the file states for a column; None if it states none.

        It stands in a row of units, in brackets, or at the end of the header as in `FT_mN`.

        Args:
            name: Header of the column.
            si_unit: SI unit of what the column is used for.
        """
        return self.units[name] if name in self.units else suffix_unit(name, si_unit)

    def column(self, name: str) -> pd.Series:
        """Return the column of a header as read: numbers, strings or dates.

        Raises:
            DataError: No or several columns have this header, or its cells could not be read.
        """
        if name in self.repeated:
            raise self.fault("several columns have this header; give each another header", name)
        if name not in self.columns:
            raise self.fault(f"is missing; {nearest(name, list(self.columns))}", name)
        if name in self.unreadable:
            kind = self.unreadable[name]
            raise self.fault(f"holds cells of type {kind}; expected numbers or texts", name)
        return self.columns[name]

    def numbers(self, name: str) -> Array:
        """Return a column as numbers in the file's unit, NaN for empty cells, shape (n,).

        A decimal comma is understood if no cell has a point. Thousands separators are not: of 1,234
        and 1.234 the decimal sign must be known from `decimal` or the column's other numbers.

        Raises:
            DataError: The column is missing, ambiguous or of dates, or a cell is not a number.
        """
        cells = self.column(name)
        if pd.api.types.is_datetime64_any_dtype(cells) or pd.api.types.is_timedelta64_dtype(cells):
            raise self.fault(
                "holds dates or durations; expected numbers, such as seconds, or of a time column "
                'unit = "date UTC" in columns.toml',
                name,
            )
        with parsing(self.path, f"column '{name}' cannot be read as numbers"):
            empty = cells.isna().to_numpy(dtype=bool)
            values = _as_numbers(cells)
            bad = np.isnan(values) & ~empty
            if bad.any() and not _has_points(cells):
                values = _as_numbers(cells.astype(str).str.replace(",", ".", regex=False))
                bad = np.isnan(values) & ~empty
                if not bad.any() and self.decimal != ",":
                    bad = _all_grouped(cells, ",")
            elif not bad.any() and self.decimal == ",":
                bad = _all_grouped(cells, ".")
        if bad.any():
            raise self._not_a_number(name, int(np.argmax(bad)))
        return values

    def require_finite(
        self,
        name: str,
        values: Array,
        expected: str = "a finite number",
        *,
        may_be_empty: bool = False,
        rows: NDArray[np.intp] | None = None,
    ) -> None:
        """Check that the numbers of a column are finite, and none stands for an overload.

        Args:
            name: Header of the column.
            values: Its numbers by row, shape (n,); NaN where the cell is empty.
            expected: What a cell should hold, and what to do if it does not; for the message.
            may_be_empty: Whether empty cells are allowed.
            rows: Row of each number, counted from 0, shape (n,); None if they are of all rows.

        Raises:
            DataError: A number is infinite or an overload, or a cell is empty unless that is
                allowed.
        """
        bad = ~is_measured(values) & ~(may_be_empty & np.isnan(values))
        if bad.any():
            first = int(np.argmax(bad))
            many = f"; it is the first of {bad.sum()} such cells" if bad.sum() > 1 else ""
            problem = f"is {_missing_text(values[first])}; expected {expected}{many}"
            raise self.fault(problem, name, first if rows is None else int(rows[first]))

    def require(self, name: str, good: NDArray[np.bool_], problem: Callable[[int], str]) -> None:
        """Check a condition on the rows of a column.

        Args:
            name: Header of the column.
            good: Whether each row is valid, shape (n,).
            problem: Returns the message for a row, counted from 0.

        Raises:
            DataError: A row is invalid; it names the first.
        """
        if not good.all():
            index = int(np.argmin(good))
            raise self.fault(problem(index), name, index)

    def require_increasing(self, column: str, t: Array) -> None:
        """Check that times are strictly increasing.

        Args:
            column: Header of the column of times, for the message.
            t: Times by row, shape (n,) [s].

        Raises:
            DataError: A time is not later than the one before; NaN is never later.
        """
        later = np.diff(t) > 0
        if later.all():
            return
        index = int(np.argmin(later)) + 1
        before, now = format_distinct(t[index - 1], t[index])
        raise self.fault(
            f"time goes from {before} to {now} s; expected increasing times: "
            "delete repeated rows, sort them by time, or, if another recording begins here, make a "
            "file of each",
            column,
            index,
        )

    def row(self, index: int) -> int:
        """Return the data row of the file, counted from 1, that a row of the columns is."""
        return 1 + (index if self.kept is None else int(self.kept[index]))

    def text_rows(self) -> Iterator[tuple[int, int, str]]:
        """Yield data row, line and text of each line of a text file below its header.

        Rows and lines count from 1; blank lines and headings are left out. The file is read again.
        """
        file = io.BytesIO(read_unpacked(self.path))
        lines = enumerate(io.TextIOWrapper(file, encoding=self.encoding, errors="replace"), start=1)
        header = self.header_line or 0
        filled = (
            (line, text) for line, text in lines
            if line > header and text.strip() and line not in self.headings
        )  # fmt: skip
        for row, (line, text) in enumerate(filled, start=1):
            yield row, line, text

    def _line(self, row: int) -> int | None:
        """Return the line of a data row in a text file or the row of a sheet; None for others."""
        if self.rows_from is not None:
            return self.rows_from + row - 1
        if self.header_line is None:
            return None
        return next((line for each, line, _ in self.text_rows() if each == row), None)

    def _not_a_number(self, name: str, index: int) -> DataError:
        """Return, without raising, an error that a cell is no number, with advice by its form."""
        text = str(self.column(name).iloc[index])
        if may_be_thousands(text):
            return self.fault(
                f"'{text}' has a decimal sign or a thousands separator; write all numbers without "
                "thousands separators, decimals with a point",
                name, index, value=text,
            )  # fmt: skip
        advice = next((a for form, a in _ADVICE if re.fullmatch(form, text.strip())), "")
        if not advice and kind_of(text) == "value":
            advice = 'if it is a time, state unit = "date", "date UTC" or "h:m:s" in columns.toml'
        elif not advice and any(character.isdigit() for character in text):
            advice = "write one number alone in the cell, or delete the row"
        elif not advice:
            units = "if the row holds units, delete it and give them in columns.toml"
            advice = "correct or delete the row" if index else units
        return self.fault(f"'{text}' is not a number; {advice}", name, index, value=text)


def is_measured(values: Array) -> NDArray[np.bool_]:
    """Return for each number whether it is finite and no mark of an overload."""
    return np.isfinite(values) & (np.abs(values) < OVERLOAD)


def _missing_text(value: float) -> str:
    """Return what a number is that is not measured: "empty", "infinite" or that of an overload."""
    if np.isnan(value):
        return "empty"
    return "infinite" if np.isinf(value) else f"{value:g}, which instruments write at an overload"


def differing_headers(
    repeated: Collection[str], columns: Mapping[str, pd.Series]
) -> frozenset[str]:
    """Return those of repeated headers whose columns differ: equal copies leave nothing open.

    Args:
        repeated: Headers that several columns have in the file.
        columns: All columns by header; copies end in " (2)", " (3)", …
    """
    return frozenset(
        name for name in repeated
        if not all(
            columns[name].equals(columns[copy]) for copy in columns
            if re.fullmatch(rf"{re.escape(name)} \(\d+\)", copy)
        )
    )  # fmt: skip


def _as_numbers(cells: pd.Series) -> Array:
    """Convert cells to numbers, shape (n,); NaN for empty cells and for text that is not a number.

    After a block of 65,536 cells with such text the rest is NaN too: converting text takes pandas
    some microseconds per cell, so that a column of names would take minutes.
    """
    if pd.api.types.is_numeric_dtype(cells):
        return np.asarray(cells, dtype=float)
    values = np.full(len(cells), np.nan)
    for start in range(0, len(cells), _BLOCK):
        block = cells.iloc[start : start + _BLOCK]
        if any(isinstance(cell, str) and _MINUS in cell for cell in block):
            block = block.str.replace(_MINUS, "-", regex=False)
        found = np.asarray(pd.to_numeric(block, errors="coerce"), dtype=float)
        values[start : start + _BLOCK] = found
        if np.any(np.isnan(found) & ~block.isna().to_numpy(dtype=bool)):
            break
    return values


def _has_points(cells: pd.Series) -> bool:
    """Return whether a cell has a point."""
    # 1,234.5 and 1.234,5 are both possible: if points occur, the comma is not the decimal sign.
    return bool(cells.astype(str).str.contains(".", regex=False, na=False).any())


def _all_grouped(cells: pd.Series, sign: str) -> NDArray[np.bool_]:
    """Mark the cells with a sign, "," or ".", if in all of them it may separate thousands.

    Nothing is marked if one cell, such as 0,5, shows that it is a decimal sign.
    """
    texts = [str(cell) if isinstance(cell, str) else "" for cell in cells]
    signed = np.array([sign in text for text in texts], dtype=bool)
    grouped = np.array([may_be_thousands(text) for text in texts], dtype=bool)
    return signed if signed.any() and grouped[signed].all() else np.zeros(len(texts), dtype=bool)
