# SPDX-License-Identifier: MIT
"""A table file is known by the end of its name."""

import pandas as pd
import pytest

from zebro_lab.files.errors import DataError, NotFound
from zebro_lab.tables.table_files import is_table_file, read_table_file, table_stem

TABLE = pd.DataFrame({"t": [0.0, 0.5], "x": [1.0, 2.0]})


@pytest.mark.parametrize("name", ["a.csv", "A.CSV", "a.csv.gz", "a.parquet"])
def test_every_format_reads_the_same(tmp_path, name):
    file = tmp_path / name
    if name.endswith("parquet"):
        TABLE.to_parquet(file)
    else:
        TABLE.to_csv(file, index=False)
    assert is_table_file(file)
    found = read_table_file(file)
    assert {name: found.numbers(name).tolist() for name in found.columns} == TABLE.to_dict("list")
    assert table_stem(file).lower() == "a"


def test_what_is_no_table_file_is_named(tmp_path):
    with pytest.raises(NotFound, match=r"absent\.csv: no such file"):
        read_table_file(tmp_path / "absent.csv")
    for name in ("folder.csv", "x.xlsx"):
        (tmp_path / name).mkdir()
        with pytest.raises(DataError, match=r"is not a table file; .*\.csv, \.csv\.gz, \.parquet"):
            read_table_file(tmp_path / name)


def test_a_table_without_rows_is_refused(tmp_path):
    TABLE.head(0).to_parquet(tmp_path / "a.parquet")
    with pytest.raises(DataError, match="has a header but no rows"):
        read_table_file(tmp_path / "a.parquet")
