# SPDX-License-Identifier: MIT
"""Read frames of a video with their own time stamps."""

import os
from collections.abc import Callable, Generator, Iterator
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
_EBML = (b"\x1a\x45\xdf\xa3", b"\x18\x53\x80\x67")  # the header of Matroska, and its one segment


def video_frames(
    path: Path, *, every: float = 0.0, cut_short: Callable[[int], None] | None = None
) -> Iterator[Image]:
    """Yield frames of a video, rotated upright, with their time stamps.

    Times are the frames' own stamps, not their number divided by a rate: phones vary the rate.

    Args:
        path: The video.
        every: Least time between two frames that are yielded, to 2 ms; 0 for all frames [s].
        cut_short: Called after the last frame if the file is shorter than it states, with the
            number of frames read.

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
        read = yield from _frames(capture, path.name, every)
        if cut_short is not None and is_cut_short(path):
            cut_short(read)
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
    width, height = (
        capture.get(key) for key in (cv2.CAP_PROP_FRAME_WIDTH, cv2.CAP_PROP_FRAME_HEIGHT)
    )
    if width * height > MOST_PIXELS:
        raise PhotoError(
            name,
            f"frames have {width:.0f}x{height:.0f} px; at most {MOST_PIXELS / 1e6:.0f} megapixels "
            "are read: scale the video down",
        )


def _frames(capture: cv2.VideoCapture, name: str, every: float) -> Generator[Image, None, int]:
    """Yield frames; return how many the file has, those left out included."""
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
    return number + 1


def is_cut_short(path: Path) -> bool:
    """Return whether a video file is shorter than its outermost parts state.

    These are the boxes of MP4 and QuickTime (ISO/IEC 14496-12), the chunks of RIFF (AVI), and the
    elements of EBML (RFC 8794: Matroska, WebM). A part without a stated size goes to the end.

    Args:
        path: The video.
    """
    end, size = 0, path.stat().st_size
    with path.open("rb") as file:
        stated = _stated_by(file.read(4))
        while end < size:
            file.seek(end)
            length = stated(file.read(16))
            if length is None:
                return False
            end += length
    return end > size


def _stated_by(head: bytes) -> Callable[[bytes], int | None]:
    """Choose how lengths are stated in a file, by its first four bytes.

    The function takes the first 16 bytes of an outermost part and returns its length; None for a
    part that states none, or is of no known kind.
    """
    if head in _EBML:
        return _element_length
    return _chunk_length if head == b"RIFF" else _box_length


def _chunk_length(head: bytes) -> int | None:
    length = int.from_bytes(head[4:8], "little")
    return 8 + length + length % 2 if length and head.startswith(b"RIFF") else None


def _box_length(head: bytes) -> int | None:
    length = int.from_bytes(head[:4], "big")
    if length == 1:
        length = int.from_bytes(head[8:16], "big")
    return length if length >= 8 else None


def _element_length(head: bytes) -> int | None:
    """Return the length of an element of EBML with an identifier of four bytes."""
    width = 9 - head[4].bit_length() if len(head) > 4 else 9
    if not head.startswith(_EBML) or width > 8 or len(head) < 4 + width:
        return None
    stated = int.from_bytes(head[4 : 4 + width], "big") - (1 << 7 * width)
    return None if stated == (1 << 7 * width) - 1 else 4 + width + stated
