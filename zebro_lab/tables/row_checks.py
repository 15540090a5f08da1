# SPDX-License-Identifier: MIT
"""Check the rows of a table that was read: none is short unseen, none is a line of means."""

import io
import re
from collections.abc import Sequence
from typing import Final

import pandas as pd

from zebro_lab.files.errors import DataError
from zebro_lab.files.opening import read_unpacked
from zebro_lab.tables.cells import kind_of
from zebro_lab.tables.raw_table import RawTable
from zebro_lab.tables.text_layout import BLANKS, split_line

_FOOTER = re.compile(
    r"(?:mean|average|avg|std|sd|stdev|sum|total|minimum|min|maximum|max|median|count|end|eof|"
    r"mittel\w*|summe|stabw|standardabweichung|anzahl|ende)\b.*",
    re.IGNORECASE,
)
_NO_STATISTIC: Final = re.compile(r"(?:count|end|eof|anzahl|ende)\b.*", re.IGNORECASE)
"""Words that a column of remarks may well end with."""
_FOOTER_ROWS: Final = 10


def require_full_rows(table: RawTable) -> None:
    """Check that no row between blanks has fewer cells than the header: which is empty is unknown.

    Raises:
        DataError: A row has fewer cells.
    """
    last = list(table.columns.values())[-1].isna().to_numpy(dtype=bool)
    if not last.any() or table.header_line is None:
        return
    width, row = len(table.columns), 0
    file = io.BytesIO(read_unpacked(table.path))
    text = io.TextIOWrapper(file, encoding=table.encoding, errors="replace")
    for number, line in enumerate(text, start=1):
        row += number > table.header_line and bool(line.strip())
        if row > len(last):
            return
        found = len(split_line(line, BLANKS)) if row and last[row - 1] else width
        if found not in (0, width):
            raise DataError(
                f"the row has {found} cells, the header has {width}; write nan where a value "
                "is missing, or separate cells by tabs or commas",
                file=table.path, row=row, line=number,
            )  # fmt: skip


def require_no_footer(table: RawTable) -> None:
    """Check that no column ends with a word such as "Mean": that row is no sample.

    In a column of numbers, or of texts where the last rows alone have such words, each once.

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


def words_between_numbers(table: RawTable) -> tuple[str, ...]:
    """Return a note on the first line of words below numbers, where another table may begin."""
    for name, cells in table.columns.items():
        if cells.dtype.kind in "ifbMm" or not len(cells) or not _are_values(cells):
            continue
        texts = (i for i, cell in enumerate(cells) if kind_of(str(cell)) == "text")
        index = next((i for i in texts if table.is_line_of_words(i)), None)
        if index is None:
            return ()
        line = table.fault("", name, index).line
        return (f"{table.path.name}: line {line}, '{cells.iloc[index]}', is one of words between "
                "the numbers; another table or recording may begin there",)  # fmt: skip
    return ()


def _are_values(cells: pd.Series) -> bool:
    return len(cells) > 0 and kind_of(str(cells.iloc[0])) == "value"


def _are_statistics(last: Sequence[str], above: pd.Series) -> bool:
    """Return whether the last texts of a column are statistics, each once, and none above is."""
    return (
        len(set(last)) == len(last)
        and all(_FOOTER.fullmatch(text) and not _NO_STATISTIC.fullmatch(text) for text in last)
        and not any(_FOOTER.fullmatch(text.strip()) for text in set(map(str, above)))
    )
