# SPDX-License-Identifier: MIT
"""Conditions such as `slip > 0.05` that filter the rows of a table (`[rows] keep`)."""

import operator
import re
from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass
from typing import Any

import numpy as np
from numpy.typing import NDArray

from model.arrays import Array
from zebro_lab.files.errors import DataError
from zebro_lab.files.settings_table import SettingsTable
from zebro_lab.tables.raw_table import RawTable

_OPERATORS: Mapping[str, Callable[[Any, Any], Any]] = {
    "==": operator.eq,
    "!=": operator.ne,
    "<=": operator.le,
    ">=": operator.ge,
    "<": operator.lt,
    ">": operator.gt,
}
_CONDITION = re.compile(
    r"\s*(?:`(?P<quoted>[^`]+)`|(?P<plain>[^`=!<>]+?))"
    r"\s*(?P<operator>==|!=|<=|>=|<|>)"
    r"\s*(?P<number>[-+]?(?:\d+\.?\d*|\.\d+)(?:[eE][-+]?\d+)?)\s*"
)


@dataclass(frozen=True)
class RowCondition:
    """One comparison of a column with a number.

    Attributes:
        column: Header of the column in the file.
        operator: One of ==, !=, <, <=, >, >=.
        number: Number to compare with, in the column's unit.
    """

    column: str
    operator: str
    number: float

    def __str__(self) -> str:
        """Format the condition as `name operator number`, without backticks, with six digits."""
        return f"{self.column} {self.operator} {self.number:g}"

    def holds(self, values: Array) -> NDArray[np.bool_]:
        """Return for each row whether the condition holds; False for NaN.

        Args:
            values: The column, shape (n,).
        """
        return _OPERATORS[self.operator](values, self.number) & ~np.isnan(values)


def parse_row_condition(text: str) -> RowCondition:
    """Parse `name operator number`; a name that contains an operator is put in backticks.

    The text is matched, never evaluated, so that a settings file cannot run code.

    Raises:
        ValueError: The text is not of this form.

    >>> parse_row_condition("slip > 0.05")
    RowCondition(column='slip', operator='>', number=0.05)
    >>> parse_row_condition("`force <N>` != -1e3").column
    'force <N>'
    """
    match = _CONDITION.fullmatch(text)
    if match is None:
        raise ValueError(
            f"'{text}' is not a condition; expected the header of a column, one of "
            f"{', '.join(_OPERATORS)}, and a number, as in 'slip > 0.05' or '`F <N>` > 1'"
        )
    column = match["quoted"] or match["plain"]
    return RowCondition(column, match["operator"], float(match["number"]))


def read_row_conditions(rows: SettingsTable) -> tuple[RowCondition, ...]:
    """Read the conditions `keep` of a section `[rows]`.

    Raises:
        SettingsError: One of them is no condition.
    """
    texts = rows.texts("keep")
    try:
        return tuple(map(parse_row_condition, texts))
    except ValueError as error:
        raise rows.fault(str(error), "keep") from error


def kept_rows(raw: RawTable, keep: Sequence[RowCondition], *, where: str = "") -> NDArray[np.intp]:
    """Return the indices of the rows that meet every condition.

    Args:
        raw: Table as read.
        keep: The conditions.
        where: Dotted section of `rows` in the `columns.toml`, with a final dot, for the message.

    Returns:
        Row indices, counted from 0, increasing.

    Raises:
        DataError: A condition names a missing, ambiguous or non-numeric column, or no row is left,
            also of a table without rows.
    """
    kept = np.ones(len(raw), dtype=bool)
    for condition in keep:
        kept &= condition.holds(raw.numbers(condition.column))
    if not kept.any():
        conditions = " and ".join(map(str, keep))
        raise DataError(
            f"none of the {len(raw)} rows meets [{where}rows] keep: {conditions}; check numbers "
            "and units",
            file=raw.path,
        )
    return np.flatnonzero(kept)
