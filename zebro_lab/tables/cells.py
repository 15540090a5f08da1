# SPDX-License-Identifier: MIT
"""Recognise what the text of a table's cell is: a number, a date, no value, a unit or a name."""

import re
from collections.abc import Sequence
from typing import Final, Literal

from zebro_lab.files.units import is_unit_text

NO_VALUE: Final = (
    "n.a.", "n. a.", "N.A.", "k.A.", "k. A.", "NAN", "Nan", "-", "--", "---", "?",
    "#DIV/0!", "#NUM!", "#REF!", "#VALUE!", "#NAME?", "#NV", "#WERT!", "#ZAHL!", "#BEZUG!",
)  # fmt: skip
"""Texts that stand for a missing value, beside those that pandas knows."""
_KNOWN_TO_PANDAS: Final = (
    "#N/A", "#N/A N/A", "#NA", "-1.#IND", "-1.#QNAN", "-NaN", "-nan", "1.#IND", "1.#QNAN", "<NA>",
    "N/A", "NA", "NULL", "NaN", "None", "n/a", "nan", "null",
)  # fmt: skip
_MISSING: Final = frozenset((*NO_VALUE, *_KNOWN_TO_PANDAS))
_DIGITS = r"(?:\d+(?:[.,]\d*)?|[.,]\d+)(?:[eE][-+]?\d+)?"
_GROUPED = r"\d{1,3}(?:[ '’.,\u00a0\u202f]\d{3})+(?:[.,]\d+)?"
_NUMBER = re.compile(rf"[-+\u2212]?(?:{_DIGITS}|{_GROUPED}|inf|Inf|INF|infinity|Infinity)")
_DATE = re.compile(
    r"(?:\d{4}[-/]\d\d?[-/]\d\d?|\d\d?[-./]\d\d?[-./]\d{4}|\d\d?-[A-Z][a-z]{2}-\d{4})"
    r"(?:[T ]\s*\d\d?:\d\d.*)?"
    r"|\d{1,3}:\d\d(?::\d\d(?:[.,:]\d+)?|[.,]\d+)?(?: ?[AaPp][Mm])?"
)
_COMMA_DECIMAL = re.compile(r"[-+]?\d*,\d+(?:[eE][-+]?\d+)?")
_POINT_DECIMAL = re.compile(r"[-+]?\d*\.\d+(?:[eE][-+]?\d+)?")
_THOUSANDS = re.compile(r"[-+]?[1-9]\d{0,2}(?:[.,]\d{3})+")

Kind = Literal["empty", "value", "text"]


def kind_of(cell: str) -> Kind:
    """Return whether a cell is empty (or says that no value is known), a value, or other text.

    A value is a number in any country's writing, also with thousands separators, or a date.

    >>> [kind_of(cell) for cell in ("0,5", "1,234.5", "2026-03-04 12:00", "n/a", "FZ")]
    ['value', 'value', 'value', 'empty', 'text']
    """
    cell = cell.strip()
    if not cell or cell in _MISSING:
        return "empty"
    return "value" if _NUMBER.fullmatch(cell) or _DATE.fullmatch(cell) else "text"


def may_be_thousands(cell: str) -> bool:
    """Return whether the points or commas of a number can all be thousands separators.

    >>> may_be_thousands("1,234"), may_be_thousands("0,234"), may_be_thousands("1,23")
    (True, False, False)
    """
    return _THOUSANDS.fullmatch(cell.strip()) is not None


def decimal_sign(cells: Sequence[str]) -> str | None:
    """Return the decimal sign of numbers, "," or "."; None where none or both are used.

    Numbers in which it may separate thousands, such as 1,234, do not count.

    >>> decimal_sign(["1", "0,5"]), decimal_sign(["1,234"]), decimal_sign(["0,5", "0.5"])
    (',', None, None)
    """
    sure = [cell.strip() for cell in cells if not may_be_thousands(cell)]
    comma = any(_COMMA_DECIMAL.fullmatch(cell) for cell in sure)
    point = any(_POINT_DECIMAL.fullmatch(cell) for cell in sure)
    return None if comma == point else "," if comma else "."


def is_units_row(cells: Sequence[str]) -> bool:
    """Return whether a row holds units: over 60 % of its filled cells are known units.

    At least one of these must be other than "-" and "1", which may stand for no value or a number.

    >>> is_units_row(["sec", "kph", "rpm", "-"]), is_units_row(["t", "FZ", "FX"])
    (True, False)
    """
    found = [cell.strip() for cell in cells if cell.strip()]
    units = [is_unit_text(bare_unit(cell)) for cell in found]
    real = any(known and cell not in ("-", "1") for known, cell in zip(units, found, strict=True))
    return real and sum(units) > 0.6 * len(found)


def bare_unit(cell: str) -> str:
    """Return a unit without the brackets around it.

    >>> bare_unit("[m/s]"), bare_unit("N")
    ('m/s', 'N')
    """
    cell = cell.strip()
    bracketed = re.fullmatch(r"[\[(<{](.*)[\])>}]", cell)
    return bracketed[1].strip() if bracketed else cell
