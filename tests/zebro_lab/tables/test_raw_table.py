# SPDX-License-Identifier: MIT
"""Cells become numbers, or an error names file, column, row and line."""

from pathlib import Path

import numpy as np
import pandas as pd
import pytest
from hypothesis import given
from hypothesis import strategies as st

from zebro_lab.files.errors import DataError
from zebro_lab.tables.csv_files import read_csv_file
from zebro_lab.tables.raw_table import RawTable, differing_headers


def table(**columns) -> RawTable:
    return RawTable(Path("a.csv"), {name: pd.Series(cells) for name, cells in columns.items()})


@given(st.lists(st.floats(allow_nan=False) | st.none(), min_size=1))
def test_numbers_and_their_texts_are_the_same_and_empty_cells_are_nan(values):
    expected = [np.nan if value is None else value for value in values]
    texts = [None if value is None else repr(value) for value in values]
    np.testing.assert_array_equal(table(x=pd.Series(texts, dtype=object)).numbers("x"), expected)
    np.testing.assert_array_equal(table(x=pd.Series(values, dtype=float)).numbers("x"), expected)


@pytest.mark.parametrize(
    ("raw", "message"),
    [
        (table(T=[1.0]), "column 't': is missing; did you mean 'T'"),
        (RawTable(Path("a.csv"), {"t": pd.Series([1.0])}, frozenset({"t"})),
         "column 't': several columns have this header"),
        (RawTable(Path("a.csv"), {"t": pd.Series([None])}, unreadable={"t": "list<int>"}),
         "column 't': holds cells of type list<int>; expected numbers"),
        (table(t=pd.date_range("2026-01-01", periods=3)), "'t': holds dates or durations"),
        (table(t=["[s]", "1"]), r"row 1: '\[s\]' is not a number; if the row holds units"),
        (table(t=["1", "n/m"]), "row 2: 'n/m' is not a number; correct or delete the row"),
        (table(t=["0.1", "0,5"]), "row 2: '0,5' is not a number; write decimals with a point"),
    ],
)  # fmt: skip
def test_a_column_that_has_no_numbers_is_named(raw, message):
    with pytest.raises(DataError, match=message) as raised:
        raw.numbers("t")
    assert (raised.value.file, raised.value.column) == (Path("a.csv"), "t")


def test_decimal_commas_are_read():
    cells = {"x": pd.Series(["0,5", "-1,25e1", None])}
    raw = RawTable(Path("a.csv"), cells)
    np.testing.assert_array_equal(raw.numbers("x"), [0.5, -12.5, np.nan])


def test_a_row_is_found_below_comments_and_blank_lines(tmp_path):
    file = tmp_path / "a.csv"
    file.write_text("# bench\n\nt,x\n1,2\n\n\n3,4\n")
    raw = read_csv_file(file)
    assert [raw.fault("is bad", "x", index).line for index in (0, 1, 2)] == [4, 7, None]
    assert str(raw.fault("is bad", "x", 1)) == f"{file}, column 'x', row 2 (line 7): is bad"
    assert raw.fault("is bad", "x").line is None
    assert table(t=[1.0]).fault("is bad", "t", 0).line is None


@given(st.lists(st.integers(-5, 5), min_size=1, max_size=6))
def test_times_that_do_not_increase_are_named_by_their_row(times):
    first = next((row for row in range(1, len(times)) if times[row] <= times[row - 1]), None)
    if first is None:
        table(t=times).require_increasing("t", np.array(times, dtype=float))
        return
    with pytest.raises(DataError, match="expected increasing times") as raised:
        table(t=times).require_increasing("t", np.array(times, dtype=float))
    assert (raised.value.column, raised.value.row) == ("t", first + 1)


@pytest.mark.parametrize(
    ("cells", "decimal", "numbers"),
    [
        (["1,234", "2,345"], ",", [1.234, 2.345]), (["1.234", "0.5"], ",", [1.234, 0.5]),
        (["−5,25", "1"], ",", [-5.25, 1]), (["1,25", "2,345"], None, [1.25, 2.345]),
    ],
)  # fmt: skip
def test_a_decimal_sign_is_understood_where_it_is_sure(cells, decimal, numbers):
    raw = RawTable(Path("a.csv"), {"x": pd.Series(cells)}, decimal=decimal)
    np.testing.assert_array_equal(raw.numbers("x"), numbers)


@pytest.mark.parametrize(
    ("cells", "decimal", "problem"),
    [
        (["1,234", "2,345"], None, "'1,234' has a decimal sign or a thousands separator"),
        (["1.234", "2.345"], ",", "'1.234' has a decimal sign or a thousands separator"),
        (["1.234,5"], ",", "without thousands separators"),
        (["1 234,5"], ",", "without thousands separators"),
        (["1'234.5"], ".", "without thousands separators"),
        (["5.2 N"], ".", "write the number alone, and its unit in the header"),
        (["2,5%"], ",", "write the number alone"),
        (["5.01 ± 0.02"], ".", "write one number alone in the cell, or delete the row"),
        (["(0.395)"], ".", "write one number alone"),
        (["00:05.10"], ".", 'if it is a time, state unit = "date"'),
        (["2026-03-04"], ".", 'if it is a time, state unit = "date"'),
    ],
)
def test_a_number_that_is_not_clear_is_refused(cells, decimal, problem):
    raw = RawTable(Path("a.csv"), {"x": pd.Series(cells)}, decimal=decimal)
    with pytest.raises(DataError, match=f"row 1: .*{problem}"):
        raw.numbers("x")


def test_a_wrong_cell_is_no_heading(tmp_path):
    file = tmp_path / "a.csv"
    file.write_text("t,F\n1,2\nn/m,3\n3,4\n")
    with pytest.raises(DataError, match=r"row 2 \(line 3\): 'n/m' is not a number"):
        read_csv_file(file).numbers("t")


@pytest.mark.parametrize(("cell", "found"), [(9.9e37, r"9.9e\+37, which"), (-1e38, "-1e")])
def test_the_mark_of_an_overload_is_no_number(cell, found):
    with pytest.raises(DataError, match=f"row 2: is {found}.*instruments write at an overload"):
        table(F=[1.0]).require_finite("F", np.array([1.0, cell]))
    table(F=[1.0]).require_finite("F", np.array([1.0, 1e29]))


def test_equal_columns_of_one_header_are_one():
    columns = {name: pd.Series(cells) for name, cells in (
        ("t", [0.0, 1.0]), ("t (2)", [0.0, 1.0]), ("F", [1.0, 2.0]), ("F (2)", [1.0, 3.0]),
    )}  # fmt: skip
    assert differing_headers({"t", "F"}, columns) == {"F"}
