# SPDX-License-Identifier: MIT
"""Whatever lies in a folder of photographs, reading it ends with one line, and soon."""

import io
import os
import struct
import threading
import zlib
from pathlib import Path

import cv2
import numpy as np
import PIL.Image
import pytest

from tracking.errors import PhotoError, TimesError, TrackingError
from tracking.images import exif_time, read_pixels, times_from_table, video_frames
from zebro_lab.track.photo_sequence import TimeRequest, open_photos, upright_size


def within_two_seconds(work):
    """Do something in a thread, and return what it raised or returned."""
    said = []

    def run():
        try:
            said.append(work())
        except TrackingError as error:
            said.append(error)

    thread = threading.Thread(target=run, daemon=True)
    thread.start()
    thread.join(2.0)
    return said[0] if said else None


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


def test_a_folder_of_photographs_with_a_fifo_is_read_without_it(tmp_path):
    picture = PIL.Image.new("RGB", (32, 32))
    exif = PIL.Image.Exif()
    for k in range(3):
        exif[0x0132] = f"2026:01:01 12:00:0{k}"
        picture.save(tmp_path / f"p{k}.jpg", exif=exif)
    os.mkfifo(tmp_path / "p9.jpg")

    def names():
        with open_photos(tmp_path, TimeRequest()) as sequence:
            return sequence.names

    said = within_two_seconds(names)
    assert said is not None


@pytest.mark.parametrize(("width", "height"), [(10_000, 10_900), (11_000, 10_800)])
def test_a_picture_that_would_take_a_gigabyte_is_refused_unread(width, height, tmp_path):
    file = png_of_claims(tmp_path / "a.png", width=width, height=height)
    with pytest.raises(PhotoError) as raised:
        read_pixels(file)
    assert "megapixels" in str(raised.value)


def test_a_picture_of_another_program_is_not_handed_to_it(tmp_path):
    file = tmp_path / "a.jpg"
    PIL.Image.new("RGB", (64, 64)).save(file, format="PPM")
    with pytest.raises(PhotoError, match="not a picture"):
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


def test_a_playlist_is_no_video(tmp_path):
    writer = cv2.VideoWriter(
        str(tmp_path / "secret.avi"), cv2.VideoWriter.fourcc(*"MJPG"), 10.0, (64, 64)
    )
    for _ in range(3):
        writer.write(np.zeros((64, 64, 3), np.uint8))
    writer.release()
    playlist = tmp_path / "x.mp4"
    playlist.write_text("ffconcat version 1.0\nfile secret.avi\n")
    with pytest.raises(PhotoError):
        list(video_frames(playlist))


@pytest.mark.parametrize(
    "content",
    [
        b"photo,t_s\n\xff,1\n",
        b"photo,t_s\n" + b"a" * 200_000 + b",1\n",
        b"photo,t_s\na.jpg,1,2,3\n",
    ],
    ids=["not UTF-8", "long", "surplus"],
)
def test_a_table_of_times_that_is_none_is_refused_in_one_line(content, tmp_path):
    table = tmp_path / "times.csv"
    table.write_bytes(content)
    with pytest.raises(TimesError) as raised:
        times_from_table(table, [Path("b.jpg")])
    assert "\n" not in str(raised.value)
    assert "row for" not in str(raised.value)


def test_a_fifo_named_as_a_table_of_times_does_not_hang(tmp_path):
    fifo = tmp_path / "times.csv"
    os.mkfifo(fifo)
    said = within_two_seconds(lambda: times_from_table(fifo, [Path("a.jpg")]))
    assert isinstance(said, TimesError)
