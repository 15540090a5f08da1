# SPDX-License-Identifier: MIT
"""A checked table: keys are taken once, and faults name file, key, what was found and expected."""

import pytest
from hypothesis import given
from hypothesis import strategies as st

from model.toml_table import MOST_BYTES, TomlTable, parse_toml

NAMES = st.text("abcdefgh", min_size=1, max_size=5)


class Fault(Exception):
    def __init__(self, problem, *, file, key):
        super().__init__(f"{file}, {key}: {problem}")
        self.key = key


class Table(TomlTable):
    error = Fault


def table(**entries) -> Table:
    return Table(entries, file="mine.toml")


@given(st.dictionaries(NAMES, st.floats(allow_nan=False, allow_infinity=False), min_size=1))
def test_what_is_taken_is_what_stood_there_and_nothing_is_left(entries):
    found = table(**entries)
    assert {key: found.number(key) for key in found.unread} == entries
    assert found.empty
    found.finish()


@given(st.dictionaries(NAMES, st.integers(), min_size=2))
def test_a_key_that_nobody_takes_is_a_fault_that_names_it(entries):
    left, *taken = entries
    found = table(**entries)
    for key in taken:
        found.value(key)
    with pytest.raises(Fault, match=f"^mine.toml, {left}: unknown key; ") as caught:
        found.finish()
    assert caught.value.key == left


def test_a_key_is_taken_once():
    found = table(rate=2.0)
    assert found.positive("rate") == 2.0
    with pytest.raises(Fault, match="rate: is missing"):
        found.positive("rate")


def test_a_key_left_in_an_inner_table_is_a_fault_of_the_whole():
    found = table(legs={"order": [1], "odrer": [2]})
    assert found.table("legs").wholes("order", most=6) == (1,)
    with pytest.raises(Fault, match=r"legs\.odrer: unknown key; did you mean 'order'"):
        found.finish()


def test_a_missing_key_names_the_misspelled_one():
    with pytest.raises(Fault, match="rate: is missing; found 'rat': did you mean 'rate'"):
        table(rat=1.0).number("rate")


def test_asking_whether_a_key_is_there_makes_it_known():
    found = table(gapp=1.0)
    assert "gap" not in found
    with pytest.raises(Fault, match="did you mean 'gap'"):
        found.finish()


def test_absent_keys_have_their_defaults():
    found = table()
    assert found.text("name", "x") == "x"
    assert found.flag("sweep", True) is True
    assert found.sign("sign") == 1
    assert found.texts("by") == ()
    assert found.names("off", ("a",)) == ()
    assert found.positive_or_none("torque") is None
    assert found.table("limits").empty


def test_a_series_is_a_list_or_evenly_spaced():
    found = table(a=[1, 2.5], b={"first": 0.0, "last": 1.0, "count": 5})
    assert found.series("a") == (1.0, 2.5)
    assert found.series("b") == (0.0, 0.25, 0.5, 0.75, 1.0)


FAULTS = {
    "text": (lambda t: t.text("k"), 3, "found 3; expected a text"),
    "empty text": (lambda t: t.text("k", least=1), "", "found ''; expected a text"),
    "texts": (lambda t: t.texts("k"), ["a", 1], "expected a text or a list of texts"),
    "choice": (lambda t: t.choice("k", ("a", "b")), "c", "found 'c'; expected one of a, b"),
    "names": (lambda t: t.names("k", ("a", "b")), ["c"], "expected a list of names: a, b"),
    "flag": (lambda t: t.flag("k", False), 1, "found 1; expected true or false"),
    "fraction": (lambda t: t.whole("k", most=5), 1.5, "expected a whole number, 0 to 5"),
    "truth": (lambda t: t.whole("k", most=5), True, "expected a whole number, 0 to 5"),
    "beyond": (lambda t: t.whole("k", most=5), 6, "expected a whole number, 0 to 5"),
    "infinite": (lambda t: t.number("k"), float("inf"), "expected a finite number"),
    "too large": (lambda t: t.number("k"), 10**400, "expected a finite number"),
    "true number": (lambda t: t.number("k"), True, "expected a finite number"),
    "zero": (lambda t: t.positive("k"), 0, "found 0; expected a number above 0"),
    "two of three": (lambda t: t.numbers("k", 3), [1, 2], "expected a list of 3 numbers"),
    "negative": (
        lambda t: t.wholes("k", most=5),
        [-1],
        "expected a list of whole numbers from 0 to 5",
    ),
    "two": (lambda t: t.signs("k", 2), [1, 2], "expected a list of 2 signs, each 1 or -1"),
    "sign": (lambda t: t.sign("k"), 0, "found 0; expected 1 or -1"),
    "series": (lambda t: t.series("k"), [], "expected a list of 1 to 10000 numbers, or"),
    "table": (lambda t: t.table("k"), 6, "found 6; expected a table"),
}


@pytest.mark.parametrize(("take", "value", "message"), FAULTS.values(), ids=FAULTS)
def test_a_value_of_the_wrong_kind_is_named_with_its_place(take, value, message):
    with pytest.raises(Fault) as caught:
        take(Table({"k": value}, file="mine.toml", path="part"))
    assert str(caught.value).startswith("mine.toml, part.k: ")
    assert message in str(caught.value)


def test_a_byte_order_mark_is_no_fault():
    assert parse_toml("\ufeffa = 1".encode()) == {"a": 1}


@pytest.mark.parametrize(
    ("data", "said"),
    [
        (b" " * (MOST_BYTES + 1), "more than 1 MiB"),
        (b"a = " + b"[" * 20_000 + b"]" * 20_000, "nested too deeply"),
        (b"\xff", "utf-8"),
        (b"a =", "Invalid value"),
        (b"[legs]\nradius = [1, 0x" + b"f" * 6000 + b"]", "radius is .* more than 64 bits"),
    ],
)
def test_what_cannot_be_parsed_is_a_value_error(data, said):
    with pytest.raises(ValueError, match=said):
        parse_toml(data)
