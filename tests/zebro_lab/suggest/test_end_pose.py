# SPDX-License-Identifier: MIT
"""The end pose of a walk is linear in the law's coordinates, and depends on nothing else."""

import numpy as np
import pytest

from support.small_layouts import posterior as posterior_of
from support.walk_requests import write_log
from zebro_lab.files.errors import DataError, NotFound
from zebro_lab.suggest.end_pose import end_pose_target, end_poses, read_walk


@pytest.fixture(scope="module")
def posterior():
    return posterior_of()


def test_a_walk_ends_where_its_linear_prediction_says(posterior, tmp_path):
    walk = read_walk(write_log(tmp_path))
    assert walk.duration == pytest.approx(4.0)
    assert walk.files[0] == tmp_path / "legs.csv"
    z = 0.05 * np.random.default_rng(2).standard_normal((12, len(posterior.free)))
    target = end_pose_target("walk", walk, posterior, z, n_draws=2)
    assert (target.parts, target.rows.shape) == (("x", "y", "heading"), (2, 3, z.shape[1]))
    of_law = [p.name in ("slip_stiffness", "friction") for p in posterior.free]
    assert np.abs(target.rows[..., ~np.array(of_law)]).max() == 0
    walked, poses = end_poses(walk, posterior, z)
    predicted = walked @ target.rows[0].T
    rest = (poses - poses.mean(axis=0)) - (predicted - predicted.mean(axis=0))
    assert rest.std(axis=0) == pytest.approx(0.0, abs=0.2 * poses.std(axis=0).max())


def test_a_folder_without_legs_says_what_is_expected(tmp_path):
    with pytest.raises(DataError, match=r"is a folder without path\.csv"):
        read_walk(tmp_path)
    with pytest.raises(NotFound):
        read_walk(tmp_path / "legs.csv")
