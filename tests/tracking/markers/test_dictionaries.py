# SPDX-License-Identifier: MIT
"""Dictionaries are named as people name them."""

import cv2
import numpy as np
import pytest

from tracking.errors import MarkerError
from tracking.markers import DICTIONARIES, dictionary_named, guess_dictionary, marker_family


def test_the_family_of_markers_is_guessed_for_the_message():
    sheet = np.full((300, 500), 255, np.uint8)
    for index in range(3):
        family = dictionary_named("6x6_250")
        sheet[80:200, 20 + 160 * index : 140 + 160 * index] = cv2.aruco.generateImageMarker(
            family, index, 120
        )
    assert guess_dictionary(sheet) == "6x6_250"
    assert guess_dictionary(np.full((300, 300), 255, np.uint8)) is None


@pytest.mark.parametrize(
    ("name", "meant"),
    [
        ("apriltag36h11", "apriltag_36h11"),
        ("tag36h11", "apriltag_36h11"),
        ("36h11", "apriltag_36h11"),
        ("tagStandard41h12", "apriltag_41h12"),
        ("AprilTag_52h13x", "apriltag_52h13"),
        ("tag16h5", "apriltag_16h5"),
        ("4x4-50", "4x4_50"),
        ("aruco_orignal", "aruco_original"),
    ],
)
def test_a_misspelt_dictionary_is_named_with_the_one_that_is_meant(name, meant):
    with pytest.raises(MarkerError, match=f"did you mean '{meant}'"):
        marker_family(name)


def test_names_of_dictionaries_are_opencvs_without_the_prefix():
    assert {"4x4_50", "6x6_250", "apriltag_36h11"} <= set(DICTIONARIES)
    assert dictionary_named("DICT_4X4_50").markerSize == 4


def test_a_dictionary_of_ones_own_is_read_from_the_file_that_opencv_writes(tmp_path):
    own = cv2.aruco.extendDictionary(3, 4, randomSeed=1)
    path = str(tmp_path / "own.yml")
    storage = cv2.FileStorage(path, cv2.FILE_STORAGE_WRITE)
    own.writeDictionary(storage)
    storage.release()
    read = dictionary_named(path)
    assert read.markerSize == 4
    np.testing.assert_array_equal(read.bytesList, own.bytesList)


def test_a_file_without_a_dictionary_says_what_one_holds(tmp_path):
    (tmp_path / "empty.yml").write_text("%YAML:1.0\n---\nnothing: 1\n")
    (tmp_path / "broken.yml").write_text("%YAML:1.0\n---\na: [1, 2\nb: {")
    for name in ("empty.yml", "missing.yml", "broken.yml"):
        with pytest.raises(MarkerError, match=rf"{name} .* is not a dictionary .*nmarkers"):
            dictionary_named(str(tmp_path / name))
