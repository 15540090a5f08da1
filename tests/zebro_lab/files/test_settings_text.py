# SPDX-License-Identifier: MIT
"""Templates of TOML: what is filled in is read back, and comments stay where they were."""

import tomllib

import numpy as np
from hypothesis import given
from hypothesis import strategies as st

from zebro_lab.files.settings_text import fill_in, inline_table

TEMPLATE = "# Heading.\nmass = 0  # [kg]\n\n[legs]  # six\nsign = []\n"
VALUES = st.recursive(
    st.integers(-1000, 1000) | st.text(st.characters(codec="ascii"), max_size=6),
    lambda inner: st.lists(inner, max_size=3),
)


@given(st.dictionaries(st.text("ab. \"'é", min_size=1, max_size=4), VALUES, max_size=4))
def test_what_is_filled_in_is_read_back_whatever_its_keys(values):
    text = fill_in(TEMPLATE, {"mass": 1, "legs": values})
    assert tomllib.loads(text)["legs"] == {"sign": []} | values


def test_comments_and_order_of_the_template_stay():
    text = fill_in(TEMPLATE, {"mass": 2.17, "legs": {"sign": [1, -1]}})
    assert text == "# Heading.\nmass = 2.17  # [kg]\n\n[legs]  # six\nsign = [1, -1]\n"


def test_numbers_have_twelve_digits_and_arrays_are_lists():
    text = fill_in("", {"offset_deg": np.degrees(np.radians([5.1, -3.0]))})
    assert text == "offset_deg = [5.1, -3.0]\n"


def test_a_table_in_one_line_stays_in_one_line():
    text = fill_in("[markers]\n", {"markers": {"10": inline_table({"x": 0.5, "y": 1.0})}})
    assert text == "[markers]\n10 = {x = 0.5, y = 1.0}\n"
