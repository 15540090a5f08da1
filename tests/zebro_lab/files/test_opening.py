# SPDX-License-Identifier: MIT
"""Files that users bring, opened."""

import os

import pytest

from zebro_lab.files.errors import DataError
from zebro_lab.files.opening import read_bytes


def test_what_is_no_file_is_told_with_its_name_once(tmp_path):
    os.mkfifo(tmp_path / "x")
    with pytest.raises(DataError) as caught:
        read_bytes(tmp_path / "x", most=1)
    assert str(caught.value) == f"{tmp_path / 'x'}: is a FIFO; expected a file"
