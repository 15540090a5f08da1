# SPDX-License-Identifier: MIT
"""Read Parquet files as raw tables."""

import io
from collections import Counter
from contextlib import AbstractContextManager
from pathlib import Path
from typing import IO, TYPE_CHECKING, Any

from zebro_lab.files.opening import open_file, parsing, read_unpacked
from zebro_lab.tables.header_units import unit_in_header
from zebro_lab.tables.raw_table import RawTable

if TYPE_CHECKING:
    import pandas as pd
    import pyarrow as pa

_ADVICE = "export the file again"


def read_parquet_file(path: Path) -> RawTable:
    """Read a Parquet file, perhaps gzipped.

    Its source is the metadata key `source`, if there is one.
    Columns with cells of another kind than numbers, dates or strings are read as empty and listed
    in `unreadable`.

    Raises:
        NotFound: There is no such file.
        DataError: The file is not complete Parquet, or too large.
    """
    with _opened(path) as file, parsing(path, "is not a complete Parquet file", advice=_ADVICE):
        table = _read(file)
        return _raw(path, table, table.schema.metadata)


def _raw(path: Path, table: "pa.Table", metadata: Any) -> RawTable:
    """Return a table of Arrow as a raw table."""
    columns = {name: _cells(table.column(i)) for i, name in enumerate(table.column_names)}
    source = (metadata or {}).get(b"source")
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


def _opened(path: Path) -> AbstractContextManager[IO[bytes]]:
    if path.name.lower().endswith(".gz"):
        return io.BytesIO(read_unpacked(path))
    return open_file(path)


def _read(file: IO[bytes]) -> "pa.Table":
    import pyarrow.parquet as pq

    # In one thread: of several, a damaged column could abort the process at exit (pyarrow 17).
    with pq.ParquetFile(file) as opened:
        return opened.read(use_threads=False)


def _cells(column: "pa.ChunkedArray") -> "pd.Series":
    import pandas as pd
    import pyarrow as pa

    if not _is_plain(column.type):
        return pd.Series([None] * len(column), dtype=object)
    cells = column.to_pandas()
    return cells.astype(object) if pa.types.is_dictionary(column.type) else cells


def _is_plain(kind: "pa.DataType") -> bool:
    import pyarrow as pa

    if isinstance(kind, pa.DictionaryType):
        kind = kind.value_type
    return _is_text(kind) or (pa.types.is_primitive(kind) or pa.types.is_null(kind)
                              or pa.types.is_decimal(kind))  # fmt: skip


def _is_text(kind: "pa.DataType") -> bool:
    import pyarrow as pa

    return pa.types.is_string(kind) or pa.types.is_large_string(kind)
