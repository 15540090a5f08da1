# SPDX-License-Identifier: MIT
"""Photographs are read, or named with what is wrong, and soon."""

import errno
import io
import os
import struct
import zlib
from pathlib import Path

import numpy as np
import PIL.Image
import pytest

from support.hostile_files import within_two_seconds
from support.written_photos import write_photo
from tracking.errors import PhotoError, TrackingError
from tracking.images import exif_time, find_photos, open_picture, read_pixels
from zebro_lab.track.photo_sequence import upright_size


def test_photographs_are_counted_as_people_count(tmp_path):
    for name in ("p10.jpg", "p2.jpg", "p1.JPG", "notes.txt"):
        write_photo(tmp_path / name) if name != "notes.txt" else (tmp_path / name).write_text("")
    assert [path.name for path in find_photos(tmp_path)] == ["p1.JPG", "p2.jpg", "p10.jpg"]


def test_a_folder_without_photographs_is_named(tmp_path):
    with pytest.raises(TrackingError, match="holds no photographs"):
        find_photos(tmp_path)


def test_pixels_come_as_bgr_and_upright(tmp_path):
    pixels = np.zeros((48, 64, 3), np.uint8)
    pixels[:, :, 0] = 200
    found = read_pixels(write_photo(tmp_path / "a.png", pixels))
    assert found[5, 5].tolist() == [0, 0, 200]
    turned = read_pixels(write_photo(tmp_path / "b.jpg", pixels, orientation=6))
    assert turned.shape == (64, 48, 3)


def test_a_photograph_that_must_not_be_read_is_a_bad_one(tmp_path, monkeypatch):
    path = write_photo(tmp_path / "a.jpg")

    def refused(*_, **__):
        raise PermissionError(errno.EACCES, "Permission denied")

    monkeypatch.setattr(Path, "open", refused)
    with pytest.raises(PhotoError, match=r"a\.jpg: cannot be opened \(Permission denied\)"):
        read_pixels(path)


@pytest.mark.parametrize("bug", [KeyError("t"), TypeError("no number"), ZeroDivisionError("0")])
def test_an_error_of_the_caller_is_not_put_down_to_the_file(tmp_path, bug):
    with pytest.raises(type(bug)), open_picture(write_photo(tmp_path / "a.jpg")):
        raise bug


def test_a_photograph_of_another_size_is_named(tmp_path):
    with pytest.raises(PhotoError, match="64x48 px; expected 1280x960"):
        read_pixels(write_photo(tmp_path / "a.jpg"), size=(1280, 960))


def png_of_claims(file: Path, *, width: int, height: int, data: bytes = b"") -> Path:
    def block(kind: bytes, body: bytes) -> bytes:
        return (
            struct.pack(">I", len(body)) + kind + body + struct.pack(">I", zlib.crc32(kind + body))
        )

    header = struct.pack(">IIBBBBB", width, height, 8, 2, 0, 0, 0)
    file.write_bytes(b"\x89PNG\r\n\x1a\n" + block(b"IHDR", header) + block(b"IDAT", data)
                     + block(b"IEND", b""))  # fmt: skip
    return file


@pytest.mark.parametrize("reader", [upright_size, exif_time])
def test_a_fifo_among_photographs_does_not_hang(reader, tmp_path):
    fifo = tmp_path / "a.jpg"
    os.mkfifo(fifo)
    said = within_two_seconds(lambda: reader(fifo) or "nothing")
    assert said == "nothing"


@pytest.mark.parametrize(("width", "height"), [(10_000, 10_900), (11_000, 10_800)])
def test_a_picture_that_would_take_a_gigabyte_is_refused_unread(width, height, tmp_path):
    file = png_of_claims(tmp_path / "a.png", width=width, height=height)
    with pytest.raises(PhotoError) as raised:
        read_pixels(file)
    assert "megapixels" in str(raised.value)


def test_a_picture_of_another_program_is_not_handed_to_it(tmp_path):
    file = tmp_path / "a.jpg"
    PIL.Image.new("RGB", (64, 64)).save(file, format="PPM")
    with pytest.raises(PhotoError, match="not a readable picture"):
        read_pixels(file)


def test_a_progressive_jpeg_of_thousands_of_scans_is_refused(tmp_path):
    out = io.BytesIO()
    PIL.Image.new("RGB", (64, 64)).save(out, "JPEG", progressive=True)
    data = out.getvalue()
    last = data.rindex(b"\xff\xda")
    file = tmp_path / "a.jpg"
    file.write_bytes(data[:last] + data[last:-2] * 5000 + b"\xff\xd9")
    with pytest.raises(PhotoError, match="scans"):
        read_pixels(file)
