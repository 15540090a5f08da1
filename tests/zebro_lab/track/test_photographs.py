# SPDX-License-Identifier: MIT
"""Photographs of the bundled walk, found through a track folder and seen from above."""

import json
import shutil
from dataclasses import replace
from pathlib import Path

import cv2
import numpy as np
import pandas as pd
import pytest

from model.judgement import Prediction, judge_tilt
from model.poses import Poses
from model.robot import Robot
from zebro_lab.files.errors import DataError, NotFound
from zebro_lab.files.provenance import file_hash
from zebro_lab.runs.recorded_tilt import Tilt
from zebro_lab.track.file import TrackFile
from zebro_lab.track.photographs import photos_of_track
from zebro_lab.validation.judged_run import judge_run
from zebro_lab.validation.pictures import ShownRun, draw_validation
from zebro_lab.walk.prediction_file import PredictionFile, WalkedPath

DATA = Path(__file__).parents[3] / "datasets/walk-sim"
SHOWN = ("simulated_03.jpg", "simulated_12.jpg")
SCALE = 1000.0  # px/m


@pytest.fixture
def track(tmp_path):
    """Return the folder of a track of two photographs, made of their true poses."""
    truth = pd.read_csv(DATA / "photos.csv").set_index("photo").loc[list(SHOWN)].reset_index()
    folder = tmp_path / "track"
    folder.mkdir()
    table = truth.rename(columns={"t": "t_s", "x": "x_m", "y": "y_m", "yaw": "yaw_rad"})
    table[["t_s", "x_m", "y_m", "yaw_rad", "photo"]].to_csv(folder / "track.csv", index=False)
    shutil.copy(DATA / "floor.toml", folder / "floor.toml")
    for name in SHOWN:
        shutil.copy(DATA / "photos" / name, tmp_path / name)
    read = [DATA / "floor.toml", DATA / "camera.toml", *(tmp_path / name for name in SHOWN)]
    manifest = {
        "schema": 1, "kind": "track", "source": "sim:photographs",
        "inputs": {str(file): file_hash(file) for file in read},
    }  # fmt: skip
    (folder / "manifest.json").write_text(json.dumps(manifest))
    return folder


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


def judged(track, walked, *, measured=None):
    """Judge the made-up walk against a track that is a centimetre to its left."""
    photos = photos_of_track(track)
    path = walked.poses
    seen = path.at(photos.t)
    seen = Poses(seen.t, seen.position + np.array([0.0, 0.01]), seen.yaw)
    walk = WalkedPath(walked, Robot())
    prediction = PredictionFile(Prediction(path), "sim:dynamics", (), walk=walk)
    run = judge_run(
        "walk", prediction, TrackFile(seen, "sim:photographs", track),
        anchor=False, rng=np.random.default_rng(1),
    )  # fmt: skip
    if measured is not None:
        run = replace(run, tilt=judge_tilt(walked, measured.t, measured.angles))
    return ShownRun(run, prediction, photos)


def retimed(track, times):
    table = pd.read_csv(track / "track.csv").assign(t_s=times)
    table.to_csv(track / "track.csv", index=False)


def test_a_validation_shows_photographs_beside_poses_and_the_band_over_the_floor(
    track, walked, tmp_path
):
    retimed(track, [1.0, 3.0])
    measured = Tilt(walked.t, walked.orientation[:, :2] + 0.01, ())
    undrawn = draw_validation(tmp_path, judged(track, walked, measured=measured), simulated=True)
    assert undrawn == ()
    drawn = {file.name for file in tmp_path.glob("*.png")}
    assert drawn == {"walk.png", "walk.photos.png", "walk.floor.png", "walk.imu.png"}


def test_a_photograph_without_the_floor_s_marks_is_said_and_the_rest_drawn(track, walked, tmp_path):
    retimed(track, [1.0, 3.0])
    floor = (track / "floor.toml").read_text()
    for here, there in (("10", "40"), ("11", "41"), ("12", "42"), ("13", "43")):
        floor = floor.replace(f"\n{here} = ", f"\n{there} = ")
    (track / "floor.toml").write_text(floor)
    (why,) = draw_validation(tmp_path, judged(track, walked), simulated=True)
    assert "photographs are not shown" in why
    assert {file.name for file in tmp_path.glob("*.png")} == {"walk.png"}


def test_simulated_photographs_are_called_so(track):
    assert photos_of_track(track).simulated


def test_a_photograph_that_moved_away_is_missed_by_name(track):
    (track.parent / SHOWN[1]).unlink()
    with pytest.raises(NotFound, match=SHOWN[1]):
        photos_of_track(track)


def test_another_photograph_of_that_name_is_refused(track):
    shutil.copy(track.parent / SHOWN[0], track.parent / SHOWN[1])
    with pytest.raises(DataError, match="another photograph"):
        photos_of_track(track)


def test_a_table_alone_is_no_track_folder(track):
    (track / "manifest.json").unlink()
    with pytest.raises(NotFound, match="no track folder"):
        photos_of_track(track)
