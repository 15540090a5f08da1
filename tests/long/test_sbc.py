# SPDX-License-Identifier: MIT
"""Ranks of true values are uniform for the full data model, and not for one that forgets noise.

The layout is a sweep of 10 slip ratios of both signs at three loads, 30 runs of 0.4 s. Parameters
of law, load cell, radii, rolling resistance, noise and offsets are drawn from the default priors.
"""

import os

import pytest

from model.slip.thesis import THESIS_LAW
from model.study.ranks import (
    WRONG,
    RankResult,
    RankStudy,
    Replicate,
    conclude_ranks,
    rank_replicate,
)
from support.experiment_plans import THESIS_PLAN
from zebro_lab.study.folder import rank_row
from zebro_lab.study.layout import read_layout
from zebro_lab.study.request import LayoutRequest
from zebro_lab.workers.processes import Processes

pytestmark = [pytest.mark.long, pytest.mark.timeout(5400)]

REPLICATES = 300
SWEEP = {
    "loads = [2.13, 6.63, 8.13, 12.75]": "loads = [3.0, 8.0, 13.0]",
    "first = 0.0, last = 1.0, count = 62": "first = -0.3, last = 1.0, count = 10",
    "\nduration = 1.0": "\nduration = 0.4",
}


def say(line: str) -> None:
    print(line, flush=True)  # noqa: T201 the table is what `make test-long` is run for


@pytest.fixture(scope="module")
def design(tmp_path_factory):
    text = THESIS_PLAN.read_text()
    for old, new in SWEEP.items():
        assert old in text
        text = text.replace(old, new)
    file = tmp_path_factory.mktemp("plan") / "plan.toml"
    file.write_text(text)
    return read_layout(LayoutRequest(plan=file), THESIS_LAW).design


def studied(study: RankStudy) -> RankResult:
    """Rank all replicates on all cores, and print the table."""
    tasks = [Replicate(1, index) for index in range(REPLICATES)]
    workers = Processes(os.cpu_count() or 1)
    result = conclude_ranks(study.fitted.free, list(workers.map(rank_replicate, study, tasks)))
    say(f"\n\n{result.headline}; {result.ranked} ranked, {result.left_out} left out\n")
    for row in map(rank_row, result.tests):
        say(
            f"| {row['parameter']} | {row['chi_square_p']:.2g} | {row['ecdf_p']:.2g} | "
            f"{row['mean_rank_in_sd']:+.1f} | {row['spread_of_ranks_in_sd']:+.1f} |"
        )
    return result


def test_ranks_of_the_full_data_model_are_uniform(design):
    result = studied(RankStudy(design, design))
    assert result.testable
    assert not result.failed


def test_a_model_without_memory_and_offsets_is_found_out(design):
    wrong = design.assuming(WRONG["independent-noise"])
    result = studied(RankStudy(design, wrong))
    assert min(each.chi_square_p for each in result.tests) < 1e-6
    assert min(each.ecdf_p for each in result.tests) < 1e-6
