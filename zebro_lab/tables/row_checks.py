# SPDX-License-Identifier: MIT
"""Check the rows of a text table that was read: none is short unseen, none is a line of means."""

import io
import re
from typing import Final

from zebro_lab.files.errors import DataError
from zebro_lab.files.unpacking import open_unpacked
from zebro_lab.tables.cells import kind_of
from zebro_lab.tables.raw_table import RawTable
from zebro_lab.tables.text_layout import BLANKS, split_line

_FOOTER = re.compile(
    r"(?:mean|average|avg|std|sd|stdev|sum|total|minimum|min|maximum|max|median|count|end|eof|"
    r"mittel\w*|summe|stabw|standardabweichung|anzahl|ende)\b.*",
    re.IGNORECASE,
)
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
    with open_unpacked(table.path) as file:
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
    """Check that no column of numbers ends with a word such as "Mean": that row is no sample.

    Raises:
        DataError: One does.
    """
    for name, cells in table.columns.items():
        if cells.dtype.kind in "ifb" or len(cells) < 2:
            continue
        for index in range(max(1, len(cells) - _FOOTER_ROWS), len(cells)):
            text = str(cells.iloc[index])
            if _FOOTER.fullmatch(text.strip()) and kind_of(str(cells.iloc[0])) == "value":
                problem = f"'{text}' stands below numbers; delete the lines below the table"
                raise table.fault(problem, name, index)
