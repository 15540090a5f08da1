# SPDX-License-Identifier: MIT
"""Read a sheet of an Excel workbook (.xlsx) as a raw table; openpyxl is an optional extra."""

import io
import zipfile
from collections.abc import Iterable, Iterator, Mapping, Sequence
from contextlib import closing, contextmanager
from datetime import date, datetime, time, timedelta
from pathlib import Path
from typing import Any, Final

import pandas as pd

from zebro_lab.files.errors import DataError
from zebro_lab.files.opening import MOST_UNPACKED, parsing, read_unpacked, require_unpacked_size
from zebro_lab.tables.cells import decimal_sign, kind_of
from zebro_lab.tables.header_rows import Header, NoHeader, data_rows, find_header
from zebro_lab.tables.raw_table import RawTable, differing_headers

_HEAD_ROWS: Final = 150
Cells = Sequence[Sequence[Any]]


def read_excel_file(path: Path, *, sheet: str | None = None) -> RawTable:
    """Read a sheet of a workbook; titles, units and repeated headers as in a text table.

    Formulas count by the values that were stored with them.

    Args:
        path: The workbook, perhaps gzipped.
        sheet: Name of the sheet; None for the only one that is not empty.

    Raises:
        NotFound: There is no such file.
        DataError: openpyxl is not installed, the file is no workbook, no or several sheets have
            cells, a formula has no stored value, there is no header, or a limit is exceeded.
    """
    content = read_unpacked(path)
    with parsing(path, "cannot be read as an Excel workbook", advice="save it again, or as CSV"):
        _require_bounded(path, content)
        name, found = _filled_sheet(path, _sheets(path, content, values=True), sheet)
        values = [[cell.value for cell in row] for row in found]
        above = next(i for i, row in enumerate(values) if any(cell is not None for cell in row))
        cells = values[above:]
        header = _header(path, name, cells)
        formulas = _sheets(path, content, values=False)[name][above:]
        _require_values(path, name, cells, formulas, above + 1)
        shown = found[above + header.first]
        percent = [i for i, cell in enumerate(shown) if "%" in str(cell.number_format)]
    notes = (f"sheet '{name}'", *header.notes)
    ratios = {header.names[i]: "dimensionless" for i in percent if i < len(header.names)}
    notes += tuple(f"'{each}' is shown in percent and stored as a ratio" for each in ratios)
    columns = _columns(cells, header)
    return RawTable(
        path,
        columns,
        differing_headers(header.repeated, columns),
        decimal=decimal_sign([c for row in cells[:_HEAD_ROWS] for c in row if isinstance(c, str)]),
        notes=tuple(f"{path.name}: {note}" for note in notes),
        rows_from=above + 1 + header.first,
        units={**header.units, **ratios},
    )


def _filled_sheet(path: Path, sheets: Mapping[str, Cells], wanted: str | None) -> tuple[str, Cells]:
    """Return name and cells of the sheet that is wanted, or else of the only one with cells.

    Raises:
        DataError: There is no such sheet, it is empty, or several have cells and none is wanted.
    """
    if wanted is not None and wanted not in sheets:
        raise DataError(f"has no sheet '{wanted}'; it has {_listed(sheets)}", file=path)
    filled = {name: rows for name, rows in sheets.items() if rows and wanted in (None, name)}
    if len(filled) > 1:
        raise DataError(
            f"has several sheets with cells, {_listed(filled)}; name one with sheet = "
            f'"{next(iter(filled))}" in columns.toml (zebro-lab init FILE --sheet NAME writes it)',
            file=path,
        )
    if not filled:
        raise DataError("is empty; expected a header and rows", file=path)
    return next(iter(filled.items()))


@contextmanager
def _opened(path: Path, content: bytes, *, values: bool) -> Iterator[Any]:
    """Open a workbook with openpyxl: stored values of formulas if `values`, else the formulas.

    Raises `DataError` if openpyxl is not installed.
    """
    try:
        import openpyxl
    except ImportError as error:
        raise DataError(
            "is an Excel workbook, which needs openpyxl: pip install openpyxl, or save "
            "the sheet as CSV",
            file=path,
        ) from error
    with closing(
        openpyxl.load_workbook(io.BytesIO(content), read_only=True, data_only=values)
    ) as book:
        yield book


