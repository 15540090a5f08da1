# SPDX-License-Identifier: MIT
"""Conditions such as `slip > 0.05` that choose rows of a table."""

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
        column: Name of the column, as its file has it.
        operator: One of ==, !=, <, <=, >, >=.
        number: What to compare with, in the column's own unit.
    """

    column: str
    operator: str
    number: float

    def __str__(self) -> str:
        """Write the condition as its user would."""
        return f"{self.column} {self.operator} {self.number:g}"

    def holds(self, values: NDArray[np.float64]) -> NDArray[np.bool_]:
        """Tell in which rows the condition holds; never where the value is NaN.

        Args:
            values: The column, shape (n,).
        """
        return _OPERATORS[self.operator](values, self.number) & ~np.isnan(values)


def parse_row_condition(text: str) -> RowCondition:
    """Read `name operator number`; a name that holds an operator stands in backticks.

    The text is only ever matched, never evaluated: a settings file from elsewhere runs no code.

    Raises:
        ValueError: The text is no such comparison.

    >>> parse_row_condition("slip > 0.05")
    RowCondition(column='slip', operator='>', number=0.05)
    >>> parse_row_condition("`force <N>` != -1e3").column
    'force <N>'
    """
    match = _CONDITION.fullmatch(text)
    if match is None:
        raise ValueError(
            f"'{text}' is not a condition; expected a column, one of "
            f"{', '.join(_OPERATORS)}, and a number, as in 'slip > 0.05'"
        )
    column = match["quoted"] or match["plain"]
    return RowCondition(column, match["operator"], float(match["number"]))
