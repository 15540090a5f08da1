# SPDX-License-Identifier: MIT
"""Dictionaries (families) of ArUco and AprilTag markers, by name."""

from contextlib import suppress
from pathlib import Path

import cv2
import numpy as np
from numpy.typing import NDArray

from model.similar_name import similar_name
from tracking.errors import MarkerError

DICTIONARIES = {
    name.removeprefix("DICT_").lower(): int(getattr(cv2.aruco, name))
    for name in dir(cv2.aruco)
    if name.startswith("DICT_")
}
"""OpenCV's dictionaries: number of OpenCV's constant `DICT_...` by name, such as "4x4_50"."""

_USUAL = ("4x4_50", "5x5_50", "6x6_250", "apriltag_36h11", "aruco_original", "7x7_50")


def dictionary_named(name: str) -> cv2.aruco.Dictionary:
    """Return a dictionary of markers by its name.

    Args:
        name: A key of `DICTIONARIES`, where case and a leading "DICT_" do not matter, or the path
            of a file (.yml, .yaml, .json, .xml) with a custom dictionary as OpenCV writes it.

    Raises:
        MarkerError: When the name is unknown, or the file is missing or holds no dictionary.
        SystemError: When OpenCV cannot parse the file as YAML, JSON or XML.
    """
    if Path(name).suffix in {".yml", ".yaml", ".json", ".xml"}:
        return _dictionary_of_file(name)
    key = name.lower().removeprefix("dict_")
    if key not in DICTIONARIES:
        near = similar_name(key, DICTIONARIES)
        hint = f"did you mean '{near}'?" if near else f"known: {', '.join(DICTIONARIES)}"
        raise MarkerError(f"dictionary '{name}' is unknown; {hint}")
    return cv2.aruco.getPredefinedDictionary(DICTIONARIES[key])


def _dictionary_of_file(path: str) -> cv2.aruco.Dictionary:
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
