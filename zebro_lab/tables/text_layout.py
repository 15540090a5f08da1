# SPDX-License-Identifier: MIT
"""Find how the text of a table is laid out: separator, header, decimal sign, where data begin."""

import csv
import re
from collections.abc import Mapping, Sequence
from dataclasses import dataclass, replace
from typing import Final

from model.counted import counted
from zebro_lab.files.errors import DataError
from zebro_lab.files.units import is_unit_text
from zebro_lab.tables.cells import decimal_sign, kind_of
from zebro_lab.tables.header_rows import (
    DataRows,
    Header,
    NoHeader,
    data_rows,
    find_header,
    made_header,
)
from zebro_lab.tables.header_units import stated_units

BLANKS: Final = r"\s+"
SEPARATORS: Final[Mapping[str, str]] = {
    ",": "commas", ";": "semicolons", "\t": "tabs", "|": "bars", BLANKS: "blanks",
}  # fmt: skip
"""Name of each separator, in the plural; the keys are those of `pandas.read_csv`."""
MARKS: Final = ("#", "%", "//")  # of comments
_RECEIPT: Final = re.compile(r"\s*\d\d?:\d\d:\d\d(?:[.,]\d+)?\s*->")
Line = tuple[int, str]


@dataclass(frozen=True)
class TextLayout:
    """Layout of a text table.

    Attributes:
        separator: Separator of cells, a key of `SEPARATORS`.
        header: Names and units.
        last_line: Number of the line above the first row of data, counted from 1.
        decimal: Decimal sign of the table where it is known: "," or "."; else None.
        width: Number of cells in the widest row that was seen, a final separator included.
        commented: Whether the header is a comment, or made of numbers of columns.
    """

    separator: str
    header: Header
    last_line: int
    decimal: str | None
    width: int
    commented: bool = False


@dataclass(frozen=True)
class _Candidate:
    """The lines of a file, split at one separator.

    Attributes:
        separator: A key of `SEPARATORS`.
        rows: Cells of each line.
        data: Rows with data.
        header: The header; None if there is none that fits the data.
        problem: Why there is no header.
    """

    separator: str
    rows: list[list[str]]
    data: DataRows
    header: Header | None = None
    problem: str = ""

    @property
    def rank(self) -> tuple[bool, bool, float]:
        """Key to compare candidates: whether it has a header, several columns, share of values."""
        return self.header is not None, self.data.width > 1, self.data.values


def find_layout(lines: Sequence[Line], *, bare: bool = False) -> TextLayout:
    """Find the layout of a table from its first lines.

    Args:
        lines: Number and text of each line that is not blank.
        bare: Whether lines of numbers without a header are a table, too, of columns "1", "2", ….

    Raises:
        DataError: There is no header, several layouts fit, or a row has more cells than the header;
            or all lines are comments, times of receipt stand before them, or the table is
            transposed.
    """
    _require_no_receipt(lines)
    body, comments = _without_comments(lines)
    if not body:
        raise DataError("is empty or all comments (#); expected a header and rows")
    tried = [each for s in SEPARATORS if (each := _candidate(s, body, comments)) is not None]
    if not tried:
        return _without_numbers(body)
    best = _only_best(tried)
    if best.header is None and bare and best.data.first == 0:
        names = [str(i + 1) for i in range(len(best.rows[0]))]
        return _layout(best, made_header(names, 0), best.data, body)
    if best.header is None:
        raise _no_header(best, body)
    first = body[best.data.first][0]
    settings = [split_line(line, best.separator) for number, line in lines if number < first]
    return _layout(best, _with_units(best.header, settings), best.data, body)


def _with_units(header: Header, settings: Sequence[Sequence[str]]) -> Header:
    """Add the units that settings above the header state; those in the header itself prevail."""
    units = stated_units(settings, header.names)
    if not units:
        return header
    note = "units are taken from the settings above the header"
    return replace(header, units={**units, **header.units}, notes=(note,))


