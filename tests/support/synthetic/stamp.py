# SPDX-License-Identifier: MIT
"""Time stamps in a synthetic photograph's file, as a camera writes them."""

from datetime import datetime

from PIL.ExifTags import IFD, Base
from PIL.Image import Exif

_START_OF_IMAGE = b"\xff\xd8"
_APPLICATION_1 = b"\xff\xe1"


def with_time_stamp(jpeg: bytes, taken: datetime, *, subseconds: bool = True) -> bytes:
    """Put an EXIF time stamp into a JPEG without touching its pixels.

    Whole seconds are cut off, not rounded, as cameras do.

    Args:
        jpeg: A JPEG file without EXIF.
        taken: When, in the camera's local time; its offset from UTC is written if it has one.
        subseconds: Whether the camera writes milliseconds too.

    Returns:
        The file with the stamp. It names a simulated camera.
    """
    exif = Exif()
    exif[Base.Make], exif[Base.Model] = "simulated", "support.synthetic"
    details = exif.get_ifd(IFD.Exif)
    details[Base.DateTimeOriginal] = taken.strftime("%Y:%m:%d %H:%M:%S")
    if subseconds:
        details[Base.SubsecTimeOriginal] = f"{taken.microsecond // 1000:03d}"
    if taken.tzinfo is not None:
        details[Base.OffsetTimeOriginal] = taken.isoformat()[-6:]
    body = exif.tobytes()
    segment = _APPLICATION_1 + (len(body) + 2).to_bytes(2, "big") + body
    return _START_OF_IMAGE + segment + jpeg[len(_START_OF_IMAGE) :]
