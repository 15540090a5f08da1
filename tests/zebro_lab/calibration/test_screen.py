# SPDX-License-Identifier: MIT
"""What is printed of a calibration has the fit's numbers, its faults and its files."""

import io
from dataclasses import replace

import numpy as np
import pytest
from rich.console import Console

from model.bayes.advice import ExcludeRuns, MeasureSlips
from model.bayes.checks.check import Outcome, decided
from model.bayes.prior_conflict import PriorShift
from model.bayes.run_out import DiscRunOut, RunOut
from model.bayes.verdict import MEANINGS
from support.short_calibration import short_calibration
from zebro_lab.calibration.advice import advice_text
from zebro_lab.calibration.rig_data import read_rig_data
from zebro_lab.calibration.screen import (
    print_calibration,
    print_data,
    prior_words,
    run_out_lines,
)


@pytest.fixture(scope="module")
def printed(sweep, tmp_path_factory) -> str:
    out = tmp_path_factory.mktemp("calibration")
    (out / "[bold]slip.toml").touch()
    console = Console(file=io.StringIO(), width=160)
    print_data(console, read_rig_data([sweep]))
    print_calibration(console, short_calibration(), out)
    return console.file.getvalue()


def row_of(printed: str, name: str) -> str:
    (line,) = [each for each in printed.splitlines() if each.strip().startswith(f"{name} ")]
    return line


def test_every_parameter_has_median_interval_and_diagnostics(printed):
    calibration = short_calibration()
    free = [parameter.name for parameter in calibration.posterior.free]
    assert "and of the measurement (simulated)" in printed
    for each in calibration.parameters:
        row = row_of(printed, each.parameter.name)
        assert f"{each.median:.4g}" in row
        if each.parameter.name in free:
            i = free.index(each.parameter.name)
            assert f"{each.low:.4g} … {each.high:.4g}" in row
            assert f"{calibration.convergence.r_hat[i]:.3f}" in row
            assert f"{calibration.convergence.ess_bulk[i]:.0f}" in row
        else:
            assert "fixed" in row


def test_the_curve_is_told_at_each_load(printed):
    calibration, (curve, _) = short_calibration(), printed.split("verdict: ")
    for load, row in zip(calibration.levels, calibration.curves, strict=True):
        line = row_of(curve, f"{load:.4g}")
        assert all(f"{each.median:.4g}" in line for each in row)


def test_faults_are_marked_with_their_evidence(printed):
    verdict = short_calibration().verdict
    assert f"verdict: {verdict.headline()}" in printed
    assert f"  That is: {MEANINGS[verdict.state]}.\n" in printed
    answers = {
        Outcome.PASSED: "Yes:",
        Outcome.FAILED: "NO:",
        Outcome.NOT_TESTABLE: "Cannot be told:",
    }
    text = " ".join(printed.split())
    for number, check in enumerate(verdict.checks, 1):
        assert f" {number} {check.name} {answers[check.outcome]} {check.evidence[:40]}" in text
    assert {check.outcome for check in verdict.checks} == set(answers)
    for step in verdict.next_steps():
        assert f"  next: {advice_text(step).splitlines()[0]}\n" in printed


def test_lines_of_a_plan_and_commands_are_printed_as_lines_to_copy(tmp_path):
    finished = short_calibration()
    steps = (MeasureSlips("x", (5.0, 10.0), (0.01, 0.2)), ExcludeRuns("y", ("one", "two")))
    checks = tuple(decided("sampler", False, "too short", step) for step in steps)
    verdict = replace(finished.verdict, checks=checks, found=())
    console = Console(file=io.StringIO(), width=80)
    print_calibration(console, replace(finished, verdict=verdict), tmp_path)
    lines = [line.strip() for line in console.file.getvalue().splitlines()]
    plan = lines[lines.index("[points]") : lines.index("[controls]")]
    assert plan == ["[points]", "loads = [5, 10]", "slips = [0.01, 0.2]",
                    'length = "duration"', "duration = 2.0"]  # fmt: skip
    commands = [f"zebro-lab exclude DATA/{name} --why REASON" for name in ("one", "two")]
    assert [line for line in lines if line.startswith("zebro-lab")] == commands


def test_data_source_and_files_are_told_and_names_are_no_markup(printed):
    assert "SIMULATED data, source 'sim:rig-sweep': 3600 samples in " in printed
    assert "[bold]slip.toml" in printed


def test_priors_that_were_stated_stand_beside_the_posterior_with_words(tmp_path):
    shift = PriorShift(("friction",), np.array([-4.2]), 18.1, 1, 2e-5)
    console = Console(file=io.StringIO(), width=160)
    print_calibration(console, replace(short_calibration(), prior_shifts=(shift,)), tmp_path)
    text = console.file.getvalue()
    assert "priors that were stated" in text
    assert "lognormal(median 0.6, spread 0.7)" in text
    assert "-4.20" in text
    assert "CONFLICT, prior of friction: the data move friction by 4.2 standard deviations" in text


def test_words_tell_agreement_conflict_and_what_cannot_be_tested():
    agrees = PriorShift(("shape",), np.array([0.3]), 0.1, 1, 0.75)
    assert prior_words(agrees).startswith("prior of shape: agrees with the data (p = 0.75")
    silent = PriorShift(("gain_normal",), np.array([0.0]), 0.0, 0, float("nan"))
    assert "not testable, the data say almost nothing" in prior_words(silent)
    joint = PriorShift(("shape", "friction"), np.array([0.3, 5.0]), 30.0, 2, 3e-7)
    assert "the earlier calibration: the data move friction by 5.0" in prior_words(joint)


def test_run_out_is_told_by_disc_in_millimetres_with_what_was_done():
    disc = DiscRunOut("leg", np.array([3e-5, 4e-5, 0.0, 1e-5]), np.full(4, 2e-6))
    (line,) = run_out_lines(RunOut((disc,), 30.0, 5.0, 0.0003))
    assert "leg disc 0.050 ± 0.002 mm once a turn, 0.010 ± 0.002 mm twice a turn" in line
    assert "slip is corrected" in line
    assert "not corrected" in run_out_lines(RunOut((disc,), 3.0, 5.0, 0.0003))[0]
    assert run_out_lines(None) == []
