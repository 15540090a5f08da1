# SPDX-License-Identifier: MIT
"""Files that users bring, opened."""

import os

import pytest

from support.bounded_reading import error_on_fifo
from zebro_lab.files.errors import DataError
from zebro_lab.files.opening import read_bytes
from zebro_lab.mcap.raw_log import read_raw_log
from zebro_lab.mcap.slip_rig_log import read_log
from zebro_lab.tables.table_files import read_table_file
from zebro_lab.track.trajectory.numbers import read_number_lines


def test_what_is_no_file_is_told_with_its_name_once(tmp_path):
    os.mkfifo(tmp_path / "x")
    with pytest.raises(DataError) as caught:
        read_bytes(tmp_path / "x", most=1)
    assert str(caught.value) == f"{tmp_path / 'x'}: is a FIFO; expected a regular file"


@pytest.mark.parametrize("reader", [read_number_lines, read_raw_log, read_log, read_table_file])
def test_a_fifo_named_as_data_does_not_hang(reader, tmp_path):
    assert "FIFO" in str(error_on_fifo(reader, tmp_path / "x.csv"))
