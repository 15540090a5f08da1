# SPDX-License-Identifier: MIT
"""Times and windows are read as written, or refused as wrong usage."""

import pytest
from hypothesis import given
from hypothesis import strategies as st
from typer import BadParameter

from zebro_lab.files.errors import UnitError
from zebro_lab.terminal.picture_options import parse_instants, parse_width, parse_window


@given(st.lists(st.floats(-1e6, 1e6), min_size=1, max_size=9))
def test_times_come_back_in_order_and_once(times):
    assert parse_instants(",".join(map(repr, times))).t == tuple(sorted(set(times)))


@pytest.mark.parametrize("text", ["", "a", "1,,2", "1;2", "nan", "inf", "1,2,"])
def test_what_is_no_list_of_seconds_is_refused(text):
    with pytest.raises(BadParameter, match="no list of seconds, such as"):
        parse_instants(text)


def test_a_window_has_begin_and_end():
    assert parse_window(" 20: 24.5 ") == (20.0, 24.5)
    assert parse_window("-1:2") == (-1.0, 2.0)


@pytest.mark.parametrize("text", ["", "20", "20-24", "1:2:3", "a:b", "1:", "nan:2", "0:inf"])
def test_what_is_no_window_is_refused(text):
    with pytest.raises(BadParameter, match="not BEGIN:END in seconds"):
        parse_window(text)


@pytest.mark.parametrize("text", ["3:3", "4:3"])
def test_a_window_ends_after_it_begins(text):
    with pytest.raises(BadParameter, match="expected an end after"):
        parse_window(text)


@pytest.mark.parametrize("text", ["", "84", "84 kg", "84km", "20mm", "nan mm"])
def test_what_is_no_width_of_a_page_is_refused(text):
    with pytest.raises((BadParameter, UnitError), match="unit"):
        parse_width(text)
