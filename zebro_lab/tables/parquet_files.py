# SPDX-License-Identifier: MIT
"""Read Parquet files as raw tables, with limits on memory."""

import io
import os
from collections import Counter
from contextlib import AbstractContextManager
from pathlib import Path
from typing import IO, TYPE_CHECKING, Any

from zebro_lab.files.errors import DataError
from zebro_lab.files.opening import open_file, parsing
from zebro_lab.files.unpacking import FREELY, MOST_CELLS, MOST_RATIO, read_unpacked
from zebro_lab.tables.header_units import unit_in_header
from zebro_lab.tables.raw_table import RawTable

if TYPE_CHECKING:
    import pandas as pd
    import pyarrow as pa

_ADVICE = "export the file again"
_MOST_THRIFT = 1 << 26  # memory that a footer may ask for [bytes or entries]


def read_parquet_file(path: Path) -> RawTable:
    """Read a Parquet file, perhaps gzipped.

    Its source is the metadata key `source`, if there is one.
    Columns with cells of another kind than numbers, dates or strings are read as empty and listed
    in `unreadable`.

    Raises:
        NotFound: There is no such file.
        DataError: The file is not complete Parquet, or exceeds the limits of size or cells.
    """
    with _opened(path) as file, parsing(path, "is not a complete Parquet file", advice=_ADVICE):
        table = _read(file, path)
        metadata = table.schema.metadata or {}
        columns = {name: _cells(table.column(i)) for i, name in enumerate(table.column_names)}
    source = metadata.get(b"source")
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


def _read(file: IO[bytes], path: Path) -> "pa.Table":
    import pyarrow.parquet as pq

    limits: Any = {
        "thrift_string_size_limit": _MOST_THRIFT, "thrift_container_size_limit": _MOST_THRIFT
    }  # fmt: skip
    with pq.ParquetFile(file, **limits) as opened:
        metadata, schema = opened.metadata, opened.schema_arrow
        _require_bounded(metadata, path, file.seek(0, os.SEEK_END))
    # A long string that repeats in many rows is stored once, but unpacked it is copied to each row.
    texts = [field.name for field in schema if _is_text(field.type)]
    with pq.ParquetFile(file, read_dictionary=texts, **limits) as opened:
        # In one thread: of several, a damaged column could abort the process at exit (pyarrow 17).
        return opened.read(use_threads=False)


def _require_bounded(metadata: Any, path: Path, size: int) -> None:
    groups = [metadata.row_group(i) for i in range(metadata.num_row_groups)]
    rows = max(metadata.num_rows, sum(group.num_rows for group in groups))
    cells = rows * max(metadata.num_columns, 1)
    if cells > MOST_CELLS:
        raise DataError(
            f"has {cells / 1e6:.0f} million cells; expected at most {MOST_CELLS / 1e6:.0f} million:"
            " split the file, or drop columns that are not needed",
            file=path,
        )
    # Not `group.column(i)`: pyarrow 26 aborts the process there if a column's statistics are wrong.
    unpacked = sum(group.total_byte_size for group in groups)
    if unpacked > FREELY + MOST_RATIO * size:
        raise DataError(
            f"would unpack to {unpacked / 1e6:.0f} MB, more than {MOST_RATIO} times its size; "
            "check that this is the right file",
            file=path,
        )


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
