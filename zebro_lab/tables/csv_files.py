# SPDX-License-Identifier: MIT
"""Read text tables: CSV and its relatives, with any separator, encoding and header."""

import codecs
import io
import re
import warnings
from collections.abc import Mapping
from pathlib import Path
from typing import Final, TextIO

import pandas as pd

from zebro_lab.files.errors import DataError
from zebro_lab.files.opening import parsing, read_unpacked
from zebro_lab.tables.cells import NO_VALUE
from zebro_lab.tables.raw_table import RawTable, differing_headers
from zebro_lab.tables.table_blocks import Block, find_blocks, with_blocks
from zebro_lab.tables.text_layout import (
    BLANKS,
    SEPARATORS,
    Line,
    TextLayout,
    find_layout,
    split_line,
    uneven_row,
)

_HEAD_BYTES: Final = 1 << 16  # enough to see the layout, little enough to decode twice
_HEAD_LINES: Final = 400
_CELL_LINES: Final = 20  # of a header whose cells have line breaks
MOST_COLUMNS: Final = 2000
_SURPLUS: Final = "\0"  # name of the empty column after a final separator
_MAGIC: Final = {
    b"PAR1": "a Parquet file; rename it to end in .parquet",
    b"PK": "a zip or spreadsheet file; rename it to end in .xlsx, or export it as CSV",
    b"\xd0\xcf\x11\xe0": "a spreadsheet of old Excel (.xls); save it as .xlsx or CSV",
    b"\x1f\x8b": "a gzip file; rename it to end in .csv.gz",
}


def read_csv_file(path: Path, *, bare: bool = False) -> RawTable:
    """Read a table of text, also gzipped: CSV, TSV, columns separated by blanks.

    Separator, encoding (UTF-8, UTF-16, Windows-1252) and header are found from the file. Titles and
    comments above the header, and empty lines, are skipped; a row of units below it, or units in
    brackets, go into `units`. Repeated headers are numbered and listed in `repeated`. Missing cells
    at a row's end are empty; a header alone gives a table without rows. Decimal commas are
    understood; thousands separators are not. Headings between rows begin runs, in a column `run`.

    Args:
        path: The file.
        bare: Whether lines of numbers without a header are a table, too, of columns "1", "2", ….

    Raises:
        NotFound: There is no such file.
        DataError: The file is no text or no whole gzip file, has no header, a row has more cells
            than the header, or fewer where blanks separate them, the layout is ambiguous or not
            that of one table (see `find_layout`), or a size limit is exceeded.
    """
    data = read_unpacked(path)
    encoding = _encoding(path, data)
    layout = _layout(path, _head(path, data[:_HEAD_BYTES], encoding), bare=bare)
    frame, blocks = _frame(path, layout, data, encoding, bare=bare)
    table = _table(path, layout, frame, blocks, encoding)
    if layout.separator == BLANKS:
        _require_full_rows(table)
    return table


def _encoding(path: Path, data: bytes) -> str:
    """Return the first encoding that decodes the whole file, of those that fit its first bytes.

    Raises:
        DataError: The file is of another format, which its first bytes tell, or is no text.
    """
    head = data[:_HEAD_BYTES]
    for magic, what in _MAGIC.items():
        if head.startswith(magic):
            raise DataError(f"is not CSV but {what}", file=path)
    encodings = possible_encodings(head)
    if not encodings:
        raise DataError("is not text but a binary file; export it as CSV or Parquet", file=path)
    for encoding in encodings:
        try:
            data.decode(encoding)
        except UnicodeDecodeError:
            continue
        return encoding
    raise DataError("is not UTF-8 text; save it as UTF-8", file=path)


def _head(path: Path, head: bytes, encoding: str) -> list[Line]:
    """Return number and text of the first lines that are not blank, at most `_HEAD_LINES`.

    A cell with line breaks is joined to one line. Raises `DataError` for a first line beyond
    `_HEAD_BYTES`, and for JSON, HTML and XML.
    """
    lines = re.split(r"\r\n|\n|\r", decoded(head, encoding))
    if len(head) == _HEAD_BYTES and len(lines) == 1:
        raise DataError(
            f"the first line is longer than {_HEAD_BYTES >> 10} kB; expected a header of at most "
            f"{MOST_COLUMNS} columns",
            file=path,
        )
    if len(head) == _HEAD_BYTES:
        lines = lines[:-1]  # cut in the middle
    numbered = [(i, line) for i, line in enumerate(lines, start=1) if line.strip()]
    if numbered and numbered[0][1].lstrip().startswith(("{", "[{", "<")):
        raise DataError("is not a table but JSON, HTML or XML; export it as CSV", file=path)
    return _unbroken(numbered[:_HEAD_LINES])


