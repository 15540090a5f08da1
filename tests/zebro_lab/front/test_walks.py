# SPDX-License-Identifier: MIT
"""Walks and predictions, used as a notebook would."""

from pathlib import Path

import numpy as np
import pytest

import zebro_lab as zl
from zebro_lab.files.errors import AlreadyExists

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
