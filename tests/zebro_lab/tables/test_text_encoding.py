# SPDX-License-Identifier: MIT
"""The encoding of text is found from its first bytes."""

import pytest

from zebro_lab.tables.text_encoding import decoded, possible_encodings

TEXT = "Zeit [µs];Winkel [°]\n"


@pytest.mark.parametrize(
    "encoding", ["utf-8", "utf-8-sig", "utf-16", "utf-16-le", "utf-16-be", "cp1252"]
)
def test_text_is_read_as_it_was_written(encoding):
    head = TEXT.encode(encoding)
    (found,) = possible_encodings(head)
    assert decoded(head, found) == TEXT


def test_ascii_may_go_on_in_either_encoding():
    assert possible_encodings(b"t,F\n") == ("utf-8", "cp1252")


def test_a_character_cut_at_the_end_is_no_fault():
    assert decoded("aµ".encode()[:-1], "utf-8") == "a"
    assert possible_encodings("bµµ".encode()[:-1]) == ("utf-8",)


def test_bytes_that_are_no_text_have_no_encoding():
    assert possible_encodings(bytes(range(256))) == ()
    assert possible_encodings(b"\x81\x8d") == ()