def _sheets(path: Path, content: bytes, *, values: bool) -> Mapping[str, Cells]:
    """Return the rows of cells of each sheet, without empty rows at its end or sheets of charts.

    Cells with formulas hold their stored values if `values`, else the formulas.
    """
    with _opened(path, content, values=values) as book:
        sheets = {
            name: [list(row) for row in book[name].iter_rows()]
            for name in book.sheetnames
            if hasattr(book[name], "iter_rows")
        }
    for rows in sheets.values():
        while rows and all(cell.value is None for cell in rows[-1]):
            rows.pop()
    return sheets


def _header(path: Path, name: str, cells: Cells) -> Header:
    """Find the header in the first `_HEAD_ROWS` rows; raise `DataError` if there is none."""
    texts = [[_text(cell) for cell in row] for row in cells[:_HEAD_ROWS]]
    data = data_rows(texts)
    if data is None:
        raise DataError(f"sheet '{name}' has no row with numbers", file=path)
    try:
        return find_header(texts, data)
    except NoHeader as error:
        first = ", ".join(text for text in texts[0] if text)[:60]
        raise DataError(
            f"sheet '{name}' {error}: the first row is '{first}'; expected column names in one row "
            "above the numbers",
            file=path,
        ) from error


def _require_values(path: Path, name: str, cells: Cells, formulas: Cells, first: int) -> None:
    """Raise `DataError` if an empty cell has a formula: its value was never computed and stored.

    Args:
        path: The workbook.
        name: Name of the sheet.
        cells: Rows of values.
        formulas: The same cells with their formulas.
        first: Number of the first of these rows in the sheet.
    """
    for i, (row, found) in enumerate(zip(formulas, cells, strict=False)):
        for j, (formula, value) in enumerate(zip(row, found, strict=False)):
            if value is None and formula.value is not None:
                raise DataError(
                    f"row {first + i}, column {j + 1} of sheet '{name}' has a formula without a "
                    "stored value; open the file in Excel or LibreOffice and save it again",
                    file=path,
                )


def _columns(cells: Cells, header: Header) -> dict[str, pd.Series]:
    """Return the columns below the header, without those that have neither a name nor cells."""
    rows = cells[header.first :]
    columns = {}
    for i, name in enumerate(header.names):
        found = [row[i] if i < len(row) else None for row in rows]
        plain = [None if isinstance(c, str) and kind_of(c) == "empty" else c for c in found]
        if name == f"column {i + 1}" and all(cell is None for cell in plain):
            continue
        columns[name] = _series(plain)
    return columns


def _series(cells: Sequence[Any]) -> pd.Series:
    """Return cells as numbers if all are numbers, as dates if all are dates, else as objects.

    Among objects numbers stay numbers, and dates become texts. None is an empty cell.
    """
    known = [cell for cell in cells if cell is not None]
    if all(isinstance(cell, (int, float)) and not isinstance(cell, bool) for cell in known):
        return pd.Series(cells, dtype=float)
    if all(isinstance(cell, datetime) for cell in known):
        return pd.Series(pd.to_datetime(pd.Series(cells)))
    return pd.Series([None if c is None else c if isinstance(c, (int, float)) else _text(c)
                      for c in cells], dtype=object)  # fmt: skip


def _text(cell: Any) -> str:
    """Return a cell as text: dates in ISO 8601, durations in seconds, "" for an empty cell."""
    if cell is None:
        return ""
    if isinstance(cell, (datetime, date, time)):
        return cell.isoformat(" ") if isinstance(cell, datetime) else cell.isoformat()
    return f"{cell.total_seconds():g}" if isinstance(cell, timedelta) else str(cell).strip()


def _require_bounded(path: Path, content: bytes) -> None:
    """Raise `DataError` if a file is no zip archive, as workbooks are, or unpacks to too much."""
    if not content.startswith(b"PK"):
        raise DataError("is not an Excel workbook; if it is text, rename it to end in .csv",
                        file=path)  # fmt: skip
    with zipfile.ZipFile(io.BytesIO(content)) as archive:
        unpacked = sum(info.file_size for info in archive.infolist())
    require_unpacked_size(path, unpacked, MOST_UNPACKED)


def _listed(names: Iterable[str]) -> str:
    """Join names in quotes by commas."""
    return ", ".join(f"'{name}'" for name in names)
