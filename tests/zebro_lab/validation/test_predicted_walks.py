# SPDX-License-Identifier: MIT
"""Predictions and tracks are read in pairs, each once, with what else their runs hold."""

import shutil

import pytest

from support.watchers import Nobody
from support.written_runs import make_run
from zebro_lab.files.errors import NotFound, SettingsError
from zebro_lab.validation.predicted_walks import pairs_of_run, pairs_of_runs, read_predicted_walks
from zebro_lab.validation.request import ValidateRequest
from zebro_lab.validation.stage import validate

pytestmark = pytest.mark.usefixtures("blank_pictures")


def test_a_run_without_a_track_says_what_to_do(walk, tmp_path):
    with pytest.raises(NotFound, match="predict"):
        pairs_of_run(tmp_path)
    (tmp_path / "prediction").symlink_to(walk / "prediction")
    with pytest.raises(NotFound, match=r"track\.csv"):
        pairs_of_run(tmp_path)


def test_a_run_under_two_names_is_averaged_once_and_told(walk, tmp_path):
    copy = shutil.copytree(walk, tmp_path / "copy")
    done = validate(ValidateRequest((walk, copy), out=tmp_path / "out"), Nobody())
    assert len(done.runs) == 1
    assert not done.summary
    assert any("copy" in note and "duplicate" in note for note in done.runs[0].notes)


def test_a_walk_has_its_folders_name_its_sources_and_why_there_are_no_photographs(walk):
    (found,) = read_predicted_walks([pairs_of_run(walk)])
    assert found.name == walk.name
    assert found.sources == (*found.prediction.sources, found.track.source)
    assert (found.tilt, found.photos, found.duplicates) == (None, None, ())
    assert found.not_shown[0].startswith("photographs are not shown: ")


def test_walks_of_one_name_are_numbered(walk, tmp_path):
    for place in ("one", "other"):
        shutil.copytree(walk, tmp_path / place / "walk")
    track = tmp_path / "other/walk/track/track.csv"
    track.write_text("".join(track.read_text().splitlines(keepends=True)[:-1]))
    pairs = [pairs_of_run(tmp_path / place / "walk") for place in ("one", "other")]
    assert [found.name for found in read_predicted_walks(pairs)] == ["walk-1", "walk-2"]


@pytest.mark.parametrize("files", [("", ""), ("track.csv", "path.csv")])
def test_a_track_and_a_prediction_that_are_exchanged_are_told(walk, files):
    pair = (walk / "track" / files[0], walk / "prediction" / files[1])
    with pytest.raises(SettingsError, match=r"^--predicted, --track: .* exchange the two$"):
        read_predicted_walks([pair])


def test_a_pair_of_files_is_named_by_the_predicted_file(walk, tmp_path):
    shutil.copy(walk / "prediction/path.csv", tmp_path / "guess.csv")
    (found,) = read_predicted_walks([(tmp_path / "guess.csv", walk / "track/track.csv")])
    assert found.name == "guess"


def test_files_of_a_judgement_are_those_that_were_read(validated, walk):
    (found,) = read_predicted_walks([pairs_of_run(walk)])
    files = found.files_of(validated.runs[0])
    assert walk / "track/track.csv" in files
    assert walk / "prediction/path.csv" in files


@pytest.fixture
def others(tmp_path):
    """Return what lies beside walks in a folder: a plot, a walk folder, a rig's run, a bare run."""
    (tmp_path / "plot.png").write_bytes(b"")
    (tmp_path / "walk").mkdir()
    (tmp_path / "bare" / "track").mkdir(parents=True)
    return [tmp_path / "plot.png", tmp_path / "walk", make_run(tmp_path), tmp_path / "bare"]


def test_what_is_no_walk_with_prediction_and_track_is_left_out_and_named(walk, others):
    pairs, notes = pairs_of_runs([*others, walk])
    assert pairs == [pairs_of_run(walk)]
    rig = others[2].name
    assert notes[:3] == (
        "left out, plot.png: a file, no run folder", "left out, walk: no run folder",
        f"left out, {rig}: a run of the slip rig",
    )  # fmt: skip
    assert notes[3].startswith("left out, bare: ")
    assert "no prediction; make one with" in notes[3]


def test_a_single_path_must_be_a_walk(walk, others):
    assert pairs_of_runs([walk]) == ([pairs_of_run(walk)], ())
    with pytest.raises(NotFound, match="no prediction"):
        pairs_of_runs(others[:1])


def test_paths_without_any_walk_are_one_line(others):
    with pytest.raises(NotFound, match="none of 4 paths is a run with prediction and track; left"):
        pairs_of_runs(others)


def test_a_path_that_does_not_exist_is_not_left_out(walk, tmp_path):
    with pytest.raises(NotFound, match="typo: no such file"):
        pairs_of_runs([walk, tmp_path / "typo"])


def test_files_beside_a_run_are_no_trajectories(walk, others):
    assert not ValidateRequest((others[0], walk)).is_pair
    assert ValidateRequest((others[0], others[0])).is_pair
    assert ValidateRequest((others[0], others[1])).is_pair  # wrong usage, and named as such
