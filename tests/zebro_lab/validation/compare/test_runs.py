# SPDX-License-Identifier: MIT
"""Runs are compared by what was tracked, wherever they were walked."""

import numpy as np
import pytest

from model.metrics.difference import difference
from support.compared_folders import compared, run_folder
from zebro_lab.validation.compare.runs import compare_runs

pytestmark = pytest.mark.usefixtures("blank_pictures")


def test_a_tighter_turn_is_told_from_a_wide_one_wherever_it_was_walked(tmp_path):
    one, other = run_folder(tmp_path / "a"), run_folder(tmp_path / "b", radius=1.9, seed=2)
    done, by_name = compared(one, other, tmp_path / "out")
    assert done.comparison.kind == "runs"
    curvature = by_name["curvature, tracked"]
    assert curvature.median == pytest.approx(1 / 1.9 - 1 / 2.0, rel=0.2)
    assert curvature.clear
    assert not by_name["speed, tracked"].clear
    start = done.comparison.paths[0]
    np.testing.assert_allclose([*start.position[0], start.yaw[0]], 0, atol=1e-12)


@pytest.mark.long
def test_runs_that_differ_by_noise_alone_are_not_told_apart_more_often_than_stated(tmp_path):
    told = 0
    for seed in range(20):
        one = run_folder(tmp_path / f"a{seed}", seed=seed)
        other = run_folder(tmp_path / f"b{seed}", seed=100 + seed)
        rng = np.random.default_rng(seed)
        quantities = compare_runs(one, other, names=("a", "b"), rng=rng).quantities
        rate = next(each for each in quantities if each.name == "yaw rate, tracked")
        told += difference(*rate.draws, rng=rng).clear
    assert told <= 6  # of 20 at 10 %: more comes once in 400