def split_line(line: str, separator: str) -> list[str]:
    """Split a line into its cells, without blanks around them; quotes hold a cell together.

    >>> split_line('0,5; "a;b" ;3', ";"), split_line("  1  2.5 ", BLANKS)
    (['0,5', 'a;b', '3'], ['1', '2.5'])
    """
    if separator == BLANKS and '"' not in line:
        return line.split()
    delimiter = " " if separator == BLANKS else separator
    text = " ".join(line.split()) if separator == BLANKS else line
    cells = next(csv.reader([text], delimiter=delimiter, skipinitialspace=True), [])
    return [cell.strip() for cell in cells]


def uneven_row(cells: int, names: int, advice: str) -> str:
    """Return the message that a row has another number of cells than the header has names."""
    return f"the row has {counted(cells, 'cell')}, the header has {names}; {advice}"


def _require_no_receipt(lines: Sequence[Line]) -> None:
    """Raise `DataError` if over half of the lines begin with a serial monitor's time of receipt."""
    found = [match[0] for _, line in lines if (match := _RECEIPT.match(line))]
    if len(found) <= len(lines) // 2:
        return
    raise DataError(
        f"lines begin with the time at which a serial monitor received them, '{found[0]}', which "
        "is no column; delete each line up to '->', or record with its timestamps switched off"
    )


def _without_comments(lines: Sequence[Line]) -> tuple[list[Line], list[Line]]:
    """Split lines into those from the first without a comment mark on, and the comments above."""
    first = next((i for i, (_, line) in enumerate(lines) if not line.startswith(MARKS)), None)
    first = len(lines) if first is None else first
    bare = [(i, line.lstrip("#%/").strip()) for i, line in lines[:first]]
    return list(lines[first:]), [(i, line) for i, line in bare if line]


def _candidate(separator: str, body: Sequence[Line], comments: Sequence[Line]) -> _Candidate | None:
    """Split lines at a separator and find data and header; None where no row has a number.

    If the first line is data, the header is looked for in the comments above it.
    """
    rows = [split_line(line, separator) for _, line in body]
    data = data_rows(rows)
    if data is None:
        return None
    above = rows[: data.first]
    if not above:  # of EuRoC and TUM the header is a comment
        above = [_comment_cells(line, separator) for _, line in comments]
    elif separator == BLANKS:
        above = [_words(line, data.width) for _, line in body[: data.first]]
    moved = DataRows(len(above), len(above) + 1, data.width, data.values, data.count)
    try:
        header = find_header([*above, rows[data.first]], moved)
    except NoHeader as error:
        return _Candidate(separator, rows, data, None, str(error))
    return _Candidate(separator, rows, data, header)


def _comment_cells(line: str, separator: str) -> list[str]:
    """Split a comment that may be a header at the separator, or at blanks if it does not occur."""
    cells = split_line(line, separator)
    return cells if len(cells) > 1 else split_line(line, BLANKS)


def _words(line: str, width: int) -> list[str]:
    """Split a line of names at blanks, but keep names and units of several words together.

    They are known by wider gaps between names, or by what they are: `Time [s]`, `deg C`. If neither
    gives `width` names, the number of columns of the data, all words are returned.
    """
    words = split_line(line, BLANKS)
    if len(words) <= width:
        return words
    wide = re.split(r"\s{2,}|\t", line.strip())
    if len(wide) == width:
        return wide
    joined: list[str] = []
    for word in words:
        after_degree = joined and joined[-1].lower() in ("deg", "°") and word in ("C", "F")
        if joined and (re.fullmatch(r"[\[(].*[\])]", word) or after_degree):
            joined[-1] = f"{joined[-1]} {word}"
        else:
            joined.append(word)
    return joined if len(joined) == width else words


def _only_best(candidates: Sequence[_Candidate]) -> _Candidate:
    """Return the candidate of the highest rank; `DataError` if another separator has that rank.

    It is no tie if there is no header or only one column, or if the other separator is blanks,
    which also separate what tabs do.
    """
    best = max(candidates, key=lambda each: each.rank)
    same = [each for each in candidates if each.rank == best.rank and each is not best]
    if best.rank[:2] == (True, True):
        same = [each for each in same if each.separator != BLANKS]
        if same:
            raise _several([each.separator for each in (best, *same)])
    return best


def _several(separators: Sequence[str]) -> DataError:
    """Return, without raising, an error that each of several separators gives a table."""
    names = " or by ".join(SEPARATORS[each] for each in separators)
    return DataError(f"cells may be separated by {names}; save the file with one of these only")


