# SPDX-License-Identifier: MIT
"""Text from files cannot steer a terminal, and long text keeps its beginning and end."""

import pytest
from hypothesis import given
from hypothesis import strategies as st

from zebro_lab.files.shown_text import LONGEST, shortened, shown


@given(st.text(max_size=50), st.integers(2, 40))
def test_a_long_text_keeps_its_beginning_and_end(text, longest):
    short = shortened(text, longest)
    if len(text) <= longest:
        assert short == text
    else:
        begin, end = short.split(" … ") if text.count(" … ") == 0 else (text[:1], text[-1:])
        assert len(short) <= longest + 3
        assert text.startswith(begin)
        assert text.endswith(end)


def test_a_message_is_cut_in_its_middle_by_default():
    short = shortened("a" * LONGEST + "b" * LONGEST)
    assert short == "a" * (LONGEST // 2) + " … " + "b" * (LONGEST // 2)


@pytest.mark.parametrize(
    "text", ["\n", "\x1b[2J", "\x9b", "\u202e", "\u2028", "\ufeff", "\udc80", "\U000e0041", "\x7f"]
)
def test_characters_that_steer_a_terminal_are_escaped(text):
    safe = shown(f"before{text}after")
    assert safe.isprintable()
    assert "\\" in safe


@given(st.text(st.characters(categories=["L", "N", "P", "Zs"])))
def test_other_text_is_shown_as_it_is(text):
    assert shown(text) == text
    assert shown("می‌خواهم") == "می‌خواهم"  # with a joiner
