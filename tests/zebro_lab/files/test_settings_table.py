# SPDX-License-Identifier: MIT
"""Settings with units: faults name file and key; what is filled into a template is read back."""

import tomllib
from pathlib import Path

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from zebro_lab.files.errors import NotFound, SettingsError
from zebro_lab.files.settings_table import SettingsTable, fill_in, inline_table, read_settings

FILE = Path("mine.toml")


def table(**entries) -> SettingsTable:
    return SettingsTable(entries, file=FILE)


def test_texts_with_units_and_numbers_become_si():
    found = table(a="35 mm", b=0.035, c=["1 m", 2])
    assert found.quantity("a", "m") == pytest.approx(found.quantity("b", "m"))
    assert found.quantities("c", 2, "m") == (1.0, 2.0)
    found.finish()


def test_a_unit_gives_its_factor_and_the_si_unit_is_the_default():
    assert table(unit="mm").factor("unit", "m") == ("mm", pytest.approx(1e-3))
    assert table().factor("unit", "m") == ("m", 1.0)


@pytest.mark.parametrize(
    ("take", "value", "message"),
    [
        (lambda t: t.quantity("k", "m"), True, "found True; expected a number in m or a text"),
        (lambda t: t.quantity("k", "dimensionless"), [], r"found \[\]; expected a number$"),
        (lambda t: t.quantity("k", "m"), "1 kg", "'kg' cannot be converted to m"),
        (lambda t: t.quantity("k", "m", above=0.0), 0, "is 0 m; expected more than 0"),
        (lambda t: t.quantity("k", "m", least=0.0), -1, "is -1 m; expected 0 or more"),
        (lambda t: t.quantities("k", 2, "m"), [1, "x"], r"k\[1\]: 'x' is not a number"),
        (lambda t: t.factor("k", "m"), "frobs", "unknown unit 'frobs'"),
    ],
)
def test_a_quantity_that_does_not_fit_is_named(take, value, message):
    with pytest.raises(SettingsError, match=message):
        take(table(k=value))


def test_a_file_that_is_not_there_or_no_toml_is_named(tmp_path):
    with pytest.raises(NotFound, match="write one"):
        read_settings(tmp_path / "absent.toml", advice="write one")
    (tmp_path / "bad.toml").write_text("a =")
    with pytest.raises(SettingsError, match=r"bad\.toml: cannot be read as TOML"):
        read_settings(tmp_path / "bad.toml", advice="")


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