def _no_header(best: _Candidate, body: Sequence[Line]) -> DataError:
    """Return, without raising, an error that says why no header was found, and how to mend that.

    A table with a name at the start of each line is transposed; two rows may be the header; the
    first line may be numbers; or the row above the numbers has another number of cells.
    """
    data = best.data
    if data.first == 0 and _is_transposed(best.rows):
        return DataError(
            f"has a name at the start of each line, '{best.rows[0][0][:40]}' first, and is "
            "transposed; expected a column of each quantity: exchange rows and columns (in a "
            "spreadsheet copy, then paste special, transposed)"
        )
    if "two rows" in best.problem:
        return DataError(f"{best.problem}; delete one of them, or put # before it")
    if data.first == 0:
        return DataError(
            f"has no header: the first line is '{body[0][1][:60]}'; add a line with column names"
        )
    above = best.rows[data.first - 1]
    if len(above) == data.width:
        number, line = body[data.first - 1]
        return DataError(
            f"line {number}, '{line[:60]}', stands between names and numbers and has no cell of "
            "its own for each column; delete it, or fill its cells"
        )
    advice = "write decimals with a point" if best.separator == "," else "correct it"
    return DataError(uneven_row(data.width, len(above), advice), row=1, line=body[data.first][0])


def _is_transposed(rows: Sequence[Sequence[str]]) -> bool:
    """Return whether each line is one quantity: another name, then numbers."""
    names = {row[0] for row in rows}
    return (
        1 < len(rows) == len(names)
        and all(kind_of(name) == "text" for name in names)
        and all(len(row) > 2 and all(kind_of(c) != "text" for c in row[1:]) for row in rows)
    )


def _layout(best: _Candidate, header: Header, data: DataRows, body: Sequence[Line]) -> TextLayout:
    """Return the layout of a candidate with a header, and check that its rows fit the header.

    Args:
        best: The candidate.
        header: Its header, or one that was made for bare numbers.
        data: Rows with data.
        body: Number and text of each line, from the header on; one for each row of `best`.
    """
    rows = best.rows[data.first : data.stop]
    widest = max(range(len(rows)), key=lambda i: len(rows[i]))
    cells = [cell for row in rows for cell in row]
    _require_fit(best, header, data, body)
    last = body[data.first - 1][0] if data.first else body[0][0] - 1
    sign = decimal_sign(cells)
    return TextLayout(best.separator, header, last, sign, len(rows[widest]), data.first == 0)


def _require_fit(best: _Candidate, header: Header, data: DataRows, body: Sequence[Line]) -> None:
    """Raise `DataError` if a row has more cells than the header, but for an empty one at its end.

    Also if there are twice as many names as columns, because names and units of a header such as
    `Time, s, Force, N` were split from each other.
    """
    names = header.names
    units = [name.split(" (")[0] for name in names[1::2]]  # repeated ones are numbered
    if len(names) == 2 * data.width and all(map(is_unit_text, units)):
        raise DataError(
            f"the header has {len(names)} names, '{names[0]}', '{names[1]}', …, for "
            f"{counted(data.width, 'column')}; write units in brackets: '{names[0]} [{names[1]}]'"
        )
    for row, cells in enumerate(best.rows[data.first : data.stop], start=1):
        if any(cells[len(header.names) :]) or len(cells) > len(header.names) + 1:
            advice = "write decimals with a point" if best.separator == "," else "correct it"
            problem = uneven_row(len(cells), len(header.names), advice)
            raise DataError(problem, row=row, line=body[data.first + row - 1][0])


def _without_numbers(body: Sequence[Line]) -> TextLayout:
    """Return the layout of a table of texts, or without rows: its first line is the header.

    The separator is the one that splits that line into most cells. Raises `DataError` if several
    split it into as many, at least two.
    """
    number, first = body[0]
    cells = {each: split_line(first, each) for each in SEPARATORS if each != BLANKS}
    width = max(map(len, cells.values()))
    fitting = [each for each in cells if len(cells[each]) == width]
    if width > 1 and len(fitting) > 1:
        raise _several(fitting)
    names = [name or f"column {i}" for i, name in enumerate(cells[fitting[0]], start=1)]
    return TextLayout(fitting[0], made_header(names, 1), number, None, width)
