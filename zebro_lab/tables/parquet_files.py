# SPDX-License-Identifier: MIT
"""Read Parquet files as raw tables."""

import io
from collections import Counter
from collections.abc import Collection, Iterator
from contextlib import AbstractContextManager
from pathlib import Path
from typing import IO, TYPE_CHECKING, Any, Final

import numpy as np
from numpy.typing import NDArray

from zebro_lab.files.opening import open_file, parsing, read_unpacked
from zebro_lab.tables.header_units import unit_in_header
from zebro_lab.tables.raw_table import RawTable

if TYPE_CHECKING:
    import pandas as pd
    import pyarrow as pa

_ADVICE = "export the file again"
MOST_CELLS: Final = 32_000_000
"""Largest number of cells that are read at once; each takes some 25 bytes meanwhile."""


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


def parquet_rows(path: Path) -> tuple[int, int]:
    """Return the numbers of rows and of columns that a Parquet file states.

    Args:
        path: The file, not gzipped.

    Raises:
        NotFound: There is no such file.
        DataError: The file is not complete Parquet.
    """
    import pyarrow.parquet as pq

    with (
        _opened(path) as file,
        parsing(path, "is not a complete Parquet file", advice=_ADVICE),
        pq.ParquetFile(file) as opened,
    ):
        return opened.metadata.num_rows, opened.metadata.num_columns


def parquet_parts(path: Path, *, rows: int, wanted: Collection[str]) -> Iterator[RawTable]:
    """Read a Parquet file in parts of so many rows, each but the first with the row before it.

    Args:
        path: The file, not gzipped.
        rows: Rows of a part.
        wanted: Headers of the columns to read; those that the file lacks are passed over.

    Raises:
        NotFound: There is no such file.
        DataError: The file is not complete Parquet.
    """
    import pyarrow as pa
    import pyarrow.parquet as pq

    with _opened(path) as file, parsing(path, "is not a complete Parquet file", advice=_ADVICE):
        with pq.ParquetFile(file) as opened:
            schema = opened.schema_arrow
            names = [name for name in dict.fromkeys(schema.names) if name in wanted]
            texts = [name for name in names if _is_text(schema.field(name).type)]
        # Without reading ahead, which keeps all bytes that were read until the end.
        with pq.ParquetFile(file, read_dictionary=texts, pre_buffer=False) as opened:
            before, row = None, 0
            for batch in opened.iter_batches(rows, columns=names, use_threads=False):
                table = pa.Table.from_batches([batch])
                both = table if before is None else pa.concat_tables([before, table])
                kept = np.arange(row - (before is not None), row + len(table))
                yield _raw(path, both, schema.metadata, kept)
                row += len(table)
                before = table.slice(len(table) - 1)


def _raw(
    path: Path, table: "pa.Table", metadata: Any, kept: NDArray[np.intp] | None = None
) -> RawTable:
    """Return a table of Arrow as a raw table, perhaps of some rows of the file."""
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
        kept=kept,
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
