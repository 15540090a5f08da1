# SPDX-License-Identifier: MIT
"""Rows that look like data and are none are refused."""

import re

import numpy as np
import pandas as pd
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


@pytest.mark.parametrize("suffix", [".csv", ".xlsx", ".parquet"])
@pytest.mark.parametrize("words", [["a", None, "b", "Mittelwert"], [None, None, "Mean", "std"]])
def test_a_row_of_means_is_refused_by_its_word_in_a_column_of_texts(tmp_path, suffix, words):
    if suffix == ".xlsx":
        pytest.importorskip("openpyxl")
    table = pd.DataFrame({"F": [1.0, 2.0, 3.0, 2.0], "Bemerkung": words})
    write = {".csv": table.to_csv, ".xlsx": table.to_excel, ".parquet": table.to_parquet}[suffix]
    write(tmp_path / f"a{suffix}", index=False)
    with pytest.raises(DataError, match=r"column 'Bemerkung', row [34].*stands below the rows"):
        read_table_file(tmp_path / f"a{suffix}")


@pytest.mark.parametrize(
    "words",
    [["start", None, "x", "end"], ["low", "max", "low", "max"], ["a", "b", "mean", "mean"],
     ["mean", "min", "max", "sum"], [None, None, None, None], ["mean", "x", None, "mean"]],
)  # fmt: skip
def test_remarks_that_end_otherwise_are_no_footer(tmp_path, words):
    table = pd.DataFrame({"F": [1.0, 2.0, 3.0, 2.0], "what": words})
    table.to_parquet(tmp_path / "a.parquet", index=False)
    assert len(read_table_file(tmp_path / "a.parquet")) == 4


def test_words_in_a_column_of_words_are_no_footer(tmp_path):
    file = tmp_path / "a.csv"
    file.write_text("what,F\nmin,2\nmax,3\n")
    assert len(read_table_file(file)) == 2


@pytest.mark.parametrize(
    ("rows", "line"),
    [
        ("0,5\n1,6\n\nTrajectories,\n2,7\n", 5), ("0,5\n1,6\nt,F\n2,7\n", 4),
        ("0,5\n1,n/m\n2,7\n", None), ("0,\n1,6\n2,7\n", None), ("0,5\nok,6\n2,7\n", None),
    ],
)  # fmt: skip
def test_a_line_of_words_between_numbers_is_noted_when_a_table_is_read(tmp_path, rows, line):
    (tmp_path / "a.csv").write_text("t,F\n" + rows)
    notes = [note for note in read_table_file(tmp_path / "a.csv").notes if "of words" in note]
    expected = f"a.csv: line {line}, .* another table or recording may begin there"
    assert len(notes) == (line is not None)
    assert line is None or re.match(expected, notes[0])