def _unbroken(lines: list[Line]) -> list[Line]:
    """Join the lines of a cell in quotes that has line breaks, as headers of spreadsheets may.

    After `_CELL_LINES` lines without a closing quote they are taken as they are, joined.
    """
    joined: list[Line] = []
    parts: list[str] = []
    for number, line in lines:
        parts.append(line)
        if _is_open(" ".join(parts)) and len(parts) < _CELL_LINES:
            continue
        joined.append((number, " ".join(parts)))
        parts = []
    return joined


def _is_open(text: str) -> bool:
    """Return whether a text ends within a cell in quotes.

    A quote opens a cell only after a separator or at the start, so that 5" is five inches.
    """
    opened = False
    for i, character in enumerate(text):
        if character == '"':
            opened = not opened and (i == 0 or text[i - 1] in ",;|\t ")
    return opened


def _layout(path: Path, lines: list[Line], *, bare: bool) -> TextLayout:
    """Find separator, header and first row of data from the first lines, by `find_layout`.

    Raises:
        DataError: `find_layout` raised it, here with the name of the file; or the header has more
            than `MOST_COLUMNS` names.
    """
    try:
        layout = find_layout(lines, bare=bare)
    except DataError as error:
        raise DataError(error.problem, file=path, row=error.row, line=error.line) from error
    if len(layout.header.names) > MOST_COLUMNS:
        raise DataError(
            f"has {len(layout.header.names)} columns; expected at most {MOST_COLUMNS}", file=path
        )
    return layout


def _frame(
    path: Path, layout: TextLayout, data: bytes, encoding: str, *, bare: bool
) -> tuple[pd.DataFrame, list[Block]]:
    """Read all rows below the header; return them, and their blocks if these were looked for.

    They are unless the table may be bare, or holds numbers alone and begins with a column of them.
    Raises `DataError` if the rows cannot be read.
    """

    def lines() -> TextIO:
        """Return the text of the file, from its start."""
        return io.TextIOWrapper(io.BytesIO(data), encoding=encoding, newline="")

    frame = None
    try:
        frame = _rows(path, layout, lines())
        plain = all(dtype.kind in "ifub" for dtype in frame.dtypes)
        if bare or (plain and not frame.iloc[:, 0].isna().all()):
            return frame, []
    except DataError:
        if bare:
            raise
    blocks = find_blocks(path, lines(), layout)
    if frame is None or len(blocks) > 1:  # without a heading the same error again
        headings = {number for block in blocks for number in block.lines}
        kept = (line for number, line in enumerate(lines(), start=1) if number not in headings)
        frame = _rows(path, layout, io.StringIO("".join(kept), newline=""))
    return frame, blocks


def _rows(path: Path, layout: TextLayout, text: TextIO) -> pd.DataFrame:
    """Read all rows below the header with pandas, under the names of the layout.

    Where rows have one cell more than the header, the last column is named `_SURPLUS`. Raises
    `DataError` if pandas cannot read the rows, as where one has still more cells.
    """
    names = [*layout.header.names, *[_SURPLUS] * (layout.width > len(layout.header.names))]
    for _ in range(layout.last_line):  # here, since pandas looks for quotes in skipped lines
        text.readline()
    with (
        parsing(path, "is not a regular table", advice="correct it, or export it again"),
        warnings.catch_warnings(),
    ):
        warnings.simplefilter("error", pd.errors.ParserWarning)
        try:
            return pd.read_csv(
                text,
                sep=layout.separator,
                header=None,
                names=names,
                index_col=False,  # otherwise an extra cell shifts all columns silently
                skipinitialspace=True,
                low_memory=False,
                decimal=layout.decimal or ".",
                na_values=list(NO_VALUE),
            )
        except pd.errors.EmptyDataError as error:
            raise DataError("has a header but no rows", file=path) from error


