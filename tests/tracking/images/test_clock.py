# SPDX-License-Identifier: MIT
"""The QR clock is read from its own picture."""

import cv2
import numpy as np
import pytest

from support.written_photos import write_photo
from tracking.errors import PhotoError
from tracking.images import clock_offset, clock_picture, clock_text, read_clock


def test_the_clock_is_read_from_its_own_picture_and_ties_exif(tmp_path):
    picture = cv2.resize(clock_picture(1_714_979_289.123), None, fx=0.8, fy=0.8)
    assert read_clock(picture) == pytest.approx(1_714_979_289.123)
    assert clock_text(2.0).endswith(":2.000")
    assert read_clock(np.full((300, 300), 200, np.uint8)) is None
    # 2024-05-06 07:08:09 is 1714979289: the phone is 1.5 s ahead of the code it photographs.
    rgb = np.repeat(clock_picture(1_714_979_287.75 - 0.05)[:, :, None], 3, axis=2)
    path = write_photo(tmp_path / "c.png", rgb, taken="2024:05:06 07:08:09", fraction="250")
    offset = clock_offset(path)
    assert offset.seconds == pytest.approx(1.5, abs=1e-3)
    with pytest.raises(PhotoError, match="QR clock"):
        clock_offset(write_photo(tmp_path / "d.jpg"))
