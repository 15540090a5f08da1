# SPDX-License-Identifier: MIT
"""Times of a table increase, or the first cell that does not is named."""

import numpy as np
import pandas as pd
import pytest
from hypothesis import given
from hypothesis import strategies as st

from zebro_lab.files.errors import DataError
from zebro_lab.tables.cells import cell_error, require_increasing
from zebro_lab.tables.csv_files import read_csv_file
from zebro_lab.tables.raw_table import RawTable


@given(st.lists(st.integers(-5, 5), min_size=1, max_size=6))
def test_times_that_do_not_increase_are_named_by_their_row(times):
    table = RawTable("a.csv", {"t": pd.Series(times)})
    first = next((row for row in range(1, len(times)) if times[row] <= times[row - 1]), None)
    if first is None:
        require_increasing(table, "t", np.array(times, dtype=float))
        return
    with pytest.raises(DataError, match="expected increasing times") as raised:
        require_increasing(table, "t", np.array(times, dtype=float))
    assert (raised.value.column, raised.value.row) == ("t", first + 1)


def test_an_error_of_a_cell_names_its_line(tmp_path):
    (tmp_path / "a.csv").write_text("t,x\n1,2\n\n3,4\n")
    error = cell_error(read_csv_file(tmp_path / "a.csv"), "x", 1, "is bad")
    assert str(error) == f"{tmp_path / 'a.csv'}, column 'x', row 2 (line 4): is bad"
