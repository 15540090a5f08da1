# SPDX-License-Identifier: MIT
"""Names, units and the first row of data are found in rows of cells."""

import pytest
from hypothesis import given
from hypothesis import strategies as st

from zebro_lab.tables.header_rows import NoHeader, data_rows, find_header, unique_names

DATA = [["0", "1.5", "2"], ["1", "1.6", "3"]]


@pytest.mark.parametrize(
    "above",
    [[], [["Run 5", "", ""]], [["Run", "5"], ["Rate", "100"]], [["Bench 3", "hall 2", ""]]],
)
def test_titles_above_the_names_are_left_out(above):
    rows = [*above, ["t", "FZ", "FX"], *DATA]
    data = data_rows(rows)
    header = find_header(rows, data)
    assert (header.names, header.first) == (("t", "FZ", "FX"), len(above) + 1)
    assert len(header.notes) == bool(above)


def test_without_names_there_is_no_header():
    rows = [["title"], *DATA]
    with pytest.raises(NoHeader):
        find_header(rows, data_rows(rows))


@given(st.lists(st.sampled_from(["x", "y", "x (2)"])))
def test_unique_names_are_unique_and_keep_the_first(names):
    unique = unique_names(names)
    assert len(set(unique)) == len(names)
    assert unique[:1] == names[:1]
