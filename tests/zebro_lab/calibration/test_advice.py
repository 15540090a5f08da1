# SPDX-License-Identifier: MIT
"""Advice holds lines, commands and options that can be used as they stand."""

import tomllib
from types import SimpleNamespace

import numpy as np
import pytest

from model.bayes.advice import (
    Advice,
    ExcludeRuns,
    MeasureAlso,
    MeasureSlips,
    SampleLonger,
    TryLaws,
    ZeroBeforeEach,
)
from model.bayes.checks.check import decided
from model.bayes.verdict import Verdict
from support.judged_fits import blocks_at
from zebro_lab.calibration.advice import SECONDS, SHORT, advice_text, advice_texts, of_table


def plan_in(advice: str) -> dict:
    """Parse the lines of a plan in advice, which are between its first and its last line."""
    return tomllib.loads("\n".join(advice.splitlines()[1:-1]))


def test_further_slips_are_lines_of_a_plan_and_are_fitted_with_the_others():
    advice = advice_text(MeasureSlips("x", (5.0, 10.0), (0.01, 0.03, 0.2)))
    plan = plan_in(advice)
    assert advice.startswith("x: measure 3 more slip ratios")
    assert plan["points"]["loads"] == [5.0, 10.0]
    assert plan["points"]["slips"] == [0.01, 0.03, 0.2]
    assert plan["points"]["duration"] == SECONDS
    assert plan["controls"]["tare_every"] == 3
    assert "calibrate-slip DATA FURTHER" in advice.splitlines()[-1]


def test_slips_that_a_plan_cannot_tell_apart_are_measured_once():
    advice = advice_text(MeasureSlips("x", (5.0,), (0.031, 0.0312, 0.2)))
    assert plan_in(advice)["points"]["slips"] == [0.031, 0.2]


def test_short_runs_have_a_zero_each_and_are_fitted_alone():
    advice = advice_text(ZeroBeforeEach("x"))
    assert plan_in(advice)["points"]["duration"] == SHORT
    assert plan_in(advice)["controls"]["tare_every"] == 1
    assert "calibrate-slip FURTHER" in advice.splitlines()[-1]


def test_laws_are_compared_and_driving_and_braking_parted_where_both_were_measured():
    one = advice_text(TryLaws("x", both_signs=False))
    both = advice_text(TryLaws("x", both_signs=True))
    assert "with --law compare, each" in one
    assert "with --law compare, then with that law and --sides auto, each" in both


def test_each_run_that_is_left_out_has_its_command():
    lines = advice_text(ExcludeRuns("x", ("one", "two"))).splitlines()
    assert lines[1:] == [f"zebro-lab exclude DATA/{run} --why REASON" for run in ("one", "two")]


def test_rows_of_a_table_are_left_out_by_their_numbers():
    text = advice_text(ExcludeRuns("x", ("table row 8", "table row 12", "other row 3")))
    given = [tomllib.loads("\n".join(line.split(" ", 1))) for line in text.splitlines()[1:]]
    assert given == [{"runs": {"leave_out": rows}} for rows in ([8, 12], [3])]
    assert "zebro-lab exclude" not in text


def test_a_table_of_means_has_no_plan_and_no_run_folders():
    """Who brings a table has rows to add, to mend or to leave out."""
    advices = (
        MeasureSlips("x", (5.0, 10.0), (0.01, 0.2)), MeasureAlso("x", loads=(2.0, 8.0)),
        MeasureAlso("x", repeats=2), ZeroBeforeEach("x"), ExcludeRuns("x", ("table row 8",)),
    )  # fmt: skip
    for advice in advices:
        text = of_table(advice)
        assert text.startswith("x: ")
        assert "[points]" not in text
        assert "zebro-lab exclude" not in text
    assert "0.01, 0.2, at loads of 5, 10 N" in of_table(advices[0])
    verdict = Verdict((decided("Question?", False, "", *advices[:2], advices[1]),))
    for per_run, written in ((1, of_table), (6, advice_text)):
        blocks = blocks_at(np.array([0.1, 0.2]), per_run=per_run)
        fit = SimpleNamespace(posterior=SimpleNamespace(blocks=blocks), verdict=verdict)
        assert advice_texts(fit) == [written(each) for each in advices[:2]]


@pytest.mark.parametrize(
    ("advice", "said"),
    [
        (SampleLonger("sample longer", 400), "command with --resume --max-steps 400"),
        (Advice("use F_max"), "use F_max"),
    ],
)
def test_other_advice_begins_with_its_reason_and_names_its_command(advice, said):
    assert advice_text(advice).startswith(advice.reason)
    assert said in advice_text(advice)
