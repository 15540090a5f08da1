# SPDX-License-Identifier: MIT
"""Photographs of the bundled walk, found through a track folder and seen from above."""

import re
import shutil

import cv2
import numpy as np
import pandas as pd
import pytest

from support.photo_tracks import DATA, SHOWN, write_photo_track
from zebro_lab.files.errors import DataError, NotFound
from zebro_lab.track.photographs import photos_of_track

SCALE = 1000.0  # px/m


@pytest.fixture
def track(tmp_path):
    """Return the folder of a track of two photographs."""
    return write_photo_track(tmp_path)


@pytest.mark.parametrize("name", SHOWN)
def test_from_above_the_robot_s_marker_lies_where_the_robot_was(track, name):
    truth = pd.read_csv(DATA / "photos.csv").set_index("photo").loc[name]
    middle = truth[["x", "y"]].to_numpy(dtype=float)
    low, high = middle - 0.2, middle + 0.2
    view = photos_of_track(track).view(name)
    picture = view.from_above(low, high, pixels_per_metre=SCALE, height=truth["z"] + 0.0385)
    detector = cv2.aruco.ArucoDetector(
        cv2.aruco.getPredefinedDictionary(cv2.aruco.DICT_4X4_50), cv2.aruco.DetectorParameters()
    )
    corners, numbers, _ = detector.detectMarkers(picture)
    assert list(np.ravel(numbers)) == [0]
    seen = np.array(corners[0]).reshape(4, 2) / SCALE * [1, -1] + [low[0], high[1]]
    np.testing.assert_allclose(seen.mean(axis=0), middle, atol=0.004)
    ahead = seen[:2].mean(axis=0) - seen[2:].mean(axis=0)  # from the rear edge to the front one
    turned = np.arctan2(ahead[1], ahead[0]) - truth["yaw"]
    assert abs(np.angle(np.exp(1j * turned))) < np.radians(2)


def test_a_photograph_that_moved_away_is_missed_by_name(track):
    (track.parent / SHOWN[1]).unlink()
    with pytest.raises(NotFound, match=SHOWN[1]):
        photos_of_track(track)


def test_another_photograph_of_that_name_is_refused(track):
    shutil.copy(track.parent / SHOWN[0], track.parent / SHOWN[1])
    with pytest.raises(DataError, match="another photograph"):
        photos_of_track(track)


def test_another_lens_in_the_camera_file_is_refused(track):
    camera = track.parent / "camera.toml"
    camera.write_text(re.sub(r"focal = \[\d", "focal = [9", camera.read_text()))
    with pytest.raises(DataError, match=r"camera\.toml.*not the camera file of this track"):
        photos_of_track(track)


def test_a_table_alone_is_no_track_folder(track):
    (track / "manifest.json").unlink()
    with pytest.raises(NotFound, match=r"not a track folder: manifest\.json is missing"):
        photos_of_track(track)


def test_a_track_that_names_no_photographs_is_said_to_be_so(track):
    table = pd.read_csv(track / "track.csv", comment="#").drop(columns="photo")
    table.to_csv(track / "track.csv", index=False)
    with pytest.raises(DataError, match=r"track\.csv: has no column photo"):
        photos_of_track(track)
