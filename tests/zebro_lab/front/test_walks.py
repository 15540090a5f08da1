# SPDX-License-Identifier: MIT
"""Walks and predictions, used as a notebook would."""

from pathlib import Path

import numpy as np
import pytest

import zebro_lab as zl
from zebro_lab.files.errors import AlreadyExists, SettingsError
from zebro_lab.walk.folder import read_walk

pytestmark = pytest.mark.usefixtures("blank_pictures")

WALK = Path(__file__).parents[3] / "datasets" / "walk-sim"


@pytest.fixture(scope="module")
def walk_folder(tmp_path_factory):
    out = tmp_path_factory.mktemp("walk") / "walk"
    zl.walk_gait("tripod", slip="coulomb:0.38", duration=4.0, steering=1.2, draws=5, out=str(out))
    return out


def test_a_gait_is_walked_without_a_folder():
    result = zl.walk_gait("tripod", slip="coulomb:0.38", duration=2.0)
    assert result.path.length > 0.1
    assert result.draws is None


def test_a_walk_with_draws_is_kept_where_asked(walk_folder):
    assert (walk_folder / "manifest.json").is_file()
    again = zl.predict_walk(walk_folder, slip="coulomb:0.38", draws=5)
    assert again.draws is not None
    assert again.draws.states.shape[0] == 5
    end = zl.read_track(walk_folder / "path.csv").poses.position[-1]
    assert np.linalg.norm(again.path.position[-1] - end) < 0.02


def test_legs_are_read_from_strings():
    assert zl.read_legs(str(WALK / "legs.csv")).reference.theta.shape[1] == 6


def test_files_of_others_are_kept(tmp_path):
    (tmp_path / "mine.txt").write_text("mine")
    with pytest.raises(AlreadyExists):
        zl.walk_gait("tripod", slip="coulomb:0.4", duration=1.0, out=tmp_path / "mine.txt")
    assert (tmp_path / "mine.txt").read_text() == "mine"


def test_a_walk_on_a_ground_is_that_of_the_command(run_command, tmp_path):
    ground = tmp_path / "ground.toml"
    ground.write_text("slope_deg = [4.0, 1.0]\n")
    result = zl.walk_gait("tripod", slip="coulomb:0.5", duration=2.0, ground=str(ground))
    words = ("walk", "--slip", "coulomb:0.5", "--duration", 2, "--ground", ground, "--out")
    assert run_command(*words, tmp_path / "w").code == 0
    np.testing.assert_allclose(result.walk.position, read_walk(tmp_path / "w").position, atol=1e-9)
    again = zl.predict_walk(tmp_path / "w", slip="coulomb:0.5", ground=ground)
    np.testing.assert_allclose(again.path.position[-1], result.path.position[-1], atol=2e-3)
    assert any(note.startswith("ground: slope of 4 deg") for note in result.notes)


def test_the_thesis_s_text_is_walked_as_by_the_command(run_command, tmp_path):
    given = {"slip": "thesis", "model": "thesis", "steering": 1.2, "duration": 4.0}
    result = zl.walk_gait("tripod", thesis="text", **given)
    words = ("walk", "--slip", "thesis", "--model", "thesis", "--steering", 1.2, "--duration", 4)
    assert run_command(*words, "--thesis", "text", "--out", tmp_path / "w").code == 0
    np.testing.assert_allclose(result.walk.position, read_walk(tmp_path / "w").position, atol=1e-9)
    plain = zl.walk_gait("tripod", **given)
    assert np.abs(result.walk.position - plain.walk.position).max() > 1e-4


def test_the_thesis_s_text_with_another_model_is_an_error_of_the_library():
    with pytest.raises(SettingsError, match="of the thesis's model, not of 'dynamics'"):
        zl.walk_gait("tripod", slip="thesis", model="dynamics", thesis="text", duration=1.0)
