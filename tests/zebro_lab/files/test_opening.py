# SPDX-License-Identifier: MIT
"""Files that users bring, opened."""

import gzip
import os

import pytest

from support.bounded_reading import error_on_fifo, refusal
from zebro_lab.files import opening
from zebro_lab.files.errors import DataError
from zebro_lab.files.opening import read_bytes, read_unpacked
from zebro_lab.mcap.raw_log import read_raw_log
from zebro_lab.tables.table_files import read_table_file


def test_what_is_no_file_is_told_with_its_name_once(tmp_path):
    os.mkfifo(tmp_path / "x")
    with pytest.raises(DataError) as caught:
        read_bytes(tmp_path / "x", most=1)
    assert str(caught.value) == f"{tmp_path / 'x'}: is a FIFO; expected a regular file"


@pytest.mark.parametrize("reader", [read_raw_log, read_table_file])
def test_a_fifo_named_as_data_does_not_hang(reader, tmp_path):
    assert "FIFO" in str(error_on_fifo(reader, tmp_path / "x.csv"))


def test_a_packed_and_a_plain_file_read_the_same(tmp_path):
    (tmp_path / "a.csv").write_bytes(b"a,b\n")
    (tmp_path / "A.CSV.GZ").write_bytes(gzip.compress(b"a,b\n"))
    assert read_unpacked(tmp_path / "a.csv") == read_unpacked(tmp_path / "A.CSV.GZ") == b"a,b\n"


def test_a_gzip_file_cut_short_and_one_that_is_none_are_refused(tmp_path):
    for content in (gzip.compress(b"a,b\n" * 1000)[:-20], b"a,b\n"):
        (tmp_path / "a.csv.gz").write_bytes(content)
        assert "is not a complete gzip file" in refusal(read_unpacked, tmp_path / "a.csv.gz")


@pytest.mark.parametrize("name", ["a.csv", "a.csv.gz"])
def test_a_table_that_is_too_large_when_unpacked_is_refused(name, tmp_path, monkeypatch):
    content = bytes(4 << 20)
    (tmp_path / name).write_bytes(gzip.compress(content) if name.endswith("gz") else content)
    assert len(read_unpacked(tmp_path / name)) == 4 << 20
    for limit in ("MOST_TABLE", "MOST_UNPACKED"):
        monkeypatch.setattr(opening, limit, 1 << 20)
    with pytest.raises(DataError, match=r"at most|unpacks to"):
        read_unpacked(tmp_path / name)
