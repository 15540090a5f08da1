# SPDX-License-Identifier: MIT
"""Conditions that choose rows."""

import operator

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st
from hypothesis.extra.numpy import arrays

from zebro_lab.tables.row_conditions import RowCondition, parse_row_condition

OPERATORS = {
    "==": operator.eq, "!=": operator.ne, "<": operator.lt, "<=": operator.le,
    ">": operator.gt, ">=": operator.ge,
}  # fmt: skip


@given(
    st.text(st.characters(codec="utf-8", exclude_characters="`", exclude_categories=["Cc"]))
    .filter(len),
    st.sampled_from(sorted(OPERATORS)),
    st.floats(allow_nan=False, allow_infinity=False),
)  # fmt: skip
def test_quoted_condition_round_trips(column, sign, number):
    parsed = parse_row_condition(f"`{column}` {sign} {number!r}")
    assert parsed == RowCondition(column, sign, number)


@given(
    st.sampled_from(sorted(OPERATORS)),
    arrays(float, 5, elements=st.floats(-2, 2) | st.just(1.0)),
)
def test_condition_holds_as_python_compares(sign, values):
    expected = [OPERATORS[sign](value, 1.0) for value in values]
    assert RowCondition("x", sign, 1.0).holds(values).tolist() == expected


@pytest.mark.parametrize("sign", sorted(OPERATORS))
def test_no_condition_holds_for_nan(sign):
    assert not RowCondition("x", sign, 1.0).holds(np.array([np.nan])).any()


@pytest.mark.parametrize(
    "text",
    ["slip", "slip > ", "> 1", "slip => 1", "slip > b", "a > 1 and b > 2", "__import__('os')", ""],
)
def test_anything_else_is_refused(text):
    with pytest.raises(ValueError, match="is not a condition"):
        parse_row_condition(text)
