# SPDX-License-Identifier: MIT
"""Find the header of a table: names, units, and where the rows of data begin.

Works on rows of texts, whatever file they come from. Above the data there may be titles, one or
more rows of names, and a row of units or symbols.
"""

import re
from collections import Counter
from collections.abc import Mapping, Sequence
from dataclasses import dataclass, field

from zebro_lab.tables.cells import bare_unit, is_units_row, kind_of
from zebro_lab.tables.header_units import unit_in_header

Row = Sequence[str]
_LABEL = re.compile(r"(channel|signal)[ _]?names?|kanalname|units?|einheit(en)?")
"""Words that begin a row of names or of units, above columns of numbers."""


@dataclass(frozen=True)
class Header:
    """The header of a table.

    Attributes:
        names: Header of each column, unique; those of empty cells are "column 1", ….
        first: Index of the first row of data among the rows that were given.
        units: Unit that the file states, by header, in a row of units or in brackets.
        repeated: Headers that several columns have in the file.
        notes: Notes on rows that were used or not, one line each, without the file's name.
    """

    names: tuple[str, ...]
    first: int
    units: Mapping[str, str] = field(default_factory=dict)
    repeated: frozenset[str] = frozenset()
    notes: tuple[str, ...] = ()


@dataclass(frozen=True)
class DataRows:
    """A stretch of rows with data.

    Attributes:
        first: Index of its first row.
        stop: Index after its last row.
        width: The usual number of cells, without empty ones at the end.
        values: Share of values in cells that are not empty.
        count: Number of values.
    """

    first: int
    stop: int
    width: int
    values: float
    count: int


class NoHeader(ValueError):
    """No header was found above the data, or more than one; the text says what to do."""


def data_rows(rows: Sequence[Row]) -> DataRows | None:
    """Find the rows of data: those with at least as many numbers or dates as texts, and with one.

    Settings above a table have numbers too. Of several stretches of such rows the one is best that
    has most values, weighted by their share of its cells. An earlier stretch that is like the best
    one, in width, share and first cell, is taken instead: what is between is a row that cannot be
    read, and no header. The first row is a header where it has a text above numbers: `t,1,2,3`.

    Returns None if there is no such row.
    """
    kinds = [[kind_of(cell) for cell in row] for row in rows]
    found = [_described(rows, kinds, first, stop) for first, stop in _stretches(kinds)]
    if not found:
        return None
    best = max(found, key=lambda data: data.values * data.count)
    return next(
        data for data in found
        if data is best or (
            data.width == best.width and data.values > best.values - 0.1
            and kinds[data.first][0] == kinds[best.first][0]  # not numbers of groups: ",,1,1"
        )
    )  # fmt: skip


def find_header(rows: Sequence[Row], data: DataRows) -> Header:
    """Find names and units in the rows above the data.

    Rows that `is_full` and that stand directly above the data belong to the header. The lowest of
    them that holds units is the row of units, unless it is the top one; the row above it, else the
    lowest, holds the names. Units may also stand above the names.

    Raises:
        NoHeader: There is no row of names, or two may be.
    """
    labelled = kind_of(next(iter(rows[data.first]), "")) == "text"
    above = [row for row in rows[: data.first] if any(cell.strip() for cell in row)]
    above = above if labelled else list(map(_without_labels, above))
    block: list[Row] = []
    while above and is_full(above[-1], data.width):
        block.insert(0, above.pop())
    if not block:
        raise NoHeader("has no header" if not above else "has no header of that width")
    units, symbols = None, 0
    for i in range(len(block) - 1, 0, -1):  # the top one holds names
        if is_units_row(block[i]):
            units, symbols, block = block[i], len(block) - 1 - i, block[:i]
            break
    if units is None and len(block) > 1 and is_units_row(block[-2]):
        units = block.pop(-2)  # above the names
    names, above = _names(block, above, has_units=units is not None)
    if above and "" in names:  # those of the first columns may stand one row higher
        names = [
            name or over for name, over in zip(names, _padded(above[-1], len(names)), strict=True)
        ]
    width = max(len(names), data.width)
    names += [""] * (width - len(names))
    filled = [name.strip() or f"column {i}" for i, name in enumerate(names, start=1)]
    titles = f"{len(above)} lines are" if len(above) > 1 else "a line is"
    notes = [f"{titles} above the header and not read"] * bool(above)
    notes += ["the row of units is used"] * (units is not None)
    notes += ["the row between units and numbers is not read"] * bool(symbols)
    return made_header(filled, data.first, units_row=units, notes=tuple(notes))


def _without_labels(row: Row) -> Row:
    """Return a row of names or units without what says so, as exports of National Instruments do.

    Each cell "Channel name" stands above a column of times.
    """
    cells = [cell.strip().casefold() for cell in row]
    if not _LABEL.fullmatch(cells[0]):
        return row
    meant = "" if cells[0].startswith(("unit", "einheit")) or "time" in cells else "Time"
    return [meant if plain == cells[0] else cell for plain, cell in zip(cells, row, strict=True)]


