# SPDX-License-Identifier: MIT
"""A validation shows the walk beside its track, its IMU and its photographs."""

from dataclasses import replace

import numpy as np
import pandas as pd
import pytest

from model.judgement import Prediction, judge_tilt
from model.poses import Poses
from model.robot import Robot
from support.drawn_figures import figures_saved
from support.photo_tracks import write_photo_track
from zebro_lab.runs.recorded_walk import Tilt
from zebro_lab.track.file import TrackFile
from zebro_lab.track.photographs import photos_of_track
from zebro_lab.validation.judged_run import judge_run
from zebro_lab.validation.pictures import draw_validation
from zebro_lab.validation.predicted_walks import ShownRun
from zebro_lab.walk.prediction_file import PredictionFile, WalkedPath

pytestmark = pytest.mark.usefixtures("coarse_pictures")


@pytest.fixture
def track(tmp_path):
    """Return the folder of a track of two photographs."""
    return write_photo_track(tmp_path)


def judged(track, walked, *, measured=None):
    """Judge the made-up walk against a track that is a centimetre to its left."""
    photos = photos_of_track(track)
    path = walked.poses
    seen = path.at(photos.t)
    seen = Poses(seen.t, seen.position + np.array([0.0, 0.01]), seen.yaw)
    walk = WalkedPath(walked, Robot())
    prediction = PredictionFile(Prediction(path), ("sim:dynamics",), (), walk=walk)
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
    track, walked, tmp_path, monkeypatch
):
    drawn = figures_saved(monkeypatch)
    retimed(track, [1.0, 3.0])
    measured = Tilt(walked.t, walked.orientation[:, :2] + 0.01, (), "real")
    shown = judged(track, walked, measured=measured)
    assert draw_validation(tmp_path, shown, simulated=True) == ()
    assert set(drawn) == {"walk.png", "walk.photos.png", "walk.floor.png", "walk.imu.png"}
    floor = drawn["walk.floor.png"]
    assert "simulated" in floor.get_suptitle()
    (axes,) = floor.axes
    assert axes.get_aspect() == 1.0
    predicted, seen = axes.lines
    np.testing.assert_array_equal(predicted.get_xydata(), walked.poses.position)
    np.testing.assert_array_equal(seen.get_xydata(), shown.run.track.position)


def test_a_photograph_without_the_floor_s_marks_is_said_and_the_rest_drawn(track, walked, tmp_path):
    retimed(track, [1.0, 3.0])
    floor = (track / "floor.toml").read_text()
    for here, there in (("10", "40"), ("11", "41"), ("12", "42"), ("13", "43")):
        floor = floor.replace(f"\n{here} = ", f"\n{there} = ")
    (track / "floor.toml").write_text(floor)
    (why,) = draw_validation(tmp_path, judged(track, walked), simulated=True)
    assert "photographs are not shown" in why
    assert {file.name for file in tmp_path.glob("*.png")} == {"walk.png"}
