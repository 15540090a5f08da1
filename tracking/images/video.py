# SPDX-License-Identifier: MIT
"""Read frames of a video with their own time stamps."""

import os
from collections.abc import Iterator
from pathlib import Path

import cv2
import numpy as np

from tracking.errors import PhotoError
from tracking.images.read import MOST_PIXELS, Image

FRAME_TIME_SD = 2e-3
"""Standard deviation given to a frame's time stamp: phones store milliseconds [s]."""


_EXPECTED = (
    "expected a whole MP4, MOV, AVI, MKV or WebM; an MP4 or MOV that is cut short cannot be read: "
    "copy it again"
)
_ATOMS = (b"ftyp", b"moov", b"mdat", b"free", b"skip", b"wide", b"pnot")  # MP4 and QuickTime
_MARKS = (b"RIFF", b"\x1a\x45\xdf\xa3")  # AVI; Matroska and WebM


def video_frames(path: Path, *, every: float = 0.0) -> Iterator[Image]:
    """Yield frames of a video, rotated upright, with their time stamps.

    Times are the frames' own stamps, not their number divided by a rate: phones vary the rate.

    Args:
        path: The video.
        every: Least time between two frames that are yielded, to 2 ms; 0 for all frames [s].

    Yields:
        Frames named `FILE#NUMBER`, numbers from 0, with seconds since the start of the video.
        Frames that cannot be decoded are skipped, but counted.

    Raises:
        PhotoError: With the first frame: when the file is missing, empty, not a video, has no frame
            or frames of more than `MOST_PIXELS`.
        OSError: When the file may not be opened.
    """
    if not path.is_file() or path.stat().st_size == 0:
        raise PhotoError(path.name, "the file does not exist or is empty; expected a video")
    _refuse_playlist(path)
    # Errors are raised below; FFmpeg would write them to the terminal.
    os.environ.setdefault("OPENCV_FFMPEG_LOGLEVEL", "-8")
    capture = cv2.VideoCapture(str(path))
    try:
        if not capture.isOpened():
            raise PhotoError(path.name, f"not a video that can be read; {_EXPECTED}")
        _refuse_large(capture, path.name)
        capture.set(cv2.CAP_PROP_ORIENTATION_AUTO, 1)
        yield from _frames(capture, path.name, every)
    finally:
        capture.release()


def _refuse_playlist(path: Path) -> None:
    """Raise PhotoError unless the first bytes are those of a video container.

    FFmpeg would also open playlists, which name other files and servers.
    """
    with path.open("rb") as file:
        head = file.read(12)
    if not (head[4:8] in _ATOMS or head.startswith(_MARKS)):
        raise PhotoError(path.name, f"not a video that can be read; {_EXPECTED}")


def _refuse_large(capture: cv2.VideoCapture, name: str) -> None:
    """Raise `PhotoError` for frames of more than `MOST_PIXELS`."""
    width, height = (
        capture.get(key) for key in (cv2.CAP_PROP_FRAME_WIDTH, cv2.CAP_PROP_FRAME_HEIGHT)
    )
    if width * height > MOST_PIXELS:
        raise PhotoError(
            name,
            f"frames have {width:.0f}x{height:.0f} px; at most {MOST_PIXELS / 1e6:.0f} megapixels "
            "are read: scale the video down",
        )


def _frames(capture: cv2.VideoCapture, name: str, every: float) -> Iterator[Image]:
    """Yield frames that are `every` apart, less `FRAME_TIME_SD`, or more [s].

    Raises PhotoError if no frame can be decoded.
    """
    last, number = -np.inf, -1
    while capture.grab():
        number += 1
        t = 1e-3 * float(capture.get(cv2.CAP_PROP_POS_MSEC))
        if t - last < every - FRAME_TIME_SD:
            continue
        decoded, pixels = capture.retrieve()
        # OpenCV may report a damaged frame as decoded and return none.
        if not decoded or pixels is None:
            continue
        last = t
        yield Image(f"{name}#{number}", np.asarray(pixels, dtype=np.uint8), t, FRAME_TIME_SD)
    if np.isinf(last):
        raise PhotoError(
            name, "no frame of the video can be decoded; copy it again or record another"
        )
