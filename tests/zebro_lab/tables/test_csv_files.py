# SPDX-License-Identifier: MIT
"""CSV files of every separator are read as the same table."""

from support.bounded_reading import refusal
from zebro_lab.tables.table_files import read_table_file


def test_a_header_of_very_many_columns_is_refused(tmp_path):
    file = tmp_path / "wide.csv"
    file.write_text(",".join(f"c{i}" for i in range(9000)) + "\n" + ",".join("1" * 9000) + "\n")
    assert "columns" in refusal(read_table_file, file)