def made_header(
    names: Sequence[str], first: int, *, units_row: Row | None = None, notes: tuple[str, ...] = ()
) -> Header:
    """Return a header with unique names, and with units of its brackets and of a row of units.

    Args:
        names: Header of each column, none of them empty.
        first: Index of the first row of data.
        units_row: Unit of each column, in the same order; None without such a row.
        notes: Notes on reading.
    """
    unique = unique_names(names)
    units = {
        name: unit for name, header in zip(unique, names, strict=True)
        if (unit := unit_in_header(header)) is not None
    }  # fmt: skip
    for name, cell in zip(unique, units_row or (), strict=False):
        if cell.strip():
            units[name] = bare_unit(cell)
    again = frozenset(name for name, count in Counter(names).items() if count > 1)
    return Header(tuple(unique), first, units, again, notes)


def unique_names(names: Sequence[str]) -> list[str]:
    """Append " (2)", " (3)", … to the second and later occurrences of a name."""
    unique: dict[str, None] = {}
    again: Counter[str] = Counter()
    for name in names:
        again[name] += 1
        while (candidate := name if again[name] == 1 else f"{name} ({again[name]})") in unique:
            again[name] += 1
        unique[candidate] = None
    return list(unique)


def _stretches(kinds: Sequence[Sequence[str]]) -> list[tuple[int, int]]:
    """Return begin and end of each run of rows that have a value, and as many values as texts.

    The end is the row after the last one. A run from row 0 on begins at row 1 instead if row 0 has
    a text above a column of values.
    """
    found, start = [], None
    for i, row in enumerate([*kinds, ()]):
        values, texts = row.count("value"), row.count("text")
        if values > 0 and values >= texts:
            start = i if start is None else start
        elif start is not None:
            found.append((start, i))
            start = None
    if found and found[0][0] == 0 and _names_columns(kinds[0], kinds[1 : found[0][1]]):
        found[0] = (1, found[0][1])
    return [(first, stop) for first, stop in found if stop > first]


def _described(
    rows: Sequence[Row], kinds: Sequence[Sequence[str]], first: int, stop: int
) -> DataRows:
    """Describe a stretch of rows; its width is the most frequent one, the larger of equals."""
    widths = Counter(_width(row) for row in rows[first:stop])
    flat = Counter(kind for row in kinds[first:stop] for kind in row)
    width = max(widths, key=lambda width: (widths[width], width))
    share = flat["value"] / (flat["value"] + flat["text"])
    return DataRows(first, stop, width, share, flat["value"])


def _names_columns(first: Sequence[str], below: Sequence[Sequence[str]]) -> bool:
    """Return whether a text of the first row has values alone in the five rows below it."""
    return any(
        kind == "text" and all(len(row) > i and row[i] == "value" for row in below[:5])
        for i, kind in enumerate(first)
    )


def _width(row: Row) -> int:
    """Return the number of cells of a row up to the last that is not blank."""
    return max((i for i, cell in enumerate(row, start=1) if cell.strip()), default=0)


def is_full(row: Row, width: int) -> bool:
    """Return whether a row above the data may be of names or units, unlike a title, which is short.

    It has at least as many cells as the data; the last that is filled is the data's last but one or
    later; and two cells are filled, or one above data of one column.

    Args:
        row: Cells of the row.
        width: Number of columns of the data.
    """
    found = sum(bool(cell.strip()) for cell in row)
    return _width(row) >= width - 1 and found >= min(2, width) and len(row) >= width


def _names(block: list[Row], above: list[Row], *, has_units: bool) -> tuple[list[str], list[Row]]:
    """Return the names of columns, from the lowest row of the header; and the rows above it.

    Where a name occurs twice in it, the names of groups above are put before it, row by row, until
    the names differ; if they never do, they stay as they are.

    Args:
        block: Full rows directly above the data, without units, at least one.
        above: Rows above these, such as titles.
        has_units: Whether there is a row of units.

    Raises:
        NoHeader: The two lowest rows may both be names, and no units tell which ones are.
    """
    names = [cell.strip() for cell in block[-1]]
    if _distinct(names):
        higher = [cell.strip() for cell in block[-2]] if len(block) > 1 else []
        named = len(higher) >= len(names) and all(kind_of(cell) == "text" for cell in higher)
        if not has_units and higher and named and _distinct(higher):
            raise NoHeader(
                "has two rows above the numbers that may be the header, "
                f"'{_start(block[-2])}' and '{_start(block[-1])}'"
            )
        return names, [*above, *block[:-1]]
    left = [*above, *block[:-1]]
    longer = names
    while left and _width(left[-1]) > 2:
        row = left.pop()
        own = [*(cell.strip() for cell in row), *[""] * len(names)]  # merged with the empty cell
        longer = [f"{parent} {name}".strip() if name else cell for parent, name, cell
                  in zip(_filled(row, len(names)), longer, own, strict=False)]  # fmt: skip
        if _distinct(longer):
            return longer, left
    return names, [*above, *block[:-1]]


def _distinct(names: Sequence[str]) -> bool:
    """Return whether no two names are equal, apart from empty ones."""
    found = [name for name in names if name]
    return len(set(found)) == len(found)


def _filled(row: Row, width: int) -> list[str]:
    """Return a row of group names in which an empty cell belongs to the group on its left."""
    filled, last = [], ""
    for cell in _padded(row, width):
        last = cell or last
        filled.append(last)
    return filled


def _padded(row: Row, width: int) -> list[str]:
    """Return the stripped cells of a row, cut or filled with empty ones to a width."""
    return [cell.strip() for cell in [*row, *[""] * width][:width]]


def _start(row: Row) -> str:
    """Return the beginning of a row for an error message."""
    return ", ".join(cell.strip() for cell in row)[:40]
