# SPDX-License-Identifier: MIT
"""Detect AprilTags with the optional package pupil-apriltags.

The package finds tags that OpenCV's ArUco detector misses. Whole-numbered coordinates are corners
of pixels in pupil-apriltags and centres of pixels in OpenCV: the difference of half a pixel is
2 mm on the floor. The package lists a tag's corners counter-clockwise from the lower left one as
its makers print it, which is the upper right one as OpenCV prints it, half a turn from that.
"""

from collections.abc import Sequence

import numpy as np
from numpy.typing import NDArray

from model.arrays import Array
from tracking.dictionaries import key_of
from tracking.tag_families import FAMILIES, MOST_WRONG_BITS, STANDARD, tag_family

_BY_OPENCV, _BY_MAKERS = [1, 0, 3, 2], [3, 2, 1, 0]


def apriltag_quads(
    grey: NDArray[np.uint8], dictionary: str, numbers: Sequence[int]
) -> list[tuple[Array, int]]:
    """Detect AprilTags with pupil-apriltags.

    Args:
        grey: The picture, shape (height, width).
        dictionary: Name of the dictionary, as for `marker_family`.
        numbers: Numbers of the tags that are wanted; others are ignored.

    Returns:
        Of each tag with at most one wrong bit its corners in OpenCV's order and pixel coordinates,
        shape (4, 2) [px], and its number; empty where the package is not installed or the
        dictionary is not in `FAMILIES`.
    """
    key = key_of(dictionary)
    family = tag_family(key) if key in FAMILIES else None
    if family is None:
        return []
    order = _BY_MAKERS if key in STANDARD else _BY_OPENCV
    return [
        (np.asarray(tag.corners, dtype=float)[order] - 0.5, int(tag.tag_id))
        for tag in family.detector.detect(np.ascontiguousarray(grey))
        if tag.tag_id in numbers and tag.hamming <= MOST_WRONG_BITS
    ]
