# SPDX-License-Identifier: MIT
"""Detect AprilTags with the optional package pupil-apriltags.

The package finds tags that OpenCV's ArUco detector misses. Whole-numbered coordinates are corners
of pixels in pupil-apriltags and centres of pixels in OpenCV: the difference of half a pixel is
2 mm on the floor. The package lists a tag's corners counter-clockwise from the upper right one,
for a tag as OpenCV prints it.
"""

from collections.abc import Sequence
from functools import cache
from typing import Any

import numpy as np
from numpy.typing import NDArray

from tracking.camera.lens import Array

FAMILIES = {"apriltag_16h5": "tag16h5", "apriltag_25h9": "tag25h9", "apriltag_36h11": "tag36h11"}
"""Name of each tag family in pupil-apriltags, by the name of the dictionary in OpenCV."""

MOST_WRONG_BITS = 1

_ORDER = [1, 0, 3, 2]


def apriltag_quads(
    grey: NDArray[np.uint8], dictionary: str, numbers: Sequence[int]
) -> list[tuple[Array, int]]:
    """Detect AprilTags with pupil-apriltags.

    Args:
        grey: The picture, shape (height, width).
        dictionary: Name of the dictionary, as for `dictionary_named`.
        numbers: Numbers of the tags that are wanted; others are ignored.

    Returns:
        Of each tag with at most one wrong bit its corners in OpenCV's order and pixel coordinates,
        shape (4, 2) [px], and its number; empty where the package is not installed or the
        dictionary is not in `FAMILIES`.
    """
    family = FAMILIES.get(dictionary.lower().removeprefix("dict_"))
    detector = None if family is None else _detector(family)
    if detector is None:
        return []
    return [
        (np.asarray(tag.corners, dtype=float)[_ORDER] - 0.5, int(tag.tag_id))
        for tag in detector.detect(np.ascontiguousarray(grey))
        if tag.tag_id in numbers and tag.hamming <= MOST_WRONG_BITS
    ]


@cache
def _detector(family: str) -> Any:
    try:
        from pupil_apriltags import Detector
    except ImportError:
        return None  # an optional dependency: OpenCV's own detector works without it
    detector = Detector(families=family, nthreads=1, quad_decimate=1.0)
    # Its destructor frees families that the library still uses, which crashes the process.
    detector.tag_families = {}
    return detector
