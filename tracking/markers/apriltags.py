# SPDX-License-Identifier: MIT
"""Families of AprilTags, from the optional package pupil-apriltags: their codes and their detector.

The third generation of AprilTags ("standard" families) is not in OpenCV: its border is white on
black, and cells of its code lie around the border as well as inside.

The package also finds tags of other families that OpenCV's ArUco detector misses. Whole-numbered
coordinates are corners of pixels in pupil-apriltags and centres of pixels in OpenCV: the difference
of half a pixel is 2 mm on the floor. The package lists a tag's corners counter-clockwise from the
lower left one as its makers print it, which is the upper right one as OpenCV prints it, half a turn
from that.
"""

import ctypes
from collections.abc import Sequence
from dataclasses import dataclass
from functools import cache
from typing import Any

import numpy as np
from numpy.typing import NDArray

from model.arrays import Array

FAMILIES = {
    "apriltag_16h5": "tag16h5",
    "apriltag_25h9": "tag25h9",
    "apriltag_36h11": "tag36h11",
    "apriltag_41h12": "tagStandard41h12",
    "apriltag_52h13": "tagStandard52h13",
}
"""Name of each tag family in pupil-apriltags, by the name of the dictionary here."""

STANDARD = ("apriltag_41h12", "apriltag_52h13")
"""Names of the dictionaries that are not in OpenCV."""

MOST_WRONG_BITS = 1
"""Wrong bits up to which a tag is decoded; for two the tables of 52h13 take 6 GB of memory."""

# Places of pupil-apriltags' corners in OpenCV's order: of a tag as OpenCV prints it, and as its
# makers do
_BY_OPENCV, _BY_MAKERS = [1, 0, 3, 2], [3, 2, 1, 0]


class _Family(ctypes.Structure):
    """`apriltag_family_t` of apriltag.h, as far as it is read."""

    _fields_ = [
        ("ncodes", ctypes.c_uint32),
        ("codes", ctypes.POINTER(ctypes.c_uint64)),
        ("width_at_border", ctypes.c_int),
        ("total_width", ctypes.c_int),
        ("reversed_border", ctypes.c_bool),
        ("nbits", ctypes.c_uint32),
        ("bit_x", ctypes.POINTER(ctypes.c_int32)),
        ("bit_y", ctypes.POINTER(ctypes.c_int32)),
    ]


@dataclass(frozen=True)
class TagFamily:
    """A family of tags.

    Attributes:
        detector: Detector of pupil-apriltags for this family alone.
        codes: Code of each tag, shape (n,).
        cells: Cells along a side of the square whose corners are detected, that of the border.
        is_reversed: Whether the border is white on black.
        places: Row and column of each bit of a code, most significant first, from the border's
            first cell, shape (bits, 2).
    """

    detector: Any
    codes: NDArray[np.uint64]
    cells: int
    is_reversed: bool
    places: NDArray[np.int64]

    def cells_of(self, number: int) -> NDArray[np.float32]:
        """Draw a tag as its makers print it, with the cells next to its border on all sides.

        Args:
            number: Number of the tag.

        Returns:
            Brightness of its cells, 0 black and 1 white, shape (cells + 2, cells + 2).
        """
        drawn = np.zeros((self.cells + 4, self.cells + 4), dtype=np.float32)
        ring = 2 if self.is_reversed else 1
        white = np.zeros_like(drawn, dtype=bool)
        white[ring:-ring, ring:-ring] = True
        white[ring + 1 : -ring - 1, ring + 1 : -ring - 1] = False
        drawn[white] = 1.0
        for k, (row, column) in enumerate(self.places):
            bit = int(self.codes[number]) >> (len(self.places) - 1 - k) & 1
            drawn[row + 2, column + 2] = bit
        return drawn[1:-1, 1:-1]


@cache
def tag_family(dictionary: str) -> TagFamily | None:
    """Load a family of tags; None where the package is not installed.

    Args:
        dictionary: A key of `FAMILIES`.
    """
    try:
        from pupil_apriltags import Detector
    except ImportError:
        return None  # an optional dependency: OpenCV's own detector works without it
    # With a small family, replaced below: this constructor cannot limit the wrong bits.
    detector = Detector(families="tag16h5", nthreads=1, quad_decimate=1.0)
    # Its destructor frees families that the library still uses, which crashes the process.
    detector.tag_families = {}
    library: Any = detector.libc
    pointer = detector.tag_detector_ptr
    library.apriltag_detector_clear_families.restype = None
    library.apriltag_detector_clear_families(pointer)
    create = library[f"{FAMILIES[dictionary]}_create"]
    create.restype = ctypes.POINTER(_Family)
    family = create()
    library.apriltag_detector_add_family_bits(pointer, family, MOST_WRONG_BITS)
    of, bits = family.contents, range(family.contents.nbits)
    return TagFamily(
        detector,
        np.ctypeslib.as_array(of.codes, (of.ncodes,)).copy(),
        int(of.width_at_border),
        bool(of.reversed_border),
        np.array([(of.bit_y[k], of.bit_x[k]) for k in bits], dtype=np.int64),
    )


def key_of(name: str) -> str:
    """Return a dictionary's name without OpenCV's prefix, in lower case.

    >>> key_of("DICT_4X4_50")
    '4x4_50'
    """
    return name.lower().removeprefix("dict_")


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
