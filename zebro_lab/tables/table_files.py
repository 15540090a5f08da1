# SPDX-License-Identifier: MIT
"""Read table files as raw tables: text of any layout, Parquet, MATLAB and Excel."""

import re
from collections.abc import Callable, Mapping, Sequence
from pathlib import Path
from typing import Final

import pandas as pd

from zebro_lab.files.errors import DataError, NotFound
from zebro_lab.tables.cells import kind_of
from zebro_lab.tables.csv_files import read_csv_file
from zebro_lab.tables.excel_files import read_excel_file
from zebro_lab.tables.mat_files import read_mat_file
from zebro_lab.tables.raw_table import RawTable


def _read_parquet(path: Path) -> RawTable:
    """Read a Parquet file; raise `DataError` if pyarrow is not installed."""
    try:
        from zebro_lab.tables.parquet_files import read_parquet_file
    except ImportError as error:
        raise DataError(
            "is a Parquet table, which needs pyarrow: pip install 'zebro-lab[parquet]', or save it "
            "as CSV",
            file=path,
        ) from error
    return read_parquet_file(path)


READERS: Final[Mapping[str, Callable[[Path], RawTable]]] = {
    ".csv": read_csv_file,
    ".tsv": read_csv_file,
    ".dat": read_csv_file,
    ".lvm": read_csv_file,
    ".txt": read_csv_file,
    ".parquet": _read_parquet,
    ".mat": read_mat_file,
}
"""Reader of each table format without sheets, by the suffix of its files, which may be gzipped."""
_EXCEL: Final = ".xlsx"
_NAMED_ONLY: Final = ".txt"  # in folders of data mostly notes
_UNPACK: Final = "unpack it, and name what was in it"
_OTHERS: Final = {
    ".xls": "save it as .xlsx or CSV", ".xlsm": "save it as .xlsx or CSV",
    ".ods": "save it as .xlsx or CSV",
    ".tdms": "export it as CSV", ".c3d": "export it as CSV", ".h5": "export it as CSV or Parquet",
    ".tum": "it is a trajectory, which import takes as --track",
    **dict.fromkeys((".mcap", ".db3", ".bag"), "import takes a ROS log as --legs, --imu, --track"),
    **dict.fromkeys((".zip", ".rar", ".7z", ".tar", ".tgz", ".tar.gz", ".bz2", ".xz"), _UNPACK),
}  # fmt: skip

PLAIN_SUFFIXES: Final = tuple(s for s in (*READERS, _EXCEL) if s != _NAMED_ONLY)
"""Suffixes of the tables that are found in a folder; a .txt is read only where it is named."""
TABLE_SUFFIXES: Final = tuple(s + packed for s in PLAIN_SUFFIXES for packed in ("", ".gz"))
"""Suffixes of the tables that are found in a folder, gzipped or not."""


def is_table_file(path: Path) -> bool:
    """Return whether a file found in a folder is taken for a table: by its suffix, without .txt.

    The suffix may be in capitals, and .gz may follow. Files that Excel makes while a workbook is
    open (~$NAME.xlsx) are none.
    """
    return path.name.lower().endswith(TABLE_SUFFIXES) and not path.name.startswith("~$")


def read_table_file(path: Path, *, sheet: str | None = None, bare: bool = False) -> RawTable:
    """Read a table: CSV and other text, Parquet, MATLAB or Excel, each also gzipped.

    Args:
        path: The file.
        sheet: Sheet of a workbook; None for the only one that is not empty.
        bare: Whether text may have any name, and lines of numbers without a header are a table,
            too, of columns "1", "2", ….

    Raises:
        NotFound: There is no such file.
        DataError: The file has another suffix, no rows, a line of means below them, is damaged,
            too large, or not a table, or needs a package that is not installed; or a workbook has
            no such sheet, or several and none is named.
    """
    if not path.exists():
        raise NotFound(f"{path}: no such file")
    suffix = _suffix(path) or ".csv" * bare
    if path.is_dir() or not suffix:
        name = path.name.lower()
        advice = next((told for suffix, told in _OTHERS.items() if name.endswith(suffix)), "")
        raise DataError(
            f"is not a table file; expected a name ending in {', '.join((*READERS, _EXCEL))}, "
            f"perhaps with .gz{'; ' + advice if advice else ''}",
            file=path,
        )
    if suffix.startswith(_EXCEL):
        table = read_excel_file(path, sheet=sheet)
    elif bare and READERS[suffix.removesuffix(".gz")] is read_csv_file:
        table = read_csv_file(path, bare=True)
    else:
        table = READERS[suffix.removesuffix(".gz")](path)
    if len(table) == 0:
        raise DataError("has a header but no rows", file=path)
    _require_no_footer(table)
    return table


def table_stem(path: Path) -> str:
    """Return a table's file name without its suffix.

    >>> table_stem(Path("rig/sweep.csv.gz"))
    'sweep'
    """
    return path.name[: len(path.name) - len(_suffix(path))]


def _suffix(path: Path) -> str:
    """Return the suffix of a table's name in lower case, with .gz if it ends so; else ""."""
    name = path.name.lower()
    known = [suffix for suffix in (*READERS, _EXCEL) if name.removesuffix(".gz").endswith(suffix)]
    return "".join([*known[:1], ".gz" * name.endswith(".gz")]) if known else ""


_FOOTER = re.compile(
    r"(?:mean|average|avg|std|sd|stdev|sum|total|minimum|min|maximum|max|median|count|end|eof|"
    r"mittel\w*|summe|stabw|standardabweichung|anzahl|ende)\b.*",
    re.IGNORECASE,
)
_NO_STATISTIC: Final = re.compile(r"(?:count|end|eof|anzahl|ende)\b.*", re.IGNORECASE)
"""Words that a column of remarks may well end with."""
_FOOTER_ROWS: Final = 10  # rows at the end in which a footer is looked for


def _require_no_footer(table: RawTable) -> None:
    """Check that no column ends with a word such as "Mean": such a row is no sample.

    The word is an error in the last `_FOOTER_ROWS` rows of a column whose first cell is a number or
    date. In a column of texts it is one only if all rows from it on hold such words, each once, and
    no row above does; else it may be a remark.

    Raises:
        DataError: One does.
    """
    for name, cells in table.columns.items():
        if cells.dtype.kind in "ifbMm" or len(cells) < 2 or name in table.unreadable:
            continue
        first = max(1, len(cells) - _FOOTER_ROWS)
        last = ["" if cell is None else str(cell).strip() for cell in cells.iloc[first:]]
        found = [i for i, text in enumerate(last) if _FOOTER.fullmatch(text)]
        known = cells.iloc[: first + found[0]].dropna() if found else cells.iloc[:0]
        if not found or not (_are_values(known) or _are_statistics(last[found[0] :], known)):
            continue
        below = "numbers" if _are_values(known) else "the rows"
        problem = f"'{last[found[0]]}' stands below {below}; delete the lines below the table"
        raise table.fault(problem, name, first + found[0])


def _are_values(cells: pd.Series) -> bool:
    """Return whether there are cells, and the first is a number or date."""
    return len(cells) > 0 and kind_of(str(cells.iloc[0])) == "value"


def _are_statistics(last: Sequence[str], above: pd.Series) -> bool:
    """Return whether the last texts all name statistics, each once, and none above does.

    Args:
        last: The last texts of a column.
        above: The cells above them.
    """
    return (
        len(set(last)) == len(last)
        and all(_FOOTER.fullmatch(text) and not _NO_STATISTIC.fullmatch(text) for text in last)
        and not any(_FOOTER.fullmatch(text.strip()) for text in set(map(str, above)))
    )
