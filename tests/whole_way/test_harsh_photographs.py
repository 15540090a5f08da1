# SPDX-License-Identifier: MIT
"""Dark, blurred, compressed photographs go all the way: to a judged prediction and its pictures."""

import tomllib
from dataclasses import replace
from pathlib import Path

import cv2
import numpy as np
import pandas as pd
import pytest

from support.bundled_walk import WALK
from support.synthetic import (
    HARSH,
    DrawnFloorMarker,
    DrawnPose,
    DrawnScene,
    RobotState,
    SyntheticCamera,
    render_background,
    take_photo,
)
from zebro_lab.track.file import read_track

pytestmark = pytest.mark.long

TRUTH = pd.read_csv(WALK / "photos.csv")
MOVING = replace(HARSH, exposure_time=1 / 60)


def bundled_scene() -> DrawnScene:
    """Return the camera and the floor that the bundled walk was photographed with."""
    told = tomllib.loads((WALK / "truth.toml").read_text())
    camera = told["camera"]
    width, height = camera["size"]
    return DrawnScene(
        SyntheticCamera(
            width, height, tuple(camera["focal"]), tuple(camera["centre"]),
            tuple(camera["distortion"]), np.array(camera["rotation"]),
            np.array(camera["translation"]),
        ),
        tuple(
            DrawnFloorMarker(each["id"], tuple(np.mean(each["corners"], axis=0)[:2]), each["side"])
            for each in told["floor_markers"]
        ),
    )  # fmt: skip


def write_photographs(folder: Path) -> None:
    """Photograph the bundled walk again, under harsh conditions, at the same moments."""
    folder.mkdir()
    rng = np.random.default_rng(41)
    scene = bundled_scene()
    background = render_background(scene)
    walk = pd.read_csv(WALK / "truth.csv")
    for name, t, x, y, z, roll, pitch, yaw in TRUTH.itertuples(index=False):
        before, after = (
            [np.interp(t + step, walk["t"], walk[column]) for column in ("x", "y", "yaw")]
            for step in (-0.01, 0.01)
        )
        vx, vy, turn = np.subtract(after, before) / 0.02
        state = RobotState(
            DrawnPose(x, y, yaw, z, roll, pitch), velocity_xy=(vx, vy), yaw_rate=turn
        )
        photo = take_photo(scene, state, conditions=MOVING, rng=rng, background=background)
        assert photo.jpeg is not None
        (folder / name).write_bytes(photo.jpeg)
    times = pd.DataFrame({"photo": TRUTH["photo"], "t_s": TRUTH["t"]})
    times.to_csv(folder.parent / "times.csv", index=False)


def pixels(picture: Path) -> np.ndarray:
    """Read a picture, which must be one."""
    read = cv2.imread(str(picture))
    assert read is not None, picture
    return read


def test_harsh_photographs_end_in_a_judged_prediction(command, tmp_path, monkeypatch):
    monkeypatch.chdir(tmp_path)
    write_photographs(tmp_path / "photos")
    command("import", "--legs", WALK / "legs.csv", "--imu", WALK / "imu.csv",
            "--columns", WALK / "columns.toml", "--label", "harsh", "--data", "data")  # fmt: skip
    (run,) = Path("data").iterdir()
    asked = ("photos", "--camera", WALK / "camera.toml", "--floor", WALK / "floor.toml",
             "--robot", WALK / "robot.toml", "--times", "times.csv", "--run", run,
             "--mean-height-sd", "4 mm", "--source", "sim:harsh")  # fmt: skip
    assert "every mark of the floor is seen" in command("track", *asked, "--preview", "preview.png")
    command("track", *asked)

    table, track = pd.read_csv(run / "track/track.csv"), read_track(run / "track")
    assert len(table) >= 0.9 * len(TRUTH)
    error = table[["x_m", "y_m", "yaw_rad"]].to_numpy() - (
        TRUTH.set_index("photo").loc[table["photo"], ["x", "y", "yaw"]].to_numpy()
    )
    assert error.ravel() @ np.linalg.solve(track.joint.dense, error.ravel()) / error.size < 1.5
    assert (np.hypot(*error[:, :2].T) < 8e-3).all()
    assert (np.abs(error[:, 2]) < np.radians(1.0)).all()

    command("predict", run, "--slip", "coulomb:0.38", "--robot", WALK / "robot.toml")
    command("validate", run)
    judged = pd.read_csv(run / "validation/metrics.csv").set_index("model")
    assert judged.loc["prediction", "ate_of_length"] < 0.036
    command("report", run, "--out", "page.html")
    pictures = [Path("preview.png"), *run.rglob("*.png")]
    assert len(pictures) >= 4
    assert all(np.ptp(pixels(picture)) > 100 for picture in pictures)
    assert "simulated" in Path("page.html").read_text()