def _table(
    path: Path, layout: TextLayout, frame: pd.DataFrame, blocks: list[Block], encoding: str
) -> RawTable:
    """Return the cells as a raw table, with notes on separator, encoding, header and runs."""
    columns = _without_empty_ends(path, frame, layout)
    columns, runs = with_blocks(columns, blocks, layout)
    odd = layout.separator != ","
    said = [f"cells are separated by {SEPARATORS[layout.separator]}"] * odd
    said += runs
    said += ["read as Windows-1252, since it is not UTF-8"] * (encoding == WINDOWS)
    return RawTable(
        path,
        columns,
        differing_headers(layout.header.repeated, columns),
        decimal="," if layout.separator == ";" and not layout.decimal else layout.decimal,
        notes=tuple(f"{path.name}: {note}" for note in (*said, *layout.header.notes)),
        header_line=layout.last_line,
        encoding=encoding,
        units={name: unit for name, unit in layout.header.units.items() if name in columns},
        separator=layout.separator,
        commented=layout.commented,
        headings=frozenset(number for block in blocks for number in block.lines),
    )


def _without_empty_ends(
    path: Path, frame: pd.DataFrame, layout: TextLayout
) -> Mapping[str, pd.Series]:
    """Return the columns without empty rows at the end, and without an empty one at the right.

    The latter has no header, as after a final separator; if it has a cell, `DataError` is raised.
    """
    last = str(frame.columns[-1]) if len(frame.columns) else ""
    unnamed = last == f"column {len(frame.columns)}" and len(frame.columns) > 1
    if (last == _SURPLUS or unnamed) and bool(frame[last].isna().to_numpy().all()):
        frame = frame.drop(columns=last)
    elif last == _SURPLUS:
        row = int(frame[last].notna().argmax()) + 1
        problem = uneven_row(len(frame.columns), len(frame.columns) - 1, "correct it")
        raise DataError(problem, file=path, row=row)
    if len(frame) and bool(frame.iloc[-1].isna().to_numpy().all()):
        filled = frame.notna().any(axis=1).to_numpy().nonzero()[0]
        frame = frame.iloc[: int(filled.max(initial=-1)) + 1]
    return {str(name): cells for name, cells in frame.items()}


WINDOWS: Final = "cp1252"
_MARKS: Final = (
    (codecs.BOM_UTF8, "utf-8-sig"),
    (codecs.BOM_UTF16_LE, "utf-16"),
    (codecs.BOM_UTF16_BE, "utf-16"),
)
_ZEROS = 0.3  # share of zero bytes at even or odd places from which on text is UTF-16


def possible_encodings(head: bytes) -> tuple[str, ...]:
    """Return the encodings that fit the first bytes of a file, the likelier first.

    Several only where all bytes are ASCII, so that what follows has to tell. Empty if none fits, or
    if the bytes are no text.
    """
    marked = next((name for mark, name in _MARKS if head.startswith(mark)), None)
    tried = (marked,) if marked else _by_zeros(head) or ("utf-8", WINDOWS)
    fitting = tuple(name for name in tried if _is_text(head, name))
    return fitting if head.isascii() else fitting[:1]


def decoded(head: bytes, encoding: str) -> str:
    """Return the first bytes of a file as text; a character cut at their end is left out.

    Raises:
        UnicodeDecodeError: The bytes have another encoding.
    """
    return codecs.getincrementaldecoder(encoding)().decode(head)


def _by_zeros(head: bytes) -> tuple[str, ...]:
    """Return UTF-16 in the byte order that zero bytes of Western text show; () if they are few."""
    half = max(len(head) // 2, 1)
    if head[1::2].count(0) > _ZEROS * half:
        return ("utf-16-le",)
    return ("utf-16-be",) if head[::2].count(0) > _ZEROS * half else ()


def _is_text(head: bytes, encoding: str) -> bool:
    """Return whether bytes decode in an encoding to a text without control characters."""
    try:
        text = decoded(head, encoding)
    except UnicodeDecodeError:
        return False
    return not any(ord(c) < 32 and c not in "\t\r\n\f" for c in text)


def _require_full_rows(table: RawTable) -> None:
    """Check that each row has as many cells as the header, where blanks separate the cells.

    With fewer cells it would be unknown which of them is missing.

    Raises:
        DataError: A row has fewer cells.
    """
    short = list(table.columns.values())[-1].isna().to_numpy(dtype=bool)
    if not short.any():
        return
    for row, line, text in table.text_rows():
        found = len(split_line(text, BLANKS)) if row <= len(short) and short[row - 1] else 0
        if found not in (0, len(table.columns)):
            advice = "write nan where a value is missing, or separate cells by tabs or commas"
            problem = uneven_row(found, len(table.columns), advice)
            raise DataError(problem, file=table.path, row=row, line=line)
