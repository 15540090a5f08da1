# SPDX-License-Identifier: MIT
"""Rows that look like data and are none are refused."""

import numpy as np
import pytest

from zebro_lab.files.errors import DataError
from zebro_lab.tables.table_files import read_table_file


def test_a_row_between_blanks_that_lacks_a_cell_is_named(tmp_path):
    file = tmp_path / "a.dat"
    file.write_text("t Fn Ft\n\n0 6.63 1.25\n1      1.30\n")
    with pytest.raises(DataError, match=r"row 2 \(line 4\): the row has 2 cells, the header has 3"):
        read_table_file(file)
    file.write_text("t Fn Ft\n\n0 6.63 1.25\n1 nan 1.30\n2 6.7 nan\n")
    np.testing.assert_array_equal(read_table_file(file).numbers("Ft"), [1.25, 1.3, np.nan])


@pytest.mark.parametrize("footer", ["Mean", "Mittelwert", "std:", "Total (2)", "END"])
def test_a_line_of_means_below_the_numbers_is_named(tmp_path, footer):
    file = tmp_path / "a.csv"
    file.write_text(f"n;F\n1;2\n2;3\n{footer};2,5\n")
    with pytest.raises(DataError, match=r"column 'n', row 3 \(line 4\): .* stands below numbers"):
        read_table_file(file)


def test_words_in_a_column_of_words_are_no_footer(tmp_path):
    file = tmp_path / "a.csv"
    file.write_text("what,F\nmin,2\nmax,3\n")
    assert len(read_table_file(file)) == 2
