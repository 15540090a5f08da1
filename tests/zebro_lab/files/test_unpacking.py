# SPDX-License-Identifier: MIT
"""Text tables unpack line by line up to limits, and beyond them reading ends with an error."""

import gzip
from pathlib import Path

import pytest

from support.bounded_reading import refusal
from zebro_lab.files import unpacking
from zebro_lab.files.errors import DataError
from zebro_lab.files.unpacking import LONGEST_LINE, open_unpacked
from zebro_lab.tables.table_files import read_table_file

TEXT = b"a,b\n1,2\n" * 1000


def packed(file: Path, text: bytes) -> Path:
    file.write_bytes(gzip.compress(text, 1))
    return file


def read(file: Path, *, width: int = 1) -> bytes:
    with open_unpacked(file, width=width) as opened:
        return b"".join(iter(lambda: opened.read(1 << 16), b""))


def test_a_packed_and_a_plain_file_read_the_same(tmp_path):
    (tmp_path / "a.csv").write_bytes(TEXT)
    assert read(tmp_path / "a.csv") == read(packed(tmp_path / "A.CSV.GZ", TEXT)) == TEXT
    with open_unpacked(tmp_path / "a.csv") as opened:
        assert opened.read() == TEXT


def test_a_gzip_file_cut_short_and_one_that_is_none_are_refused(tmp_path):
    file = packed(tmp_path / "a.csv.gz", TEXT)
    file.write_bytes(file.read_bytes()[:-20])
    assert "is not a complete gzip file" in refusal(read, file)
    file.write_bytes(TEXT)
    assert "is not a complete gzip file" in refusal(read, file)


def test_a_file_that_unpacks_to_far_more_than_its_size_is_refused(tmp_path, monkeypatch):
    monkeypatch.setattr(unpacking, "FREELY", 1 << 20)
    row = b"0" * 1023 + b"\n"
    file = packed(tmp_path / "a.csv.gz", row * 1024)
    assert len(read(file)) == 1 << 20  # as much is read of any file
    packed(file, row * 4096)
    assert "unpacks to more than 100 times its size" in refusal(read, file)


@pytest.mark.parametrize("end", [b"", b"\n"])
def test_a_line_of_more_than_a_megabyte_is_refused(tmp_path, end):
    (tmp_path / "a.csv").write_bytes(b"x" * (LONGEST_LINE - 1) + b"\n" + b"y" * 10)
    assert len(read(tmp_path / "a.csv")) == LONGEST_LINE + 10
    (tmp_path / "a.csv").write_bytes(b"1\n" + b"x" * (LONGEST_LINE + (1 << 17)) + end)
    assert "has a line of more than 1 MB" in refusal(read, tmp_path / "a.csv")


def test_cells_are_lines_times_width(tmp_path, monkeypatch):
    monkeypatch.setattr(unpacking, "MOST_CELLS", 2000)
    (tmp_path / "a.csv").write_bytes(b"1,2\n" * 1000)
    assert len(read(tmp_path / "a.csv", width=2)) == 4000
    with pytest.raises(DataError, match="million cells"):
        read(tmp_path / "a.csv", width=3)


def test_a_bomb_of_cells_is_refused_within_memory(tmp_path):
    file = tmp_path / "bomb.csv.gz"
    row = b"1,2,3,4,5,6,7,8\n"
    with gzip.open(file, "wb", compresslevel=1) as out:
        out.write(b"a,b,c,d,e,f,g,h\n")
        block = row * ((1 << 20) // len(row))
        for _ in range(160):
            out.write(block)
    assert "million cells" in refusal(read_table_file, file, megabytes=500)
