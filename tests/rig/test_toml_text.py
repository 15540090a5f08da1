# SPDX-License-Identifier: MIT
"""TOML of strangers is parsed within bounds of size, depth and numbers."""

import pytest
from hypothesis import given
from hypothesis import strategies as st

from rig.toml_text import DEEPEST, MOST_BYTES, parse_toml, require_bounded


def nested(depth):
    document = {}
    for _ in range(depth):
        document = {"a": document}
    return document


@pytest.mark.parametrize("wrap", [lambda d: {"a": d}, lambda d: [d]])
def test_depth_is_bounded(wrap):
    require_bounded(wrap(nested(DEEPEST - 2)))
    with pytest.raises(ValueError, match="nested more than 32 deep"):
        require_bounded(wrap(nested(DEEPEST + 1)))


@given(st.integers())
def test_whole_numbers_fit_into_64_bits(number):
    if -(2**63) <= number < 2**63:
        require_bounded({"a": [number]})
    else:
        with pytest.raises(ValueError, match="64 bits"):
            require_bounded({"a": [number]})


def test_half_a_pair_of_surrogates_is_refused_in_keys_and_values():
    for document in ({"a": "\ud800"}, {"\ud800": 1}, ["\ud800"]):
        with pytest.raises(ValueError, match="unpaired surrogate"):
            require_bounded(document)
    require_bounded({"é": "🤖"})


def test_a_byte_order_mark_is_no_fault():
    assert parse_toml("\ufeffa = 1".encode()) == {"a": 1}


@pytest.mark.parametrize(
    ("data", "said"),
    [
        (b" " * (MOST_BYTES + 1), "more than 1 MiB"),
        (b"a" + b".a" * DEEPEST + b" = 1", "more than 32 parts"),
        (b"a = " + b"[" * 2000 + b"]" * 2000, "nested more than 32 deep"),
        (b"\xff", "utf-8"),
        (b"a =", "Invalid value"),
    ],
)
def test_what_cannot_be_parsed_is_a_value_error(data, said):
    with pytest.raises(ValueError, match=said):
        parse_toml(data)
