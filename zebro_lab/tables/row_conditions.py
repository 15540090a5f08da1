# SPDX-License-Identifier: MIT
"""Conditions such as `slip > 0.05` that filter the rows of a table."""

import operator
import re
from collections.abc import Callable, Mapping
from dataclasses import dataclass
from typing import Any

import numpy as np
from numpy.typing import NDArray

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

    def holds(self, values: NDArray[np.float64]) -> NDArray[np.bool_]:
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
