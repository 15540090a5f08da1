# SPDX-License-Identifier: MIT
"""Messages of a log as bytes."""

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from zebro_lab.mcap.cdr import CdrReader, CdrWriter


def test_a_text_with_bytes_of_a_foreign_encoding_is_written_as_escapes():
    assert CdrWriter().text("caf\udce9").message().endswith(rb"caf\udce9" + b"\0")


@given(st.lists(st.tuples(st.sampled_from(["<f8", "<i8", "<u4", "u1"]), st.integers(0, 5))))
def test_arrays_of_every_type_come_back_in_their_order(parts):
    arrays = [np.arange(count).astype(dtype) for dtype, count in parts]
    writer = CdrWriter()
    for array in arrays:
        writer.array(array)
    reader = CdrReader(writer.message())
    for array in arrays:
        np.testing.assert_array_equal(reader.array(array.dtype.str), array, strict=True)
    if not arrays:
        return
    cut = CdrReader(writer.message()[:-1])
    with pytest.raises(ValueError, match="ends before its fields do"):
        [cut.array(array.dtype.str) for array in [*arrays, arrays[-1]]]
