# SPDX-License-Identifier: MIT
"""Families of markers, by the names people use for them."""

import difflib

import cv2

from tracking.errors import MarkerError

DICTIONARIES = {
    name.removeprefix("DICT_").lower(): int(getattr(cv2.aruco, name))
    for name in dir(cv2.aruco)
    if name.startswith("DICT_")
}
"""OpenCV's dictionaries: "4x4_50", "apriltag_36h11" and so on, with OpenCV's number."""


def dictionary_named(name: str) -> cv2.aruco.Dictionary:
    """Return a dictionary of markers by its name.

    Args:
        name: A key of `DICTIONARIES`; case and a leading "DICT_" do not matter.

    Raises:
        MarkerError: When there is no such dictionary.
    """
    key = name.lower().removeprefix("dict_")
    if key not in DICTIONARIES:
        near = difflib.get_close_matches(key, DICTIONARIES, n=1) or ["4x4_50"]
        raise MarkerError(f"dictionary '{name}' is unknown; did you mean '{near[0]}'?")
    return cv2.aruco.getPredefinedDictionary(DICTIONARIES[key])
