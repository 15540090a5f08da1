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


def test_a_walk_has_its_folders_name_its_sources_files_and_why_no_photographs(walk, validated):
    (found,) = read_predicted_walks([pairs_of_run(walk)])
    assert found.name == walk.name
    files = found.files_of(validated.runs[0])
    assert {walk / "track/track.csv", walk / "prediction/path.csv"} <= set(files)
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
    for note, (name, why) in zip(
        notes, (("plot.png", "a file"), ("walk", "no run folder"), (rig, "slip rig"),
                ("bare", "no prediction")), strict=True,
    ):  # fmt: skip
        assert note.startswith(f"left out, {name}: ")
        assert why in note
    assert pairs_of_runs([walk]) == ([pairs_of_run(walk)], ())


def test_paths_without_any_walk_and_missing_ones_are_refused(walk, others):
    for paths, message in (
        (others[:1], "no prediction"),
        (others, "none of 4 paths is a run with prediction and track; left"),
        ([walk, others[0].parent / "typo"], "typo: no such file"),
    ):
        with pytest.raises(NotFound, match=message):
            pairs_of_runs(paths)


def test_files_beside_a_run_are_no_trajectories(walk, others):
    assert not ValidateRequest((others[0], walk)).is_pair
    assert ValidateRequest((others[0], others[0])).is_pair
    assert ValidateRequest((others[0], others[1])).is_pair  # wrong usage, and named as such
