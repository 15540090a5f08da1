# SPDX-License-Identifier: MIT
"""Dictionaries are named as people name them."""

import cv2
import numpy as np
import pytest

from tracking.errors import MarkerError
from tracking.markers import DICTIONARIES, dictionary_named, guess_dictionary


def test_the_family_of_markers_is_guessed_for_the_message():
    sheet = np.full((300, 500), 255, np.uint8)
    for index in range(3):
        family = dictionary_named("6x6_250")
        sheet[80:200, 20 + 160 * index : 140 + 160 * index] = cv2.aruco.generateImageMarker(
            family, index, 120
        )
    assert guess_dictionary(sheet) == "6x6_250"
    assert guess_dictionary(np.full((300, 300), 255, np.uint8)) is None


def test_a_misspelt_dictionary_is_named_with_the_nearest():
    with pytest.raises(MarkerError, match="apriltag_36h11"):
        dictionary_named("apriltag36h11")


def test_names_of_dictionaries_are_opencvs_without_the_prefix():
    assert {"4x4_50", "6x6_250", "apriltag_36h11"} <= set(DICTIONARIES)
    assert dictionary_named("DICT_4X4_50").markerSize == 4
