# SPDX-License-Identifier: MIT
"""Find the headings that stand between the rows of a text table, each of which begins a run.

A heading is the header again, a title, a comment, or the settings of a segment of LabVIEW.
"""

from collections.abc import Iterable, Mapping, Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import Final

import numpy as np
import pandas as pd

from zebro_lab.files.errors import DataError
from zebro_lab.tables.cells import kind_of
from zebro_lab.tables.header_rows import is_full, unique_names
from zebro_lab.tables.header_units import LVM_TIME
from zebro_lab.tables.text_layout import BLANKS, MARKS, TextLayout, split_line

_VALUES: Final = frozenset('0123456789+-.,:/eETZ" \t')  # of numbers and dates, quick to tell


@dataclass(frozen=True)
class Block:
    """Rows of a table below a heading.

    Attributes:
        first: Index of its first row among all rows.
        lines: Number of each line of its heading; none for the first block.
        cells: Cells of each line of its heading; for the first block of all lines above it.
    """

    first: int
    lines: tuple[int, ...]
    cells: tuple[list[str], ...]

    @property
    def is_segment(self) -> bool:
        """Whether the heading is that of a LabVIEW measurement file."""
        return any(row[:1] == ["***End_of_Header***"] for row in self.cells)

    def title(self, width: int) -> str:
        """Return the lowest line of the heading that names no columns; "" without one.

        Args:
            width: Number of columns.
        """
        titles = [row for row in self.cells if any(row) and not is_full(row, width)]
        return " ".join(filter(None, titles[-1]))[:60] if titles else ""

    def steps(self) -> tuple[float, float] | None:
        """Return the first value and the step of x that settings of LabVIEW state; None without."""
        stated = {row[0]: set(filter(None, row[1:])) for row in self.cells if row}
        both = [stated.get(key, set()) for key in ("X0", "Delta_X")]
        if any(len(values) != 1 for values in both):  # of several rates, none is that of all
            return None
        first, step = (float(values.pop().replace(",", ".")) for values in both)
        return first, step


def find_blocks(path: Path, lines: Iterable[str], layout: TextLayout) -> list[Block]:
    """Find the blocks of rows of a text table; one where no heading stands between them.

    Lines below the last row are no heading.

    Args:
        path: The file, for the message.
        lines: Its lines.
        layout: Layout of the table.

    Raises:
        DataError: Names of columns stand between the rows, other ones than those above them.
    """
    above: list[list[str]] = []
    blocks: list[Block] = []
    heading: dict[int, list[str]] = {}
    rows, labelled = 0, False
    between = " " if layout.separator == BLANKS else layout.separator
    blank = " \r\n" if between == "\t" else None  # of tabs alone is a row
    for number, line in enumerate(lines, start=1):
        first = line.lstrip(" ").partition(between)[0]
        if blocks and not heading and _VALUES.issuperset(first) and any(map(str.isdigit, first)):
            rows += 1
            continue
        if not line.strip(blank):
            continue
        comment = line.startswith(MARKS)
        cells = split_line(line.strip().lstrip("#%/").strip(), layout.separator)
        if number <= layout.last_line:
            above.append(cells)
        elif blocks and (comment or _is_heading(cells, blocks[0], layout, labelled=labelled)):
            heading[number] = [" ".join(cells)] if comment and cells not in above else cells
        else:
            if not blocks:
                blocks.append(Block(0, (), tuple(above)))
                labelled = _kinds(cells)[:1] == ["text"]
            elif any(map(any, heading.values())):  # not of empty rows alone
                _require_known(path, heading, blocks[0], len(layout.header.names))
                blocks.append(Block(rows, tuple(heading), tuple(heading.values())))
                heading = {}
            rows += 1 + len(heading)
            heading = {}
    return blocks


def _kinds(cells: Sequence[str]) -> list[str]:
    """Return the kind of each cell that is not empty."""
    return [kind for kind in map(kind_of, cells) if kind != "empty"]


def _is_heading(cells: list[str], top: Block, layout: TextLayout, *, labelled: bool) -> bool:
    """Return whether a line between rows may be of a heading: from above the rows, a title, empty.

    A title is words alone, or, where it is shorter than a row, a word and a value, between blanks
    more of both. Where rows begin with a word themselves (`labelled`), no line is a title.
    """
    known = cells in top.cells or not any(cells)
    kinds = [] if known or labelled else _kinds(cells)
    if kinds[:1] != ["text"]:
        return known
    texts, values = kinds.count("text"), kinds.count("value")
    mixed = texts == values == 1 or (layout.separator == BLANKS and texts >= values)
    return top.is_segment or not values or (mixed and not is_full(cells, len(layout.header.names)))


def _require_known(path: Path, heading: Mapping[int, list[str]], top: Block, width: int) -> None:
    """Raise `DataError` if a heading names columns, and others than stand above the rows."""
    for number, cells in heading.items():
        full = is_full(cells, width) and "value" not in _kinds(cells)
        if full and cells not in top.cells:
            problem = "is not the header above the rows: another table begins, make a file of each"
            raise DataError(f"line {number}, '{' '.join(cells)[:60]}', {problem}", file=path)


def with_blocks(
    columns: Mapping[str, pd.Series], blocks: Sequence[Block], layout: TextLayout
) -> tuple[dict[str, pd.Series], list[str]]:
    """Return columns with what their headings state: runs, and values of an empty LabVIEW x.

    Args:
        columns: Columns by header, each of shape (n,).
        blocks: The blocks of their rows; none if they were not looked for.
        layout: Layout of the table.

    Returns:
        The columns: of several blocks with a column `run`, titles or numbers of the blocks; and an
        empty x computed, or left out where its steps are not stated. And a note on the runs.
    """
    found, x = dict(columns), layout.header.names[0]
    rows = np.arange(len(next(iter(found.values()), ())))
    first = np.array([block.first for block in blocks], dtype=np.intp)
    block = np.searchsorted(first, rows, side="right") - 1
    if blocks and x.casefold().startswith(LVM_TIME) and found[x].isna().all():
        steps = [each for each in map(Block.steps, blocks) if each is not None]
        del found[x]
        if len(steps) == len(blocks):
            start, step = np.array(steps).T[:, block]
            found = {x: pd.Series(start + step * (rows - first[block])), **found}
    if len(blocks) < 2:
        return found, []
    titles = [each.title(len(layout.header.names)) for each in blocks]
    titled = all(titles[1:]) and not blocks[0].is_segment
    names = unique_names([(titled and each) or str(i) for i, each in enumerate(titles, start=1)])
    run = unique_names([*found, "run"])[-1]
    found[run] = pd.Series([names[i] for i in block])
    return found, [f"{len(blocks)} tables with headings between them are runs, in column '{run}'"]
