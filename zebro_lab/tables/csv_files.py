# SPDX-License-Identifier: MIT
"""Read CSV files; the separator is detected, and whether decimal commas are possible."""

import codecs
import csv
import re
import warnings
from collections import Counter
from collections.abc import Iterator, Mapping
from contextlib import contextmanager
from dataclasses import dataclass
from pathlib import Path

from zebro_lab.files.errors import DataError
from zebro_lab.files.opening import parsing
from zebro_lab.files.unpacking import open_unpacked
from zebro_lab.tables.raw_table import RawTable

_SEPARATORS: Mapping[str, str] = {",": "commas", ";": "semicolons", "\t": "tabs"}
_HEAD_BYTES = 1 << 16  # enough to see separators, little enough to decode twice
_HEAD_LINES = 50
MOST_COLUMNS = 2000
_MAGIC = {
    b"PAR1": "a Parquet file; rename it to end in .parquet",
    b"PK": "a zip or spreadsheet file; export it as CSV",
    b"\x1f\x8b": "a gzip file; rename it to end in .csv.gz",
    b"\xff\xfe": "UTF-16 text; save it as UTF-8",
    b"\xfe\xff": "UTF-16 text; save it as UTF-8",
}


@dataclass(frozen=True)
class _CsvLayout:
    """Layout of a CSV file: separator, headers, and the header's line number (from 1)."""

    separator: str
    names: list[str]
    header_line: int


def read_csv_file(path: Path) -> RawTable:
    """Read a CSV file, also gzipped: UTF-8, separated by commas, semicolons or tabs.

    Empty lines, and comment lines (#) before the header, are skipped; repeated headers are numbered
    and listed in `repeated`. Missing cells at a row's end are empty; a header alone gives a table
    without rows. Decimal commas are possible unless commas separate cells.

    Raises:
        NotFound: There is no such file.
        DataError: The file is not UTF-8 text or no whole gzip file, has no header, a row has more
            cells than the header, the separator is ambiguous, or a size limit is exceeded.
    """
    import pandas as pd

    layout = _csv_layout(path)
    unique = _unique_names(layout.names)
    with _csv_errors(path), open_unpacked(path, width=len(unique)) as file:
        frame = pd.read_csv(
            file,  # pyright: ignore[reportArgumentType] - a raw stream does
            sep=layout.separator,
            header=None,
            names=unique,
            skiprows=layout.header_line,
            index_col=False,  # otherwise an extra cell shifts all columns silently
            skipinitialspace=True,
            low_memory=False,
            encoding="utf-8-sig",
        )
    columns: dict[str, pd.Series] = {str(name): cells for name, cells in frame.items()}
    odd = layout.separator != ","
    return RawTable(
        path,
        columns,
        frozenset(name for name, count in Counter(layout.names).items() if count > 1),
        decimal_comma=odd,
        notes=(f"{path.name}: cells are separated by {_SEPARATORS[layout.separator]}",) * odd,
        header_line=layout.header_line,
    )


@contextmanager
def _csv_errors(path: Path) -> Iterator[None]:
    import pandas as pd

    with (
        parsing(path, "cannot be read as CSV", advice="export it again"),
        warnings.catch_warnings(),
    ):
        warnings.simplefilter("error", pd.errors.ParserWarning)
        try:
            yield
        except pd.errors.EmptyDataError as error:
            raise DataError("has a header but no rows", file=path) from error
        except UnicodeDecodeError as error:
            raise DataError(f"is not UTF-8 text ({error}); save it as UTF-8", file=path) from error
        except (pd.errors.ParserError, pd.errors.ParserWarning) as error:
            raise DataError(f"is not a regular table: {error}; correct it", file=path) from error


def _csv_layout(path: Path) -> _CsvLayout:
    with _csv_errors(path), open_unpacked(path) as file:
        head = file.read(_HEAD_BYTES)
    lines = re.split(r"\r\n|\n|\r", _decode_head(path, head))
    if len(head) == _HEAD_BYTES and len(lines) == 1:
        raise DataError(
            f"the first line is longer than {_HEAD_BYTES >> 10} kB; expected a header of at most "
            f"{MOST_COLUMNS} columns",
            file=path,
        )
    if len(head) == _HEAD_BYTES:
        lines = lines[:-1]  # cut in the middle
    numbered = [(i, line) for i, line in enumerate(lines, start=1) if line.strip()]
    numbered = numbered[_count_comments(numbered) :]
    if not numbered:
        raise DataError("is empty or all comments (#); expected a header and rows", file=path)
    separator = _separator(path, numbered)
    header_line, header = numbered[0]
    names = [name.strip() for name in next(csv.reader([header], delimiter=separator))]
    if len(names) > MOST_COLUMNS:
        raise DataError(f"has {len(names)} columns; expected at most {MOST_COLUMNS}", file=path)
    names = [name or f"column {i}" for i, name in enumerate(names, start=1)]
    if all(_is_number(name) for name in names):
        raise DataError(
            f"has no header: the first line is '{header[:60]}'; add column names", file=path
        )
    return _CsvLayout(separator, names, header_line)


def _decode_head(path: Path, head: bytes) -> str:
    for magic, what in _MAGIC.items():
        if head.startswith(magic):
            raise DataError(f"is not CSV but {what}", file=path)
    if b"\0" in head:
        raise DataError("is not text but a binary file; export it as CSV or Parquet", file=path)
    try:
        # The incremental decoder accepts a character that is truncated at the end of the head.
        text = codecs.getincrementaldecoder("utf-8-sig")().decode(head)
    except UnicodeDecodeError as error:
        raise DataError(
            f"is not UTF-8 text (byte 0x{head[error.start]:02x} at position {error.start}); save "
            "it as CSV in UTF-8",
            file=path,
        ) from error
    if any(ord(c) < 32 and c not in "\t\r\n\f" for c in text):
        raise DataError("is not text but a binary file; export it as CSV or Parquet", file=path)
    return text


def _count_comments(lines: list[tuple[int, str]]) -> int:
    return next((i for i, (_, line) in enumerate(lines) if not line.startswith("#")), len(lines))


def _separator(path: Path, lines: list[tuple[int, str]]) -> str:
    """Detect the separator that gives 50 rows equally many cells, else most in row 1; or raise."""
    texts = [text for _, text in lines[:_HEAD_LINES]]
    counts = {s: [len(cells) for cells in csv.reader(texts, delimiter=s)] for s in _SEPARATORS}
    regular = [s for s, cells in counts.items() if cells[0] > 1 and len(set(cells)) == 1]
    if len(regular) > 1:
        raise DataError(
            f"cells may be separated by {' or by '.join(_SEPARATORS[s] for s in regular)}; save "
            "the file with one of these only",
            file=path,
        )
    if regular:
        return regular[0]
    separator = max(counts, key=lambda s: counts[s][0])
    cells = counts[separator]
    for row, found in enumerate(cells[1:], start=1):
        if found > cells[0]:
            advice = "; write decimals with a point" if separator == "," else "; correct it"
            raise DataError(
                f"the row has {found} cells, the header has {cells[0]}{advice}",
                file=path, row=row, line=lines[row][0],
            )  # fmt: skip
    return separator


def _unique_names(names: list[str]) -> list[str]:
    unique: dict[str, None] = {}
    again: Counter[str] = Counter()
    for name in names:
        again[name] += 1
        while (candidate := name if again[name] == 1 else f"{name} ({again[name]})") in unique:
            again[name] += 1
        unique[candidate] = None
    return list(unique)


def _is_number(text: str) -> bool:
    try:
        float(text)
    except ValueError:
        return False
    return True
