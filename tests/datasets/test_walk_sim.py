# SPDX-License-Identifier: MIT
import importlib.util
import sys
import tomllib
from datetime import datetime, timedelta
from pathlib import Path

import cv2
import numpy as np
import pandas as pd
import pytest
from PIL import Image
from PIL.ExifTags import IFD, Base

from support.synthetic import (
    DrawnPose,
    DrawnRobotMarker,
    RobotState,
    SyntheticCamera,
    marker_corners,
)
from zebro_lab.robot.robot_file import read_robot_file
from zebro_lab.runs.legs import read_leg_log
from zebro_lab.track.camera_file import read_camera_file
from zebro_lab.track.floor_file import read_floor_file

FOLDER = Path(__file__).parents[2] / "datasets" / "walk-sim"
PHOTOS = sorted((FOLDER / "photos").iterdir())
POSE = ["x", "y", "z", "roll", "pitch", "yaw"]
WEIGHT = 2.17 * 9.81  # N
CYCLE = 180  # rows of truth.csv
FIRST_CYCLE, LAST_CYCLE = 100 + 2 * CYCLE, 100 + 15 * CYCLE


@pytest.fixture(scope="module")
def generator():
    spec = importlib.util.spec_from_file_location("walk_sim_generate", FOLDER / "generate.py")
    module = importlib.util.module_from_spec(spec)
    sys.modules[spec.name] = module  # dataclasses look their module up
    spec.loader.exec_module(module)
    yield module
    del sys.modules[spec.name]


@pytest.fixture(scope="module")
def walk():
    return pd.read_csv(FOLDER / "truth.csv")


@pytest.fixture(scope="module")
def truth():
    return tomllib.loads((FOLDER / "truth.toml").read_text(encoding="utf-8"))


@pytest.fixture(scope="module")
def shots():
    return pd.read_csv(FOLDER / "photos.csv").set_index("photo")


@pytest.fixture(scope="module")
def camera(truth):
    told = truth["camera"]
    return SyntheticCamera(
        *told["size"], tuple(told["focal"]), tuple(told["centre"]), tuple(told["distortion"]),
        np.array(told["rotation"]), np.array(told["translation"]),
    )  # fmt: skip


def state_of(row):
    return RobotState(DrawnPose(row.x, row.y, row.yaw, row.z, row.roll, row.pitch))


def strides(walk):
    """Chord [m] and turn [rad] of each whole cycle in the steady part."""
    rows = walk.iloc[FIRST_CYCLE : LAST_CYCLE + 1 : CYCLE]
    chord = np.linalg.norm(np.diff(rows[["x", "y"]], axis=0), axis=1)
    return chord, np.diff(rows["yaw"])


# the walk


def test_the_walk_turns_left_on_the_promised_circle(walk):
    chord, turn = strides(walk)
    radii = chord / (2 * np.sin(turn / 2))
    assert radii.mean() == pytest.approx(1.702, abs=0.002)
    assert np.ptp(radii) < 0.01


def test_the_ground_carries_the_weight(walk):
    forces = walk[[f"normal{leg}" for leg in range(1, 7)]].sum(axis=1)
    steady = forces.iloc[FIRST_CYCLE + 1 : LAST_CYCLE + 1]
    assert steady.mean() == pytest.approx(WEIGHT, rel=2e-3)
    assert (walk.filter(like="normal") >= 0).all(axis=None)


