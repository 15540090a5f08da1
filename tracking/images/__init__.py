# SPDX-License-Identifier: MIT
"""Read photographs, video frames and their times."""

from tracking.images.clock import (
    CameraClockOffset,
    clock_offset,
    clock_picture,
    clock_text,
    read_clock,
)
from tracking.images.read import Image, find_photos, open_picture, read_pixels
from tracking.images.stamps import IntervalFit, fit_interval
from tracking.images.times import (
    PhotoTimes,
    exif_time,
    times_from_exif,
    times_from_interval,
    times_from_table,
)
from tracking.images.video import video_frames

__all__ = [
    "CameraClockOffset",
    "Image",
    "IntervalFit",
    "PhotoTimes",
    "clock_offset",
    "clock_picture",
    "clock_text",
    "exif_time",
    "find_photos",
    "fit_interval",
    "open_picture",
    "read_clock",
    "read_pixels",
    "times_from_exif",
    "times_from_interval",
    "times_from_table",
    "video_frames",
]
