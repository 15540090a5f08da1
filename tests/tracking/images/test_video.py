# SPDX-License-Identifier: MIT
"""A phone's video: turned by its metadata, frames at irregular times, both in a real MP4.

OpenCV writes neither, so they are written into the file it made, as ISO/IEC 14496-12 has them:
the matrix of the track's header (`tkhd`), the durations of its frames (`stts`) and of the whole.
"""

import struct
from pathlib import Path

import cv2
import numpy as np
import pytest

from tracking.errors import PhotoError
from tracking.images import video_frames


def write_video(path, count, rate=10.0):
    writer = cv2.VideoWriter(str(path), cv2.VideoWriter.fourcc(*"MJPG"), rate, (64, 48))
    for index in range(count):
        writer.write(np.full((48, 64, 3), 10 * index, np.uint8))
    writer.release()
    return path


def test_frames_come_with_their_own_times(tmp_path):
    frames = list(video_frames(write_video(tmp_path / "a.avi", 12)))
    np.testing.assert_allclose([frame.t for frame in frames], 0.1 * np.arange(12), atol=1e-3)
    assert frames[3].name == "a.avi#3"
    thinned = list(video_frames(tmp_path / "a.avi", every=0.3))
    np.testing.assert_allclose([frame.t for frame in thinned], [0, 0.3, 0.6, 0.9], atol=1e-3)
    assert thinned[1].pixels.mean() == pytest.approx(30, abs=3)


@pytest.mark.parametrize("kind", ["empty", "text", "no frames"])
def test_a_video_without_frames_is_named(tmp_path, kind, capfd):
    path = tmp_path / "v.avi"
    if kind == "no frames":
        write_video(path, 0)
    else:
        path.write_text("" if kind == "empty" else "hello")
    with pytest.raises(PhotoError, match=r"v\.avi"):
        list(video_frames(path))


WIDTH, HEIGHT = 64, 48
CONTAINERS = {b"moov", b"trak", b"edts", b"mdia", b"minf", b"stbl"}
DURATIONS = {b"mvhd": 16, b"tkhd": 20, b"elst": 8, b"mdhd": 16}  # where the whole duration stands
TURNS = {0: (1, 0, 0, 1), 90: (0, 1, -1, 0), 180: (-1, 0, 0, -1), 270: (0, -1, 1, 0)}
STEPS = (1, 2, 1, 5, 3, 1, 1, 8, 1, 1)  # how long each frame is shown, in ticks of the file


def phone_video(path: Path, *, turn: int = 0, steps: tuple[int, ...] = ()) -> Path:
    """Write ten frames, each brighter and with a white upper left corner, as they lie."""
    writer = cv2.VideoWriter(str(path), cv2.VideoWriter.fourcc(*"mp4v"), 10.0, (WIDTH, HEIGHT))
    for number in range(len(STEPS)):
        frame = np.full((HEIGHT, WIDTH, 3), 20 + 15 * number, np.uint8)
        frame[:16, :16] = 255
        writer.write(frame)
    writer.release()
    path.write_bytes(edited(path.read_bytes(), turn, steps))
    return path


def edited(mp4: bytes, turn: int, steps: tuple[int, ...]) -> bytes:
    """Rewrite boxes, from the innermost out; `moov` lies behind the frames, which stay in place."""
    boxes, place = [], 0
    while place < len(mp4):
        (size,), kind = struct.unpack_from(">I", mp4, place), mp4[place + 4 : place + 8]
        body = mp4[place + 8 : place + size]
        if kind in CONTAINERS:
            body = edited(body, turn, steps)
        if kind in DURATIONS and steps:
            at = DURATIONS[kind]
            (duration,) = struct.unpack_from(">I", body, at)
            longer = struct.pack(">I", duration * sum(steps) // len(steps))
            body = body[:at] + longer + body[at + 4 :]
        if kind == b"tkhd" and turn:
            a, b, c, d = (unit * 65536 for unit in TURNS[turn])
            body = body[:40] + struct.pack(">9i", a, b, 0, c, d, 0, 0, 0, 1 << 30) + body[76:]
        if kind == b"stts" and steps:
            _, _, count, tick = struct.unpack(">4I", body)
            assert count == len(steps)
            entries = b"".join(struct.pack(">2I", 1, step * tick) for step in steps)
            body = struct.pack(">2I", 0, count) + entries
        boxes.append(struct.pack(">I", len(body) + 8) + kind + body)
        place += size
    return b"".join(boxes)


@pytest.mark.parametrize(
    ("turn", "corner"), [(0, "upper left"), (90, "upper right"), (180, "lower right"),
                         (270, "lower left")],
)  # fmt: skip
def test_a_video_is_turned_as_its_metadata_say(turn, corner, tmp_path):
    frame = next(video_frames(phone_video(tmp_path / "walk.mp4", turn=turn)))
    assert frame.pixels.shape[:2] == ((HEIGHT, WIDTH) if turn % 180 == 0 else (WIDTH, HEIGHT))
    low, right = "lower" in corner, "right" in corner
    patch = frame.pixels[-10:, :] if low else frame.pixels[:10, :]
    patch = patch[:, -10:] if right else patch[:, :10]
    assert patch.mean() > 230
    assert np.median(frame.pixels) < 60


def test_frames_of_a_variable_rate_have_the_times_of_the_file(tmp_path):
    frames = list(video_frames(phone_video(tmp_path / "walk.mp4", steps=STEPS)))
    shown = 0.1 * np.concatenate(([0], np.cumsum(STEPS)[:-1]))
    np.testing.assert_allclose([frame.t for frame in frames], shown, atol=2e-3)
    levels = [np.median(frame.pixels) for frame in frames]
    np.testing.assert_allclose(levels, 20 + 15 * np.arange(len(STEPS)), atol=4)


@pytest.mark.parametrize("damaged", [{3}, set(range(len(STEPS)))])
def test_a_frame_that_is_decoded_to_nothing_is_left_out(damaged, tmp_path, monkeypatch):
    file = phone_video(tmp_path / "a.mp4")
    usual, numbers = cv2.VideoCapture, iter(range(len(STEPS)))

    class Damaged:
        def __init__(self, *arguments):
            self._capture = usual(*arguments)

        def __getattr__(self, name):
            return getattr(self._capture, name)

        def retrieve(self):
            found = self._capture.retrieve()
            return (True, None) if next(numbers) in damaged else found

    monkeypatch.setattr(cv2, "VideoCapture", Damaged)
    if len(damaged) == len(STEPS):
        with pytest.raises(PhotoError, match="no frame"):
            list(video_frames(file))
        return
    names = [image.name for image in video_frames(file)]
    assert names == [f"a.mp4#{number}" for number in range(len(STEPS)) if number not in damaged]


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
