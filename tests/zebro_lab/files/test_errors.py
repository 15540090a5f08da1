# SPDX-License-Identifier: MIT
"""Messages of errors are one line, begin with the place, and errors carry their values."""

import pytest
from hypothesis import given
from hypothesis import strategies as st

from zebro_lab.files import errors
from zebro_lab.files.errors import (
    DataError,
    SettingsError,
    UnitError,
    ZebroLabError,
    shortened,
    shown,
)


@pytest.mark.parametrize(
    ("place", "expected"),
    [
        ({}, "is bad"),
        ({"file": "a.csv"}, "a.csv: is bad"),
        ({"file": "a.csv", "column": "FZ", "row": 3}, "a.csv, column 'FZ', row 3: is bad"),
        ({"column": "FZ", "row": 3, "line": 4}, "column 'FZ', row 3 (line 4): is bad"),
    ],
)
def test_a_fault_of_data_is_placed_by_what_is_known_of_its_place(place, expected):
    assert str(DataError("is bad", **place)) == expected


def test_a_fault_of_settings_is_placed_by_file_and_key():
    assert str(SettingsError("is 3", file="x.toml", key="a.b")) == "x.toml, a.b: is 3"
    assert str(SettingsError("is 3", key="--seed")) == "--seed: is 3"
    assert UnitError("unknown unit 'm2'", unit="m2").unit == "m2"


@pytest.mark.parametrize("error", [DataError, SettingsError])
def test_messages_of_other_libraries_become_one_short_line_without_control_characters(error):
    message = str(error("first\n\tsecond \x1b[31m" + "x" * 5000, file="a"))
    assert message.startswith(r"a: first second \x1b[31m")
    assert len(message) < 1100


@pytest.mark.parametrize(
    ("name", "builtin"),
    [("DataError", ValueError), ("SettingsError", ValueError), ("UnitError", ValueError),
     ("NotFound", FileNotFoundError), ("AlreadyExists", FileExistsError),
     ("NotWritten", OSError), ("RecordingError", OSError)],
)  # fmt: skip
def test_every_error_is_ours_and_also_pythons(name, builtin):
    assert issubclass(getattr(errors, name), ZebroLabError)
    assert issubclass(getattr(errors, name), builtin)


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
