# SPDX-License-Identifier: MIT
"""Strings with bytes that are no UTF-8 become strings that a file can hold."""

import json

from hypothesis import given, settings
from hypothesis import strategies as st

from zebro_lab.files.encodable import encodable

DOCUMENTS = st.recursive(
    st.none() | st.booleans() | st.integers() | st.text(),
    lambda inner: st.lists(inner) | st.dictionaries(st.text(), inner),
)


@settings(max_examples=30)
@given(DOCUMENTS)
def test_a_document_without_such_bytes_is_kept(document):
    assert encodable(document) == document


@given(st.binary(max_size=20))
def test_a_file_name_of_any_bytes_can_be_written(name):
    text = name.decode("utf-8", "surrogateescape")
    document = encodable({text: [text, (text,)]})
    assert json.loads(json.dumps(document, ensure_ascii=False).encode()) == document


def test_foreign_bytes_are_kept_as_escapes_in_keys_values_and_lists():
    assert encodable({"caf\udce9": ["\udcff", 1]}) == {r"caf\udce9": [r"\udcff", 1]}
