# SPDX-License-Identifier: MIT
"""MATLAB files are tables of their arrays, or say what to save instead."""

import gzip
import io
from pathlib import Path

import numpy as np
import pytest
from scipy.io import savemat

from zebro_lab.files.errors import DataError
from zebro_lab.tables.table_files import read_table_file

T = np.arange(5.0)


def saved(file: Path, **arrays: object) -> Path:
    content = io.BytesIO()
    savemat(content, arrays, do_compression=True)
    data = content.getvalue()
    file.write_bytes(gzip.compress(data) if file.name.endswith(".gz") else data)
    return file


@pytest.mark.parametrize("name", ["rig.mat", "rig.mat.gz"])
def test_rows_columns_and_fields_of_one_length_are_columns(tmp_path, name):
    bench = {"FX": T.astype("int16"), "tyre": "own", "more": {"SL": -T}}
    file = saved(tmp_path / name, t=T, FZ=T[:, None], bench=bench, rate=3.0, gains=np.ones(3),
                 matrix=np.ones((5, 2)))  # fmt: skip
    table = read_table_file(file)
    found = {name: table.numbers(name).tolist() for name in table.columns}
    numbers = T.tolist()
    assert found == {"t": numbers, "FZ": numbers, "FX": numbers, "SL": (-T).tolist()}
    assert table.notes == (f"{name}: arrays of another length than 5 are not read: 'gains'",)


@pytest.mark.parametrize(
    ("content", "problem"),
    [
        (b"MATLAB 7.3 MAT-file, Platform: GLNXA64" + bytes(500), "version 7.3 .*option -v7"),
        (b"MATLAB 5.0 MAT-file, Platform: GLNXA64" + bytes(9), "is not a MATLAB file"),
        (b"t,x\n1,2\n", "is not a MATLAB file"),
    ],
)
def test_a_file_that_is_not_read_says_what_to_save(tmp_path, content, problem):
    (tmp_path / "rig.mat").write_bytes(content)
    with pytest.raises(DataError, match=problem):
        read_table_file(tmp_path / "rig.mat")


def test_a_file_without_arrays_says_what_is_expected(tmp_path):
    with pytest.raises(DataError, match=r"no array of numbers.* all of one length"):
        read_table_file(saved(tmp_path / "rig.mat", rate=3.0, matrix=np.ones((5, 2))))