def test_a_quarter_cycle_into_stance_the_hip_is_where_its_leg_puts_it(walk):
    middle = walk.iloc[FIRST_CYCLE + CYCLE // 8]
    for leg, (x, y) in ((1, (0.097, 0.1156)), (4, (0.0, -0.1156)), (5, (-0.097, 0.1156))):
        theta = middle[f"theta{leg}"]
        assert np.sin(theta) > 0
        assert np.cos(theta) > 0  # it rolls on its arc
        hip = middle.z + y * np.sin(middle.roll) - x * np.sin(middle.pitch)
        assert hip == pytest.approx(0.035 * (1 + np.sin(theta)), abs=2e-4)


# the logs


def test_the_leg_log_reads_as_simulated_and_follows_the_truth(walk):
    log = read_leg_log(FOLDER / "legs.csv")
    assert log.source == "sim:mujoco-walk"
    rows = pd.read_csv(FOLDER / "legs.csv")
    for leg in range(1, 7):
        true = np.interp(rows["t"], walk["t"], walk[f"theta{leg}"])
        error = np.degrees(rows[f"theta{leg}"] - true)
        assert error.abs().max() < 1.8 + 1.5  # half a count, and what a leg turns in 5 ms
        assert abs(error.mean()) < 0.3


def test_leg_angles_are_whole_counts():
    rows = pd.read_csv(FOLDER / "legs.csv")
    for leg in range(1, 7):
        counts = rows[f"theta{leg}"] / np.radians(3.6)
        np.testing.assert_allclose(counts, counts.round(), atol=2e-4)
        np.testing.assert_array_equal(counts.round() % 100, rows[f"count{leg}"])


def test_the_imu_integrates_to_the_true_turn(walk):
    imu = pd.read_csv(FOLDER / "imu.csv")
    turned = np.trapezoid(imu["yaw_rate"], imu["t"])
    assert turned == pytest.approx(walk["yaw"].iloc[-1] + 30 * 0.001, abs=0.01)
    for name in ("roll", "pitch"):
        error = imu[name] - np.interp(imu["t"], walk["t"], walk[name])
        assert error.std() == pytest.approx(0.002, rel=0.15)


# the photographs


def test_exif_tells_the_true_time_and_a_simulated_camera(truth, shots):
    assert [path.name for path in PHOTOS] == list(shots.index)
    for path in PHOTOS:
        with Image.open(path) as picture:
            exif = picture.getexif()
        details = exif.get_ifd(IFD.Exif)
        assert exif[Base.Make] == "simulated"
        stamp = datetime.strptime(
            f"{details[Base.DateTimeOriginal]}.{details[Base.SubsecTimeOriginal]} +0000",
            "%Y:%m:%d %H:%M:%S.%f %z",
        )
        taken = truth["start"] + timedelta(seconds=shots.loc[path.name, "t"])
        assert abs((stamp - taken).total_seconds()) < 1.1e-3


def test_every_photograph_shows_each_marker_where_the_truth_projects_it(truth, shots, camera):
    parameters = cv2.aruco.DetectorParameters()
    parameters.cornerRefinementMethod = cv2.aruco.CORNER_REFINE_SUBPIX
    dictionary = cv2.aruco.getPredefinedDictionary(cv2.aruco.DICT_4X4_50)
    detector = cv2.aruco.ArucoDetector(dictionary, parameters)
    floor = {marker["id"]: np.array(marker["corners"]) for marker in truth["floor_markers"]}
    for path in PHOTOS:
        corners, ids, _ = detector.detectMarkers(cv2.imread(str(path), cv2.IMREAD_GRAYSCALE))
        found = {int(i): c[0] for i, c in zip(np.ravel(ids), corners, strict=True)}
        row = shots.loc[path.name]
        true = {0: marker_corners(state_of(row), told_marker(truth)), **floor}
        assert set(found) == set(true)
        for number, places in true.items():
            np.testing.assert_allclose(found[number], camera.project(places), atol=0.6)
            shift = (found[number] - camera.project(places)).mean(axis=0)
            assert np.abs(shift).max() < 0.1, (path.name, number)


def told_marker(truth):
    told = truth["robot_marker"]
    marker = DrawnRobotMarker(told["id"], told["side"])
    np.testing.assert_allclose(marker.corners_body, told["corners_body"])
    return marker


def test_poses_of_photographs_are_those_of_the_walk(walk, shots):
    for name in POSE:
        expected = np.interp(shots["t"], walk["t"], walk[name])
        np.testing.assert_allclose(shots[name], expected, atol=2e-6)


@pytest.mark.long
def test_drawing_a_photograph_again_gives_the_committed_one(generator, shots):
    truth = generator.read_truth(FOLDER)
    picture = generator.take_photo(
        generator.SCENE, truth.state(shots["t"].iloc[3]),
        look=generator.RobotLook(generator.MARKER), conditions=generator.CONDITIONS,
        rng=np.random.default_rng(0),
    ).pixels  # fmt: skip
    committed = cv2.imread(str(PHOTOS[3]))
    difference = np.mean(picture.astype(float) - committed, axis=-1)  # noise is drawn anew
    assert np.abs(cv2.blur(difference, (9, 9))).max() < 3
    assert difference.std() < 3


def test_the_lens_on_file_is_the_true_one_within_its_error(truth):
    told, file = truth["camera"], FOLDER / "camera.toml"
    camera = read_camera_file(file)
    sd = tomllib.loads(file.read_text(encoding="utf-8"))["calibration"]
    assert camera.size == tuple(told["size"])
    focal, centre = np.diag(camera.matrix)[:2], camera.matrix[:2, 2]
    assert (np.abs(focal - told["focal"]) < 3 * np.array(sd["focal_sd"])).all()
    assert (np.abs(centre - told["centre"]) < 3 * np.array(sd["centre_sd"])).all()


def test_the_floor_on_file_has_every_marker_where_it_lies(generator, truth):
    text = (FOLDER / "floor.toml").read_text(encoding="utf-8")
    assert text == generator.floor_toml()
    marks = read_floor_file(FOLDER / "floor.toml").marks
    for marker in truth["floor_markers"]:
        np.testing.assert_allclose(marks[marker["id"]].points, marker["corners"], atol=1e-9)


# the folder


def test_it_is_small_and_says_simulated_everywhere(truth):
    files = [path for path in FOLDER.rglob("*") if path.is_file()]
    assert sum(path.stat().st_size for path in files) < 15e6
    assert "SIMULATED" in (FOLDER / "README.md").read_text(encoding="utf-8").splitlines()[0]
    columns = tomllib.loads((FOLDER / "columns.toml").read_text(encoding="utf-8"))
    assert truth["source"] == columns["source"] == "sim:mujoco-walk"
    assert all("simulated" in path.name for path in files if path.suffix == ".jpg")


def test_the_generator_writes_the_committed_truth_and_manifest(generator):
    assert generator.truth_toml() == (FOLDER / "truth.toml").read_text(encoding="utf-8")
    assert generator.manifest(FOLDER) == (FOLDER / "manifest.toml").read_text(encoding="utf-8")


def test_the_logs_are_what_the_seed_gives(generator, tmp_path):
    rng = np.random.default_rng(generator.SEED)
    generator.write_logs(tmp_path, generator.read_truth(FOLDER), rng)
    for name in ("legs.csv", "imu.csv"):
        made, committed = (pd.read_csv(folder / name) for folder in (tmp_path, FOLDER))
        np.testing.assert_allclose(made, committed, atol=2e-5)


def test_robot_toml_reads_and_its_marker_height_is_the_standing_robots(walk):
    described = read_robot_file(FOLDER / "robot.toml")
    standing = walk.iloc[50].z + described.marker.position[2]
    assert described.marker.height == pytest.approx(standing, abs=1e-4)
