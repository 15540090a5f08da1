# SPDX-License-Identifier: MIT
"""A prediction is judged from the first tracked pose on, where both have times."""

from pathlib import Path

import numpy as np
import pandas as pd
import pytest

from model.judgement import Prediction
from model.poses import Poses
from support.validated_walks import request_of
from support.watchers import Nobody
from zebro_lab.files.errors import DataError, SettingsError
from zebro_lab.track.file import TrackFile
from zebro_lab.validation.judged_run import judge_run
from zebro_lab.validation.predicted_walks import pairs_of_run
from zebro_lab.validation.stage import validate
from zebro_lab.walk.prediction_file import PredictionFile


def test_the_first_tracked_pose_starts_the_prediction_and_is_not_scored(validated, walk):
    tracked = pd.read_csv(walk / "track/track.csv")
    assert len(validated.runs[0].track) == len(tracked) - 1


def test_a_track_of_two_poses_is_refused(walk, tmp_path):
    prediction, track = pairs_of_run(walk)
    pd.read_csv(track / "track.csv").iloc[:2].to_csv(tmp_path / "two.csv", index=False)
    pair = ((prediction, tmp_path / "two.csv"),)
    with pytest.raises(DataError, match="has 2 poses; expected 3 or more"):
        validate(request_of(pair, tmp_path / "out"), Nobody())


T = np.linspace(0.0, 4.0, 9)
PATH = Poses(T, np.column_stack([0.1 * T, 0.0 * T]), 0.0 * T)


def judge(track: Poses, *, anchor: bool = False, draws: int = 0):
    file = TrackFile(track, "real", Path("track.csv"), notes=("tracked",))
    rng = np.random.default_rng(1)
    moved = PATH.position + rng.normal(0, 0.01, (draws, 1, 2))
    band = Poses(T, moved, np.tile(PATH.yaw, (draws, 1))) if draws else None
    prediction = PredictionFile(Prediction(PATH, band), ("sim:x",), (), ("predicted",))
    return judge_run("walk", prediction, file, anchor=anchor, rng=rng)


def test_errors_are_those_of_the_prediction_against_the_track():
    found = judge(Poses(T, PATH.position + np.array([0.0, 0.03]), PATH.yaw))
    assert found.name == "walk"
    assert [row.name for row in found.rows] == ["prediction", "stand still"]
    assert found.rows[0].errors.ate == pytest.approx(0.03)
    assert found.notes[:2] == ("tracked", "predicted")


def test_an_anchored_path_starts_at_the_first_tracked_pose():
    moved = PATH.moved(rotation=0.5, translation=[1.0, 2.0])
    assert judge(moved, anchor=True).rows[0].errors.ate == pytest.approx(0.0, abs=1e-12)
    assert judge(moved).rows[0].errors.ate > 1.0


def test_poses_outside_the_predicted_time_are_left_out_and_noted():
    found = judge(PATH.delayed(2.0))
    assert found.rows[0].errors.poses == 5
    assert found.notes[2].startswith("4 tracked poses lie outside the predicted time")
    assert judge(PATH.delayed(0.5)).notes[2].startswith("1 tracked pose lies outside")
    warning = judge(PATH.delayed(2.5)).notes[2]  # most of the track
    assert warning.startswith("WARNING")
    assert "4 of 9 tracked poses" in warning
    with pytest.raises(DataError, match="start from it: 1; expected two or more"):
        judge(PATH.delayed(3.2), anchor=True)


def test_a_track_without_headings_cannot_start_a_prediction():
    blind = Poses(T, PATH.position, np.full_like(T, np.nan))
    with pytest.raises(SettingsError, match="--no-anchor"):
        judge(blind, anchor=True)


@pytest.mark.parametrize(
    ("draws", "heading", "told"),
    [
        (0, 0.0, ["coverage and consistency: not testable without a band"]),
        (49, 0.0, ["consistency of the band: not testable with 49 draws; expected 50 or more"]),
        (50, 0.0, []),
        (50, np.nan, ["coverage and consistency of yaw: not testable"]),
    ],
)
def test_what_cannot_be_judged_is_told(draws, heading, told):
    track = Poses(T, PATH.position, np.full_like(T, heading))
    found = judge(track, draws=draws)
    assert bool(found.rows[0].consistency) == (draws >= 50)
    clock, *lines = sorted(
        (note for note in found.notes if "not testable" in note), key=lambda x: "clock" not in x
    )
    assert "clock" in clock  # an even motion determines none
    assert [line[: len(start)] for line, start in zip(lines, told, strict=True)] == told


@pytest.mark.parametrize("late", [0.0, 2.0])
def test_a_clock_that_the_motion_contradicts_is_told_with_the_offset(late):
    t = np.linspace(0.0, 30.0, 301)
    moved = np.clip(t - 4.0, 0.0, 12.0) + np.clip(t - 20.0, 0.0, 6.0)  # starts, rests, starts
    turned = 0.8 * np.sin(0.2 * moved)
    path = Poses(t, 0.1 * np.column_stack([moved, turned]), 0.0 * t)
    seen = path.at(np.arange(2.0, 28.0, 1.0))
    rng = np.random.default_rng(0)
    position = seen.position + 1e-3 * rng.standard_normal(seen.position.shape)
    track = TrackFile(Poses(seen.t - late, position, seen.yaw), "sim:test", Path("track.csv"))
    prediction = PredictionFile(Prediction(path), ("sim:test",), (), ())
    found = judge_run("walk", prediction, track, anchor=False, rng=rng)
    warned = [note for note in found.notes if "--estimate-offset" in note]
    assert len(warned) == (late > 0)
    assert all("+2.0 ±" in note for note in warned)


@pytest.mark.parametrize("factor", [1000.0, 2.8])
def test_a_track_in_another_unit_of_length_is_asked_about(factor):
    note = judge(Poses(T, factor * PATH.position, PATH.yaw)).notes[0]
    assert ("mm and m" in note) == (factor == 1000.0)


def arc(*, left: bool, turn: float = 1.2) -> Poses:
    t = np.linspace(0.0, 4.0, 90)
    side, angle = 1 if left else -1, turn * t / 4
    places = np.column_stack([np.sin(angle), side * (1 - np.cos(angle))])
    return Poses(t, places + np.random.default_rng(3).normal(0, 1e-3, places.shape), side * angle)


@pytest.mark.parametrize(("left", "said"), [(True, False), (False, True)])
def test_a_track_that_turns_to_the_other_side_is_asked_about(monkeypatch, left, said):
    monkeypatch.setitem(globals(), "PATH", arc(left=True))
    found = judge(arc(left=left))
    asked = [note for note in found.notes if "is the plane of the floor mirrored" in note]
    assert bool(asked) == said
    assert all("predicted turns left, tracked right" in note for note in asked)
    assert all(note.startswith("WARNING: ") and "--plane zx" in note for note in asked)


def test_seconds_without_poses_are_told():
    t = np.delete(np.arange(0, 4.001, 0.05), slice(20, 40))
    found = judge(Poses(t, np.column_stack([0.1 * t, 0 * t]), 0 * t))
    assert any("1 gap, the longest of 1.05 s: 1 of 4 s" in note for note in found.notes)
    assert not any("gap" in note for note in judge(PATH).notes)
