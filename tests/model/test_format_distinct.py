# SPDX-License-Identifier: MIT
"""Numbers that differ are printed so that they do, and others no longer than needed."""

import math

from hypothesis import given
from hypothesis import strategies as st

from model.format_distinct import format_distinct

NUMBERS = st.floats(allow_nan=False, allow_infinity=False)


@given(st.lists(NUMBERS, min_size=1, max_size=4))
def test_texts_differ_exactly_where_numbers_do(values):
    texts = format_distinct(*values)
    assert len(set(map(float, texts))) == len(set(values))


@given(NUMBERS)
def test_a_neighbour_is_distinguished(value):
    one, other = format_distinct(value, math.nextafter(value, math.inf))
    assert one != other


def test_no_more_digits_are_printed_than_are_needed():
    assert format_distinct(1.0, 2.5, 2.5) == ("1", "2.5", "2.5")
    assert format_distinct(1e9 + 0.5, 1e9) == ("1000000000.5", "1000000000")
