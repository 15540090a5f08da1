# SPDX-License-Identifier: MIT
"""Frames of a video at their own times."""

import os
from collections.abc import Iterator
from pathlib import Path

import cv2
import numpy as np

from tracking.errors import PhotoError
from tracking.images.read import Image

FRAME_TIME_SD = 2e-3
"""Standard deviation of a frame's time stamp: phones store milliseconds [s]."""


def video_frames(path: Path, *, every: float = 0.0) -> Iterator[Image]:
    """Yield frames of a video, turned upright.

    Times are the frames' own stamps, never their number divided by a rate: phones vary the rate.

    Args:
        path: The video.
        every: Least time between two frames; 0 gives all [s].

    Yields:
        Frames, named by the file and their number.

    Raises:
        PhotoError: When the file is no video, is empty or has no frame.
    """
    if not path.is_file() or path.stat().st_size == 0:
        raise PhotoError(path.name, "no such file, or an empty one; expected a video")
    # What is wrong is said below; FFmpeg would write to the terminal by itself.
    os.environ.setdefault("OPENCV_FFMPEG_LOGLEVEL", "-8")
    capture = cv2.VideoCapture(str(path))
    try:
        if not capture.isOpened():
            raise PhotoError(
                path.name, "not a video that can be read; expected a whole MP4, MOV or AVI"
            )
        capture.set(cv2.CAP_PROP_ORIENTATION_AUTO, 1)
        yield from _frames(capture, path.name, every)
    finally:
        capture.release()


def _frames(capture: cv2.VideoCapture, name: str, every: float) -> Iterator[Image]:
    last, number = -np.inf, -1
    while capture.grab():
        number += 1
        t = 1e-3 * float(capture.get(cv2.CAP_PROP_POS_MSEC))
        if t - last < every - FRAME_TIME_SD:
            continue
        decoded, pixels = capture.retrieve()
        if not decoded:
            continue
        last = t
        yield Image(f"{name}#{number}", np.asarray(pixels, dtype=np.uint8), t, FRAME_TIME_SD)
    if number < 0:
        raise PhotoError(name, "the video has no frames; copy it again or record another")
