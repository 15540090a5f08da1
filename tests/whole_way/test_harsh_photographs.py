# SPDX-License-Identifier: MIT
"""Dark, blurred, compressed photographs go all the way: to a judged prediction and its pictures."""

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
    look_at,
    render_background,
    take_photo,
)
from zebro_lab.track.file import read_track

pytestmark = pytest.mark.long

SCENE = DrawnScene(
    look_at(
        (1.0, -1.6, 2.4), (0.85, 0.55, 0.0), width=1600, height=1200,
        field_of_view=np.radians(56.0), distortion=(-0.12, 0.03, 0.0005, -0.0004, 0.0),
    ),
    tuple(
        DrawnFloorMarker(number, centre, 0.15)
        for number, centre in ((10, (0.1, -0.6)), (11, (1.8, -0.6)), (12, (2.2, 1.6)),
                               (13, (-0.5, 1.5)))
    ),
)  # fmt: skip
TRUTH = pd.read_csv(WALK / "photos.csv")
MOVING = replace(HARSH, exposure_time=1 / 60)


def write_photographs(folder: Path) -> None:
    """Photograph the bundled walk again, under harsh conditions, at the same moments."""
    folder.mkdir()
    rng = np.random.default_rng(41)
    background = render_background(SCENE)
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
        photo = take_photo(SCENE, state, conditions=MOVING, rng=rng, background=background)
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
             "--source", "sim:harsh")  # fmt: skip
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
