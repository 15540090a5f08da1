# SPDX-License-Identifier: MIT
"""CSV files of every separator and encoding are read as the same table, or named."""

import gzip
from collections.abc import Callable

import numpy as np
import pandas as pd
import pytest

from support.bounded_reading import refusal
from support.rig_tables import N, given_slip
from zebro_lab.files.errors import DataError
from zebro_lab.tables.csv_files import decoded, possible_encodings, read_csv_file
from zebro_lab.tables.table_files import read_table_file

SEPARATORS = {";": "semicolons", "\t": "tabs"}


@pytest.mark.parametrize("separator", [",", ";", "\t"])
@pytest.mark.parametrize("encoding", ["utf-8", "utf-8-sig"])
@pytest.mark.parametrize("end", ["\n", "\r\n", "\r"])
def test_separator_encoding_and_line_ends_do_not_matter(tmp_path, separator, encoding, end):
    lines = ["ü s, x", "0.5, 1", "1.5, 2"]
    text = end.join(line.replace(",", separator) for line in lines)
    (tmp_path / "a.csv").write_bytes(text.encode(encoding))
    table = read_csv_file(tmp_path / "a.csv")
    assert list(table.columns) == ["ü s", "x"]
    np.testing.assert_array_equal(table.numbers("ü s"), [0.5, 1.5])
    assert table.notes == (("a.csv: cells are separated by " + SEPARATORS[separator],)
                           if separator != "," else ())  # fmt: skip


@pytest.mark.parametrize("encoding", ["latin-1", "utf-16", "utf-16-le", "utf-16-be"])
def test_other_encodings_than_utf_8_are_found(tmp_path, encoding):
    text = "Zeit [µs];Winkel [°]\r\n0,5;90\r\n1,5;91\r\n"
    (tmp_path / "a.csv").write_bytes(text.encode(encoding))
    table = read_csv_file(tmp_path / "a.csv")
    assert dict(table.units) == {"Zeit [µs]": "µs", "Winkel [°]": "°"}
    np.testing.assert_array_equal(table.numbers("Zeit [µs]"), [0.5, 1.5])
    assert table.fault("is bad", "Winkel [°]", 1).line == 3


def test_a_cell_of_the_header_may_have_line_breaks(tmp_path):
    (tmp_path / "a.csv").write_text('tyre 12" wide\n"Zeit\n[s]";"Kraft\n[N]"\n0,5;1\n1,5;2\n')
    table = read_csv_file(tmp_path / "a.csv")
    assert list(table.columns) == ["Zeit [s]", "Kraft [N]"]
    assert table.numbers("Zeit [s]").tolist() == [0.5, 1.5]
    assert table.fault("is bad", "Kraft [N]", 1).line == 6


def test_headers_that_are_empty_or_repeated_are_told_apart(tmp_path):
    (tmp_path / "a.csv").write_text("t,,x,x\n1,2,3,4\n")
    table = read_csv_file(tmp_path / "a.csv")
    assert list(table.columns) == ["t", "column 2", "x", "x (2)"]
    assert table.repeated == {"x"}


def test_a_header_of_very_many_columns_is_refused(tmp_path):
    file = tmp_path / "wide.csv"
    file.write_text(",".join(f"c{i}" for i in range(9000)) + "\n" + ",".join("1" * 9000) + "\n")
    assert "columns" in refusal(read_csv_file, file)


def test_comments_and_blank_lines_are_no_rows(tmp_path):
    text = "# bench 3\n\n" + given_slip().to_csv(index=False).replace("\n", "\n\n")
    (tmp_path / "rig.csv").write_text(text)
    assert len(read_csv_file(tmp_path / "rig.csv")) == N


def test_numbers_survive_to_the_last_bit(tmp_path):
    rng = np.random.default_rng(0)
    table = given_slip().assign(traction_force=rng.normal(size=N))
    with gzip.open(tmp_path / "a.csv.gz", "wt") as file:
        table.to_csv(file, index=False)
    read = read_csv_file(tmp_path / "a.csv.gz").numbers("traction_force")
    np.testing.assert_array_max_ulp(read, table.traction_force.to_numpy(), 1)


def _truncated_gzip() -> bytes:
    return gzip.compress(given_slip().to_csv(index=False).encode())[:-40]


RAW_FAULTS: dict[str, tuple[str, Callable[[], bytes], str]] = {
    "empty": ("a.csv", lambda: b"", "is empty"),
    "binary": ("a.csv", lambda: bytes(range(256)) * 8, "binary file"),
    "broken utf-8": (
        "a.csv",
        lambda: "t,Kraft µN\n".encode() + b"1,2\n" * 20_000 + b"3,\xb5\n",
        "is not UTF-8",
    ),
    "old spreadsheet": ("a.csv", lambda: b"\xd0\xcf\x11\xe0" + bytes(99), "old Excel (.xls)"),
    "parquet named csv": (
        "a.csv",
        lambda: b"PAR1....",
        "a Parquet file; rename it to end in .parquet",
    ),
    "spreadsheet named csv": ("a.csv", lambda: b"PK\x03\x04", "a zip or spreadsheet file"),
    "gzip named csv": ("a.csv", _truncated_gzip, "a gzip file; rename it to end in .csv.gz"),
    "csv named gzip": ("a.csv.gz", lambda: b"t,F\n1,2\n", "is not a complete gzip file"),
    "truncated gzip": ("a.csv.gz", _truncated_gzip, "is not a complete gzip file"),
    "JSON": ("a.csv", lambda: b'{"t": [0, 1]}', "is not a table but JSON, HTML or XML"),
    "surplus cell far down": (
        "a.csv",
        lambda: b"t,F\n" + b"1,2\n" * 20_000 + b"1,2,3\n",
        "is not a regular table",
    ),
    "open quote": ("a.csv", lambda: b't,F\n1,"2\n3,4\n', "is not a regular table"),
}


@pytest.mark.parametrize("fault", RAW_FAULTS)
def test_file_that_is_no_table_is_named(tmp_path, fault):
    name, content, expected = RAW_FAULTS[fault]
    (tmp_path / name).write_bytes(content())
    message = refusal(read_table_file, tmp_path / name)
    assert expected in message
    assert message.startswith(str(tmp_path / name))


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


def test_a_character_cut_at_the_end_is_no_fault():
    assert decoded("aµ".encode()[:-1], "utf-8") == "a"
    assert possible_encodings("bµµ".encode()[:-1]) == ("utf-8",)


def test_bytes_that_are_no_text_have_no_encoding():
    assert possible_encodings(bytes(range(256))) == ()
    assert possible_encodings(b"\x81\x8d") == ()
