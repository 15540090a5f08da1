# SPDX-License-Identifier: MIT
"""Parquet files are read as tables, within memory whatever they claim."""

import subprocess
import sys
from pathlib import Path

import numpy as np
import pyarrow as pa
import pyarrow.parquet as pq
import pytest

from support.bounded_reading import refusal
from zebro_lab.calibration.rig_data import read_rig_data
from zebro_lab.tables.table_files import read_table_file


def parquet(folder: Path, table: pa.Table, **options: object) -> Path:
    pq.write_table(table, folder / "x.parquet", **options)
    return folder / "x.parquet"


@pytest.mark.parametrize("column", ["run", "slip_definition"])
@pytest.mark.parametrize("kind", ["struct", "list"])
def test_parquet_cells_of_other_kinds_are_named(kind, column, tmp_path):
    cells = {
        "struct": pa.array([{"x": 1}] * 30),
        "list": pa.array([[1, 2]] * 30),
    }[kind]
    columns = {
        "t": np.arange(30.0), "slip_ratio": np.linspace(0, 0.3, 30), "normal_force": np.full(30, 5),
        "traction_force": np.linspace(0, 2, 30), "slip_definition": ["material"] * 30,
    }  # fmt: skip
    file = parquet(tmp_path, pa.table({**columns, column: cells}))
    assert f"column '{column}'" in refusal(lambda path: read_rig_data([path]), file)


def test_wrong_statistics_of_a_parquet_column_are_an_error_and_no_end_of_the_process(tmp_path):
    """A histogram of levels that is too long ends pyarrow where a column is asked for."""
    code = (
        "import sys; from pathlib import Path; from zebro_lab.files.errors import DataError\n"
        "from zebro_lab.tables.table_files import read_table_file\n"
        "try: read_table_file(Path(sys.argv[1]))\n"
        "except DataError as error: print(error)"
    )
    file = Path(__file__).with_name("wrong_histogram.parquet")
    done = subprocess.run([sys.executable, "-c", code, str(file)], capture_output=True, text=True)
    assert (done.returncode, done.stdout.count("\n")) == (0, 1), done.stderr
    assert "is not a complete Parquet file" in done.stdout


def test_without_pyarrow_the_line_says_how_to_get_it(tmp_path, monkeypatch):
    file = parquet(tmp_path, pa.table({"t": [0.0, 1.0]}))
    monkeypatch.delitem(sys.modules, "zebro_lab.tables.parquet_files", raising=False)
    monkeypatch.setitem(sys.modules, "pyarrow", None)
    assert "needs pyarrow: pip install 'zebro-lab[parquet]'" in refusal(read_table_file, file)
