# SPDX-License-Identifier: MIT
"""Tables of studies have a row for each parameter and each replicate, those that failed too."""

import pandas as pd
import pytest

from support.made_studies import coverage_of, ranks_of
from support.study_layouts import design
from zebro_lab.study.folder import (
    coverage_content,
    ranks_content,
    write_coverage,
    write_ranks,
)

pytestmark = pytest.mark.usefixtures("blank_pictures")
NAMES = ("slip_stiffness", "friction")


def test_ranks_and_tests_are_kept_for_every_replicate(tmp_path):
    result = ranks_of(NAMES, narrow=("friction",))
    write_ranks(tmp_path, result, design(), title="x", form="png")
    assert {p.name for p in tmp_path.iterdir()} == {
        "parameters.csv", "replicates.csv", "ranks.png", "ecdf.png"
    }  # fmt: skip
    table = pd.read_csv(tmp_path / "parameters.csv", index_col="parameter")
    assert list(table.index) == list(NAMES)
    assert table.loc["friction", "chi_square_p"] < 1e-6
    replicates = pd.read_csv(tmp_path / "replicates.csv")
    assert len(replicates) == 121
    assert replicates["failure"].iloc[-1] == "no curve"
    assert replicates["rank_friction"].isna().sum() == 1
    assert (replicates["reliable"] == 1).sum() == 120


def test_coverage_has_counts_with_both_bands(tmp_path):
    result = coverage_of(NAMES)
    write_coverage(tmp_path, result, design(), title="x", form="svg")
    assert (tmp_path / "coverage.svg").is_file()
    table = pd.read_csv(tmp_path / "parameters.csv", index_col="parameter")
    row = table.loc["friction"]
    assert row["unit"] == "dimensionless"
    assert row["joint_90_low"] <= row["band_90_low"] <= row["held_90"]
    assert len(pd.read_csv(tmp_path / "replicates.csv")) == 60


def test_the_verdict_has_outcome_and_headline():
    passed, failed = ranks_of(NAMES), ranks_of(NAMES, narrow=("friction",))
    assert ranks_content(passed)["verdict"]["outcome"] == "passed"
    assert ranks_content(failed)["verdict"]["outcome"] == "failed"
    assert ranks_content(ranks_of(NAMES, n=20))["verdict"]["outcome"] == "not_testable"
    content = coverage_content(coverage_of(NAMES), design())
    assert content["verdict"]["outcome"] == "passed"
    assert [row["parameter"] for row in content["parameters"]] == list(NAMES)
    assert content["largest_pareto_k"] == 0.3
