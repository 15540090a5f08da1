# SPDX-License-Identifier: MIT
"""Read CSV and Parquet files as raw tables."""

from collections.abc import Callable, Mapping
from pathlib import Path

from zebro_lab.files.errors import DataError, NotFound
from zebro_lab.tables.csv_files import read_csv_file
from zebro_lab.tables.parquet_files import read_parquet_file
from zebro_lab.tables.raw_table import RawTable

READERS: Mapping[str, Callable[[Path], RawTable]] = {
    ".csv": read_csv_file,
    ".csv.gz": read_csv_file,
    ".parquet": read_parquet_file,
}
"""Reader of each table format, by the suffix of its files."""

TABLE_SUFFIXES = tuple(READERS)


def is_table_file(path: Path) -> bool:
    """Return whether a file's name ends in .csv, .csv.gz or .parquet, in either case."""
    return bool(_suffix(path))


def read_table_file(path: Path) -> RawTable:
    """Read a CSV file (also gzipped) or a Parquet file.

    Raises:
        NotFound: There is no such file.
        DataError: The file has another suffix, no rows, is damaged, too large, or not a table.
    """
    if not path.exists():
        raise NotFound(f"{path}: no such file")
    if path.is_dir() or not is_table_file(path):
        raise DataError(
            f"is not a table file; expected a name ending in {', '.join(TABLE_SUFFIXES)}", file=path
        )
    table = READERS[_suffix(path)](path)
    if len(table) == 0:
        raise DataError("has a header but no rows", file=path)
    return table


def table_stem(path: Path) -> str:
    """Return a table's file name without its suffix.

    >>> table_stem(Path("rig/sweep.csv.gz"))
    'sweep'
    """
    return path.name[: len(path.name) - len(_suffix(path))]


def _suffix(path: Path) -> str:
    """Return the matching suffix of `TABLE_SUFFIXES`, in lower case; "" for any other file."""
    return next((s for s in TABLE_SUFFIXES if path.name.lower().endswith(s)), "")
