# SPDX-License-Identifier: MIT
"""A track by another clock is brought to that of the prediction, or refused."""

import json
from dataclasses import replace
from pathlib import Path

import numpy as np
import pandas as pd
import pytest

from model.joint_covariance import JointCovariance
from model.poses import Poses
from support.validated_walks import request_of, rows_of
from support.watchers import Nobody
from zebro_lab.files.errors import DataError
from zebro_lab.track.file import TrackFile, read_track
from zebro_lab.validation.predicted_walks import pairs_of_run
from zebro_lab.validation.shared_clock import estimated_clock, shifted
from zebro_lab.validation.stage import validate

pytestmark = pytest.mark.usefixtures("blank_pictures")


def test_clocks_apart_are_refused_and_an_offset_brings_them_together(walk, tmp_path):
    prediction, track = pairs_of_run(walk)
    late = pd.read_csv(track / "track.csv")
    late["t_s"] += 1000
    late.to_csv(tmp_path / "late.csv", index=False)
    pair = ((prediction, tmp_path / "late.csv"),)
    with pytest.raises(DataError, match="--time-offset"):
        validate(request_of(pair, tmp_path / "out"), Nobody())
    assert not (tmp_path / "out").exists()
    done = validate(request_of(pair, tmp_path / "out", time_offset=-1000.0), Nobody())
    assert rows_of(done)["prediction"].errors.ate_of_length < 0.02


def standing_walk(folder, *, behind):
    """Write a path that stands, turns a circle and stands, and its track by a clock behind it."""
    t = np.arange(0.0, 24.0, 0.05)
    gone = 0.1 * np.clip(t - 2.0, 0.0, 20.0)
    path = pd.DataFrame(
        {"t": t, "x": 1.5 * np.sin(gone / 1.5), "y": 1.5 - 1.5 * np.cos(gone / 1.5)}
    )
    path["yaw"] = gone / 1.5
    path.to_csv(folder / "path.csv", index=False)
    track = path.iloc[6::40].copy()
    noise = np.random.default_rng(1).normal(0, 0.002, (len(track), 3))
    track[["x", "y", "yaw"]] += noise
    track["t"] -= behind
    track.to_csv(folder / "seen.csv", index=False)
    return folder / "path.csv", folder / "seen.csv"


def test_another_clock_s_offset_is_found_and_told(tmp_path):
    pair = standing_walk(tmp_path, behind=1234.5)
    done = validate(request_of((pair,), tmp_path / "out", estimate_offset=True), Nobody())
    assert rows_of(done)["prediction"].errors.ate < 0.01
    assert any(note.startswith("clock: +1234.") and "±" in note for note in done.runs[0].notes)
    settings = json.loads((tmp_path / "out/manifest.json").read_text())["settings"]
    assert settings["time_offset_estimated"]
    assert settings["time_offset"]["path"] == pytest.approx(1234.5, abs=0.1)


def test_an_offset_that_the_motion_does_not_tell_is_asked_for(walk, tmp_path):
    prediction, track = pairs_of_run(walk)  # an even walk: neither starts nor stops in view
    request = request_of(((prediction, track),), tmp_path / "out", estimate_offset=True)
    with pytest.raises(DataError, match="--time-offset"):
        validate(request, Nobody())
    assert not (tmp_path / "out").exists()


def test_a_given_offset_is_added_to_the_tracks_times():
    poses = Poses(np.array([0.0, 1.0]), np.zeros((2, 2)), np.zeros(2))
    moved = shifted(TrackFile(poses, "real", Path("track.csv")), 12.5)
    np.testing.assert_array_equal(moved.poses.t, [12.5, 13.5])


def test_an_estimated_offset_widens_the_covariance_along_the_path(tmp_path):
    path, track = (read_track(file) for file in standing_walk(tmp_path, behind=3.0))
    known = np.tile(1e-6 * np.eye(3), (len(track.poses), 1, 1))
    track = replace(track, poses=replace(track.poses, joint=JointCovariance.independent(known)))
    moved, offset = estimated_clock(track, path.poses)
    assert offset == pytest.approx(3.0, abs=0.1)
    np.testing.assert_allclose(moved.poses.t, track.poses.t + offset)
    wider = moved.covariance - known
    moving = (moved.poses.t > 3.0) & (moved.poses.t < 21.0)
    speed = np.array([np.trace(each[:2, :2]) for each in wider])
    assert np.all(speed[moving] > 0)
    np.testing.assert_allclose(wider[moved.poses.t < 1.5], 0.0, atol=1e-12)
    rate = wider[moving, 2, 2] / speed[moving]
    np.testing.assert_allclose(rate, 1 / 1.5**2, rtol=1e-3)  # of the circle that it walks


def test_a_dense_track_that_begins_before_the_path_and_ends_after_it_is_shifted(tmp_path):
    file, _ = standing_walk(tmp_path, behind=0.0)
    walk = pd.read_csv(file)
    whole = Poses(walk.t.to_numpy(), walk[["x", "y"]].to_numpy(), walk.yaw.to_numpy())
    path = whole.part((whole.t > 1.0) & (whole.t < 23.0))
    t = np.arange(0.0, 23.9, 0.01)
    noise = np.random.default_rng(1).normal(0.0, 1e-4, (len(t), 2))
    seen = whole.at(t)
    tracked = TrackFile(
        replace(seen, t=t - 3.0, position=seen.position + noise), "sim:test", Path("a.csv")
    )
    moved, offset = estimated_clock(tracked, path)
    assert offset == pytest.approx(3.0, abs=0.02)
    still = moved.covariance[[0, -1]]
    np.testing.assert_allclose(still, tracked.covariance[[0, -1]], atol=1e-12)


def test_a_mirrored_floor_is_asked_about_where_the_offset_is_not_found(tmp_path):
    path, seen = standing_walk(tmp_path, behind=1.5)
    track = read_track(seen)
    mirrored = track.poses.position * [1, -1]
    mirrored_track = replace(track, poses=replace(track.poses, position=mirrored))
    with pytest.raises(DataError, match="predicted turns left, tracked right") as raised:
        estimated_clock(mirrored_track, read_track(path).poses)
    assert "--plane zx" in str(raised.value)
    assert "start and stop" not in str(raised.value)
