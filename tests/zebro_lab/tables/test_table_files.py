# SPDX-License-Identifier: MIT
"""A table file is known by the end of its name."""

import gzip
import io

import pandas as pd
import pytest

from zebro_lab.files.errors import DataError, NotFound
from zebro_lab.tables.table_files import is_table_file, read_table_file, table_stem

TABLE = pd.DataFrame({"t": [0.0, 0.5], "x": [1.0, 2.0]})


SEPARATORS = {".tsv": "\t", ".dat": " ", ".txt": ";"}


@pytest.mark.parametrize("packed", ["", ".gz"])
@pytest.mark.parametrize(
    "name", ["a.csv", "A.CSV", "a.tsv", "a.dat", "a.lvm", "a.txt", "a.parquet", "a.xlsx"]
)
def test_every_format_reads_the_same(tmp_path, name, packed):
    file = tmp_path / (name + packed)
    content = io.BytesIO()
    if name.endswith("parquet"):
        TABLE.to_parquet(content)
    elif name.endswith("xlsx"):
        pytest.importorskip("openpyxl")
        TABLE.to_excel(content, index=False)
    else:
        TABLE.to_csv(content, index=False, sep=SEPARATORS.get(name[-4:].lower(), ","))
    file.write_bytes(gzip.compress(content.getvalue()) if packed else content.getvalue())
    assert is_table_file(file) == (not name.endswith(".txt"))  # in folders mostly notes
    found = read_table_file(file)
    assert {name: found.numbers(name).tolist() for name in found.columns} == TABLE.to_dict("list")
    assert table_stem(file).lower() == "a"


def test_what_is_no_table_file_is_named(tmp_path):
    with pytest.raises(NotFound, match=r"absent\.csv: no such file"):
        read_table_file(tmp_path / "absent.csv")
    for name in ("folder.csv", "x.xlsx"):
        (tmp_path / name).mkdir()
        with pytest.raises(DataError, match=r"is not a table file; .*\.csv, \.tsv, .*\.xlsx"):
            read_table_file(tmp_path / name)


def test_a_table_without_rows_is_refused(tmp_path):
    TABLE.head(0).to_parquet(tmp_path / "a.parquet")
    with pytest.raises(DataError, match="has a header but no rows"):
        read_table_file(tmp_path / "a.parquet")


@pytest.mark.parametrize(
    ("name", "advice"),
    [
        ("a.xls", "save it as .xlsx"),
        ("a.tdms", "export"),
        ("run.ZIP", "unpack it"),
        ("run.tar.gz", "unpack it"),
        ("a.csv.xz", "unpack it"),
    ],
)
def test_a_format_that_is_not_read_says_how_to_export(tmp_path, name, advice):
    (tmp_path / name).write_bytes(b"x")
    with pytest.raises(DataError, match=advice):
        read_table_file(tmp_path / name)


def test_the_lock_file_of_a_workbook_is_no_table(tmp_path):
    assert not is_table_file(tmp_path / "~$rig.xlsx")
