# SPDX-License-Identifier: MIT
"""Dictionaries (families) of ArUco and AprilTag markers, by name."""

import re
from contextlib import suppress
from dataclasses import dataclass
from functools import cache
from pathlib import Path

import cv2
import numpy as np
from numpy.typing import NDArray

from model.similar_name import similar_name
from tracking.errors import MarkerError
from tracking.markers.apriltags import STANDARD, TagFamily, key_of, tag_family

DICTIONARIES = {
    name.removeprefix("DICT_").lower(): int(getattr(cv2.aruco, name))
    for name in dir(cv2.aruco)
    if name.startswith("DICT_")
}
"""OpenCV's dictionaries: number of OpenCV's constant `DICT_...` by name, such as "4x4_50"."""

_USUAL = ("4x4_50", "5x5_50", "6x6_250", "apriltag_36h11", "aruco_original", "7x7_50")
"""Dictionaries that `guess_dictionary` tries."""


@dataclass(frozen=True)
class MarkerFamily:
    """Markers of one dictionary.

    Attributes:
        source: OpenCV's dictionary, or a family of AprilTags that OpenCV does not have.
    """

    source: cv2.aruco.Dictionary | TagFamily

    @property
    def is_in_opencv(self) -> bool:
        """Whether OpenCV can detect the markers."""
        return not isinstance(self.source, TagFamily)

    @property
    def count(self) -> int:
        """Number of markers; they are numbered from 0."""
        if isinstance(self.source, TagFamily):
            return len(self.source.codes)
        return len(self.source.bytesList)

    @property
    def is_reversed(self) -> bool:
        """Whether the square of which the corners are detected is white on black."""
        return isinstance(self.source, TagFamily) and self.source.is_reversed

    def cells_of(self, number: int) -> NDArray[np.float32]:
        """Draw a marker with one cell around the square of which corners are detected.

        Args:
            number: Number of the marker, below `count`.

        Returns:
            Brightness of the cells, 0 black and 1 white, shape (n, n).
        """
        if isinstance(self.source, TagFamily):
            return self.source.cells_of(number)
        inner = cv2.aruco.generateImageMarker(self.source, number, self.source.markerSize + 2)
        return np.pad(inner / 255, 1, constant_values=1.0).astype(np.float32)


@cache
def marker_family(name: str) -> MarkerFamily:
    """Return the markers of a dictionary by its name.

    Args:
        name: A name as for `dictionary_named`, or one of `STANDARD`.

    Raises:
        MarkerError: When the name is unknown, the package that its tags need is not installed, or
            the file is missing or holds no dictionary.
    """
    key = key_of(name)
    if key not in STANDARD:
        return MarkerFamily(dictionary_named(name))
    tags = tag_family(key)
    if tags is None:
        raise MarkerError(
            f"dictionary '{name}' needs the package pupil-apriltags, which is not installed: "
            "install zebro-lab with its extra 'apriltag' (pip install '.[apriltag]')"
        )
    return MarkerFamily(tags)


def dictionary_named(name: str) -> cv2.aruco.Dictionary:
    """Return a dictionary of OpenCV by its name.

    Args:
        name: A key of `DICTIONARIES`, in upper or lower case, with or without a leading "DICT_"; or
            the path of a file (.yml, .yaml, .json, .xml) with a custom dictionary as OpenCV writes
            it.

    Raises:
        MarkerError: When the name is unknown, or the file is missing, malformed or holds no
            dictionary.
    """
    if Path(name).suffix in {".yml", ".yaml", ".json", ".xml"}:
        return _dictionary_of_file(name)
    key = key_of(name)
    if key not in DICTIONARIES:
        names = (*DICTIONARIES, *STANDARD)
        near = _tag_name(key) or similar_name(key, names)
        hint = f"did you mean '{near}'?" if near else f"known: {', '.join(names)}"
        raise MarkerError(f"dictionary '{name}' is unknown; {hint}")
    return cv2.aruco.getPredefinedDictionary(DICTIONARIES[key])


def _tag_name(key: str) -> str | None:
    """Return the dictionary of AprilTags that a name such as "tag36h11" means; None for others."""
    bits = re.search(r"(?:^|tag|standard|april|_)_?(\d+h\d+)$", key)
    known = (*DICTIONARIES, *STANDARD)
    name = f"apriltag_{bits[1]}" if bits else ""
    return name if name in known else None


def _dictionary_of_file(path: str) -> cv2.aruco.Dictionary:
    """Read a custom dictionary from a file as OpenCV writes it; else raise `MarkerError`."""
    dictionary = cv2.aruco.Dictionary()
    with suppress(cv2.error, SystemError):  # raised by OpenCV for a malformed file
        storage = cv2.FileStorage(path, cv2.FILE_STORAGE_READ)
        if storage.isOpened() and dictionary.readDictionary(storage.root()):
            return dictionary
    raise MarkerError(
        f"{path} does not exist or is not a dictionary of markers; expected nmarkers, "
        f"markersize and marker_0, marker_1, ... as cv2.aruco.Dictionary.writeDictionary writes"
    )


def guess_dictionary(pixels: NDArray[np.uint8]) -> str | None:
    """Guess the dictionary of a picture's markers by detecting with six common dictionaries.

    The guess serves the error message when no marker of the given dictionary is found: a wrong
    dictionary is the most frequent cause.

    Args:
        pixels: The picture, grey or BGR.

    Returns:
        Name of the dictionary of which most markers are detected; None if of each of the six fewer
        than two are.
    """
    counts = {}
    for name in _USUAL:
        _, ids, _ = cv2.aruco.ArucoDetector(dictionary_named(name)).detectMarkers(pixels)
        counts[name] = 0 if ids is None else len(ids)
    best = max(counts, key=lambda name: counts[name])
    return best if counts[best] >= 2 else None
