# SPDX-License-Identifier: MIT
"""A printed marker is written as dictionary, number and side."""

import pytest
from hypothesis import given
from hypothesis import strategies as st

from zebro_lab.files.errors import SettingsError
from zebro_lab.robot.marker_print import KIT_PRINT, MarkerPrint, parse_marker


@given(st.sampled_from(["4x4_50", "a:b"]), st.integers(0, 999), st.floats(1e-3, 2))
def test_a_marker_comes_back_as_it_is_written(dictionary, number, side):
    found = parse_marker(MarkerPrint(dictionary, number, side).text)
    assert (found.dictionary, found.number) == (dictionary, number)
    assert found.side == pytest.approx(side, rel=1e-11)


@pytest.mark.parametrize("text", ["", "4x4_50", "4x4_50:0", "4x4_50:-1:1cm", "4x4_50:x:1cm"])
def test_text_of_another_form_says_how_to_write_a_marker(text):
    with pytest.raises(SettingsError, match=f"--marker: .*such as {KIT_PRINT.text}"):
        parse_marker(text)


@pytest.mark.parametrize(("side", "problem"), [("1kg", "unit 'kg'"), ("0mm", "above 0")])
def test_a_side_that_is_no_length_names_the_option(side, problem):
    with pytest.raises(SettingsError, match=f"--marker: .*{problem}"):
        parse_marker(f"4x4_50:0:{side}")


def test_a_side_of_metres_is_believed_with_its_unit_only():
    with pytest.raises(SettingsError, match=r"--marker: is 120 m, .* as .120 mm"):
        parse_marker("4x4_50:0:120")
    assert parse_marker("4x4_50:0:4m").side == 4.0
