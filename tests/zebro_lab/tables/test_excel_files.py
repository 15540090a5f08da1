# SPDX-License-Identifier: MIT
"""Sheets of workbooks are read as text tables are, or refused in one line."""

import sys
from datetime import datetime
from pathlib import Path

import pytest

from support.bounded_reading import refusal
from zebro_lab.files.errors import DataError
from zebro_lab.tables.table_files import read_table_file

openpyxl = pytest.importorskip("openpyxl")


def book(file: Path, **sheets) -> Path:
    made = openpyxl.Workbook()
    made.remove(made.active)
    for name, rows in sheets.items():
        sheet = made.create_sheet(name)
        for row in rows:
            sheet.append(row)
    made.save(file)
    return file


ROWS = [["Messung 5"], [], ["Zeit", "Kraft", "wann"], ["ms", "N", None],
        [0.5, "1,5", datetime(2026, 3, 4)], [1.5, "n.a.", datetime(2026, 3, 5)], []]  # fmt: skip


def test_titles_units_and_texts_of_numbers_are_read(tmp_path):
    table = read_table_file(book(tmp_path / "a.xlsx", Daten=ROWS, Leer=[]))
    assert list(table.columns) == ["Zeit", "Kraft", "wann"]
    assert dict(table.units) == {"Zeit": "ms", "Kraft": "N"}
    assert table.numbers("Kraft").tolist()[0] == 1.5
    assert table.notes[0] == "a.xlsx: sheet 'Daten'"
    with pytest.raises(DataError, match=r"'Kraft', row 2 \(line 6\): is empty"):
        table.require_finite("Kraft", table.numbers("Kraft"))
    assert table.columns["wann"].iloc[1] == datetime(2026, 3, 5)


def test_of_several_sheets_one_must_be_named(tmp_path):
    file = book(tmp_path / "a.xlsx", A=ROWS, B=[["t", "F"], [1, 2], [2, 3]])
    assert "several sheets with cells, 'A', 'B'; name one with sheet" in refusal(
        read_table_file, file
    )
    assert read_table_file(file, sheet="B").numbers("F").tolist() == [2, 3]
    with pytest.raises(DataError, match="has no sheet 'C'; it has 'A', 'B'"):
        read_table_file(file, sheet="C")


def test_a_formula_without_a_stored_value_is_named(tmp_path):
    file = book(tmp_path / "a.xlsx", A=[["t", "F"], [1, 2], [2, "=2*B2"]])
    assert "row 3, column 2 of sheet 'A' has a formula without a stored value" in refusal(
        read_table_file, file
    )


@pytest.mark.parametrize(
    ("content", "problem"),
    [
        (b"t,F\n1,2\n", "is not an Excel workbook; if it is text, rename it"),
        (b"PK\x03\x04", "cannot be read as an Excel workbook"),
    ],
)
def test_what_is_no_workbook_is_refused(tmp_path, content, problem):
    (tmp_path / "a.xlsx").write_bytes(content)
    assert problem in refusal(read_table_file, tmp_path / "a.xlsx")


def test_without_openpyxl_the_line_says_how_to_get_it(tmp_path, monkeypatch):
    file = book(tmp_path / "a.xlsx", A=ROWS)
    monkeypatch.setitem(sys.modules, "openpyxl", None)
    assert "needs openpyxl: pip install openpyxl" in refusal(read_table_file, file)


def test_a_sheet_without_numbers_or_header_is_refused(tmp_path):
    assert "has no row with numbers" in refusal(
        read_table_file, book(tmp_path / "a.xlsx", A=[["a", "b"], ["c", "d"]])
    )
    assert "has no header: the first row is '1, 2'" in refusal(
        read_table_file, book(tmp_path / "b.xlsx", A=[[1, 2], [3, 4]])
    )
    assert "is empty" in refusal(read_table_file, book(tmp_path / "c.xlsx", A=[]))


def test_a_ratio_that_is_shown_in_percent_is_a_ratio(tmp_path):
    made = openpyxl.Workbook()
    for row in (["t [s]", "slip [%]"], [0, 0.025], [1, 0.05]):
        made.active.append(row)
    made.active["B2"].number_format = made.active["B3"].number_format = "0.0%"
    made.save(tmp_path / "a.xlsx")
    table = read_table_file(tmp_path / "a.xlsx")
    assert table.units["slip [%]"] == "dimensionless"
    assert "'slip [%]' is shown in percent and stored as a ratio" in table.notes[-1]
