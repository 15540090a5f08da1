# SPDX-License-Identifier: MIT
"""A cluster of which a worker is killed gives the numbers of one process."""

import pytest

from benchmarks.speed import cluster
from model.mapping import Here
from model.study.ranks import RankStudy
from support.study_layouts import design


def test_replicates_are_timed():
    found = cluster.mapped(Here(), RankStudy(design(), design()), 1)
    assert [each.index for each in found.replicates] == [0]
    assert found.seconds > 0


def test_the_sweep_has_runs_of_several_blocks():
    study = cluster.sweep_study()
    assert study.design.blocks.n_runs == 64
    assert {"noise_correlation", "offset_spread"} <= set(study.fitted.free)


@pytest.mark.long
@pytest.mark.filterwarnings("ignore")
def test_four_processes_of_which_one_is_killed_give_the_same_numbers(capsys):
    pytest.importorskip("distributed")
    assert cluster.main(40, 4)
    print(capsys.readouterr().out)  # noqa: T201 - the table
