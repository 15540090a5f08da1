# SPDX-License-Identifier: MIT
"""What the text of a cell is."""

import pytest
from hypothesis import given
from hypothesis import strategies as st

from zebro_lab.tables.cells import decimal_sign, kind_of, may_be_thousands


@given(st.floats(allow_nan=False))
def test_every_number_is_a_value_with_point_or_comma(number):
    assert kind_of(repr(number)) == "value"
    assert kind_of(repr(number).replace(".", ",")) == "value"


@pytest.mark.parametrize(
    ("cell", "kind"),
    [
        ("1,234.5", "value"), ("1.234,5", "value"), ("1 234", "value"), ("1'234.5", "value"),
        ("04.03.2026 12:00", "value"), ("12:00:00,5", "value"), ("2026-03-04T12:00:00Z", "value"),
        ("", "empty"), ("n.a.", "empty"), ("-", "empty"), ("#DIV/0!", "empty"), ("1 N", "text"),
        ("1.2.3", "text"), ("FZ", "text"),
    ],
)  # fmt: skip
def test_a_cell_is_empty_a_value_or_text(cell, kind):
    assert kind_of(cell) == kind


@given(st.floats(0, 999), st.integers(1, 6).filter(lambda digits: digits != 3))
def test_numbers_with_any_but_three_decimals_show_the_decimal_sign(number, digits):
    text = f"{number:.{digits}f}"
    assert not may_be_thousands(text)
    assert decimal_sign([text, "7"]) == "."
    assert decimal_sign([text.replace(".", ","), "7"]) == ","
