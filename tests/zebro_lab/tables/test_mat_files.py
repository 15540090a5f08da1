# SPDX-License-Identifier: MIT
"""MATLAB files are tables of their arrays, or say what to save instead."""

import contextlib
import gzip
import io
from pathlib import Path

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st
from scipy.io import savemat

from zebro_lab.files.errors import DataError
from zebro_lab.tables.table_files import read_table_file

T = np.arange(5.0)


def saved(file: Path, *, packed: bool = False, **arrays: object) -> Path:
    content = io.BytesIO()
    savemat(content, arrays, do_compression=packed)
    data = content.getvalue()
    file.write_bytes(gzip.compress(data) if file.name.endswith(".gz") else data)
    return file


@pytest.mark.parametrize("name", ["rig.mat", "rig.mat.gz"])
@pytest.mark.parametrize("packed", [False, True])
def test_rows_and_columns_of_one_length_are_columns(tmp_path, name, packed):
    file = saved(tmp_path / name, packed=packed, t=T, FZ=T[:, None], FX=T.astype("int16"), SL=-T,
                 rate=3.0, gains=np.ones(3), matrix=np.ones((5, 2)), waves=T + 1j, tyre="own",
                 bench={"FY": T}, parts=np.array([T, "x"], dtype=object), none=[])  # fmt: skip
    table = read_table_file(file)
    found = {name: table.numbers(name).tolist() for name in table.columns}
    numbers = T.tolist()
    assert found == {"t": numbers, "FZ": numbers, "FX": numbers, "SL": (-T).tolist()}
    assert table.notes == (f"{name}: arrays of another length than 5 are not read: 'gains'",)


@pytest.mark.parametrize(
    ("content", "problem"),
    [
        (b"MATLAB 7.3 MAT-file, Platform: GLNXA64" + bytes(500), "version 7.3 .*option -v7"),
        (b"MATLAB 5.0 MAT-file, Platform: GLNXA64" + bytes(9), "is not a whole MATLAB file"),
        (b"t,x\n1,2\n", "is not a whole MATLAB file"),
    ],
)
def test_a_file_that_is_not_read_says_what_to_save(tmp_path, content, problem):
    (tmp_path / "rig.mat").write_bytes(content)
    with pytest.raises(DataError, match=problem):
        read_table_file(tmp_path / "rig.mat")


def test_a_file_without_arrays_says_what_is_expected(tmp_path):
    with pytest.raises(DataError, match="no row or column of numbers; expected one"):
        read_table_file(saved(tmp_path / "rig.mat", rate=3.0, matrix=np.ones((5, 2))))


@given(st.data())
def test_a_damaged_file_is_refused_or_read_and_ends_nothing(tmp_path_factory, data):
    file = tmp_path_factory.mktemp("mat") / "rig.mat"
    content = bytearray(saved(file, t=T, F=T).read_bytes())
    for place in data.draw(st.lists(st.integers(0, len(content) - 1), max_size=4)):
        content[place] = data.draw(st.integers(0, 255))
    file.write_bytes(content[: data.draw(st.integers(1, len(content)))])
    with contextlib.suppress(DataError):
        read_table_file(file)
