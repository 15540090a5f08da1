# SPDX-License-Identifier: MIT
"""Write photographs with EXIF."""

import numpy as np
import PIL.Image


def write_photo(path, pixels=None, *, taken=None, fraction=None, orientation=None):
    picture = PIL.Image.fromarray(np.full((48, 64, 3), 90, np.uint8) if pixels is None else pixels)
    exif = PIL.Image.Exif()
    if taken is not None:
        details = {0x9003: taken}
        if fraction is not None:
            details[0x9291] = fraction
        exif[0x8769] = details
    if orientation is not None:
        exif[0x0112] = orientation
    picture.save(path, exif=exif, quality=95)
    return path
