# SPDX-License-Identifier: MIT
"""Of several paths the walks are judged, and what is none is left out and named."""

import pytest

from support.written_runs import make_run
from zebro_lab.files.errors import NotFound
from zebro_lab.validation.chosen_runs import pairs_of_runs
from zebro_lab.validation.predicted_walks import pairs_of_run
from zebro_lab.validation.request import ValidateRequest

pytestmark = pytest.mark.usefixtures("blank_pictures")


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
