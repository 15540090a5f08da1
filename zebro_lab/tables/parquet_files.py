# SPDX-License-Identifier: MIT
"""Read Parquet files as raw tables; pyarrow is an optional extra."""

import io
from collections import Counter
from pathlib import Path
from typing import Any

import pandas as pd
import pyarrow as pa
import pyarrow.parquet as pq

from zebro_lab.files.opening import parsing, read_unpacked
from zebro_lab.tables.header_units import unit_in_header
from zebro_lab.tables.raw_table import RawTable


def read_parquet_file(path: Path) -> RawTable:
    """Read a Parquet file, perhaps gzipped.

    Its source is the metadata key `source`, if there is one.
    Columns with cells of another kind than numbers, dates or strings are read as empty and listed
    in `unreadable`.

    Raises:
        NotFound: There is no such file.
        DataError: The file is not complete Parquet, or too large.
    """
    content = read_unpacked(path)
    with parsing(path, "is not a complete Parquet file", advice="export the file again"):
        # In one thread: of several, a damaged column could abort the process at exit (pyarrow 17).
        with pq.ParquetFile(io.BytesIO(content)) as opened:
            table = opened.read(use_threads=False)
        return _raw(path, table)


def _raw(path: Path, table: pa.Table) -> RawTable:
    """Return a table of Arrow as a raw table."""
    columns = {name: _cells(table.column(i)) for i, name in enumerate(table.column_names)}
    source = (table.schema.metadata or {}).get(b"source")
    names = Counter(table.column_names)
    return RawTable(
        path,
        columns,
        frozenset(name for name, count in names.items() if count > 1),
        source=source.decode(errors="replace") if source else None,
        unreadable={field.name: str(field.type)[:80] for field in table.schema
                    if not _is_plain(field.type)},
        units={name: unit for name in columns if (unit := unit_in_header(name)) is not None},
    )  # fmt: skip


def _cells(column: pa.ChunkedArray) -> pd.Series:
    """Return the cells of a column; all empty if they are of a kind that is not read."""
    if not _is_plain(column.type):
        return pd.Series([None] * len(column), dtype=object)
    cells = column.to_pandas()
    return cells.astype(object) if pa.types.is_dictionary(column.type) else cells


def _is_plain(kind: Any) -> bool:
    """Return whether cells of an Arrow type, or of a dictionary with such values, are read.

    Those are numbers, truth values, dates, times and strings, and columns without any value.
    """
    kind = kind.value_type if isinstance(kind, pa.DictionaryType) else kind
    known = (pa.types.is_string, pa.types.is_large_string, pa.types.is_primitive, pa.types.is_null,
             pa.types.is_decimal)  # fmt: skip
    return any(is_kind(kind) for is_kind in known)
