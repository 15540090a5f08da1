# SPDX-License-Identifier: MIT
"""Each question is answered yes, no, or by what cannot be told, with its number and limit."""

from dataclasses import replace

import numpy as np
import pytest

from model.bayes.advice import (
    Advice,
    MeasureAlso,
    MeasureSlips,
    SampleAgain,
    SampleLonger,
    SamplePosterior,
    TryLaws,
)
from model.bayes.checks import questions
from model.bayes.checks.causes import Cause, Effect, Finding, Question
from model.bayes.checks.check import Check, Outcome
from model.bayes.checks.comparison import Comparison
from model.bayes.checks.points import GroupResiduals
from model.bayes.checks.reach import reach_of
from support.judged_fits import AGREED, CONVERGED, LAW, RIG_VALUES, blocks_at, draws, two_sided

SOUND = two_sided(0.4)
SLIPS = np.linspace(0.05, 0.8, 8)
ADVICE = Advice("do")
REAL = Finding(
    Question.REPEAT, (Cause.MATERIALS,), "frictions differ", 90.0, 1e-9, Effect(0.0, 0.03), ADVICE
)
CHANCE = replace(REAL, text="zeros differ", p=0.2)
HARMLESS = replace(REAL, text="zeros wander", effect=Effect(0.0, 0.001))


def passed(check: Check) -> bool:
    return check.outcome is Outcome.PASSED


# --- did the sampler converge?

CONVERGENCE_FAULTS = {
    "R-hat between ensembles is 1.020, limit 1.01": {"r_hat": np.array([1.0, 1.02])},
    "Monte Carlo error over posterior spread is 0.060": {"mcse": np.array([0.01, 0.06])},
    "bulk effective sample size is 399, at least 400 needed": {"ess_bulk": np.array([5e3, 399.0])},
    "tail effective sample size is 120, at least 400 needed": {"ess_tail": np.array([120.0, 5e3])},
    "chain length in autocorrelation times is 40, at least 50 needed": {"length": 400},
}


@pytest.mark.parametrize("evidence", CONVERGENCE_FAULTS)
def test_broken_rule_of_convergence_is_named_with_its_figure(evidence):
    bad = replace(CONVERGED, **CONVERGENCE_FAULTS[evidence])
    check = questions.sampler(bad, AGREED)
    assert check.failed
    assert check.evidence.startswith(evidence)
    assert check.advice == (SampleLonger("sample longer", 2 * bad.moves),)


@pytest.mark.parametrize("changes", [{"mean": 0.11}, {"spread": 0.36}])
def test_engines_that_differ_beyond_both_limits_are_no_answer(changes):
    check = questions.sampler(CONVERGED, replace(AGREED, **changes))
    assert check.failed
    assert check.advice == (SampleAgain("two computations of the posterior differ"),)


@pytest.mark.parametrize("changes", [{"mean": 0.11, "mean_error": 0.03},
                                     {"spread": 0.07, "spread_error": 0.02},
                                     {"pareto_k": 0.71, "mean": 9.0}])  # fmt: skip
def test_a_difference_within_monte_carlo_error_or_of_bad_weights_is_none(changes):
    assert passed(questions.sampler(CONVERGED, replace(AGREED, **changes)))


def test_weighted_draws_that_nothing_confirms_are_asked_to_be_sampled():
    alone = questions.sampler(CONVERGED, None)
    assert alone.untested == "sampling by emcee"
    bad = questions.sampler(replace(CONVERGED, pareto_k=0.9), None)
    assert bad.failed
    assert {type(step) for step in (*alone.advice, *bad.advice)} == {SamplePosterior}


# --- does the plain fit agree?


def test_plain_fit_and_posterior_agree_differ_or_cannot_be_compared():
    agree = questions.plain_fit_agrees(Comparison(0.01, 0.0, 0.4), SOUND)
    differ = questions.plain_fit_agrees(Comparison(-0.1, 0.0, 3.0), SOUND)
    assert (passed(agree), differ.failed) == (True, True)
    assert "slope differs by -10.0%" in differ.evidence
    assert isinstance(differ.advice[0], TryLaws)
    assert questions.plain_fit_agrees(None, SOUND).untested == "repeatability (one run)"


# --- does the curve go through the points?


def groups(share=0.001, p=0.5):
    two = np.array([0.1, 0.2])
    return GroupResiduals(5 + 0 * two, two, two, two, share, p, 20.0)


@pytest.mark.parametrize(
    ("found", "failed"), [((0.001, 1e-9), False), ((0.3, 0.01), False), ((0.02, 1e-4), True)]
)
def test_a_misfit_must_be_both_large_and_beyond_chance(found, failed):
    check = questions.points(groups(*found), [CHANCE, HARMLESS], SOUND)
    assert check.failed == failed
    (finding,) = questions.misfit(groups(*found), SOUND)
    assert (finding.real, finding.causes) == (failed, (Cause.LAW,))


def test_a_real_finding_is_told_with_the_points_and_too_few_points_cannot_tell():
    check = questions.points(groups(), [REAL], SOUND)
    assert check.failed
    assert check.evidence.endswith("frictions differ")
    assert check.advice == (ADVICE,)
    assert questions.points(None, [], SOUND).untested == "shape of the curve"
    assert questions.misfit(None, SOUND) == []


# --- findings


def test_real_findings_are_told_with_chance_and_effect_and_others_only_beside_a_yes():
    no = questions.of_findings(Question.REPEAT, [CHANCE, REAL, HARMLESS], "sound")
    assert no.failed
    assert no.evidence == "frictions differ (p = 1e-09; slope 0.0%, force 3.0% of the peak)"
    yes = questions.of_findings(Question.REPEAT, [CHANCE], "sound", ["a note"])
    assert passed(yes)
    assert yes.evidence.startswith("sound; least likely by chance: zeros differ (p = 0.2")
    assert yes.evidence.endswith("; a note")


# --- do runs repeat?


def without(blocks, runs):
    return blocks.select_runs(~np.isin(np.arange(blocks.n_runs), runs))


def test_set_points_measured_twice_are_repeated_and_others_are_not():
    twice = blocks_at(SLIPS, loads=(6.0,))
    assert questions.repeated_share(twice) == 1.0
    assert questions.repeated_share(without(twice, np.arange(8))) == 0.0
    assert questions.repeated_share(without(twice, np.arange(4))) == pytest.approx(8 / 12)


def test_the_same_slip_at_another_load_is_no_repeat():
    blocks = without(blocks_at(SLIPS, loads=(6.0, 12.0)), np.r_[0:8, 16:24])
    assert questions.repeated_share(blocks) == 0.0


@pytest.mark.parametrize(("shift", "share"), [(0.0, 1.0), (0.2, 1.0), (0.5, 0.0)])
def test_sweeps_repeat_one_another_where_their_ranges_overlap_by_half(shift, share):
    blocks = blocks_at(np.array([0.1]), loads=(6.0,), per_run=50)
    sweep = np.linspace(0.0, 0.6, 50)
    blocks = replace(blocks, slip=np.append(sweep, sweep + shift))
    assert questions.repeated_share(blocks) == share


@pytest.mark.parametrize(("kept", "why"), [
    (np.arange(8), "no set-point twice"), ([0], "one run"), ([0, 8], "two runs"),
    ([0, 8, 1], "three runs"),
])  # fmt: skip
def test_what_was_measured_once_does_not_show_whether_runs_repeat(kept, why):
    blocks = blocks_at(SLIPS, loads=(6.0,))
    blocks = blocks.select_runs(np.isin(np.arange(blocks.n_runs), kept))
    check = questions.repeat([CHANCE], blocks)
    assert check.untested == f"repeatability ({why})"
    assert check.advice == (MeasureAlso("no set-point was measured twice", repeats=2),)
    assert questions.repeat([REAL], blocks).failed
    assert passed(questions.repeat([CHANCE], blocks_at(SLIPS, loads=(6.0,))))


# --- are rise and peak measured?

PEAK = float(LAW.peak_slip(6.0, RIG_VALUES))
THIN = {
    "the peak (slip ends before it)": (two_sided(0.8 * PEAK), {}, "beyond_the_peak"),
    "the rise (too few slips)": (blocks_at(np.linspace(0.09, 1.0, 6)), {}, "on_the_rise"),
    "other loads": (two_sided(0.4, loads=(6.0,)), {}, "other_loads"),
    "stiffness (not measured)": (two_sided(0.4), {"slip_stiffness": 0.3}, "on_the_rise"),
}


@pytest.mark.parametrize("untested", THIN)
def test_what_of_a_curve_was_not_measured_is_named_with_what_to_measure(untested):
    blocks, contraction, advice = THIN[untested]
    found = reach_of(blocks, LAW, draws(RIG_VALUES), contraction)
    check = questions.reach(found)
    assert (check.untested, check.advice) == (untested, (getattr(found, advice),))


def test_a_curve_that_was_measured_whole_is_a_yes():
    assert passed(questions.reach(reach_of(two_sided(0.4), LAW, draws(RIG_VALUES), {})))


# --- is the slip plausible?


def test_slip_of_one_sign_does_not_tell_its_zero_unless_something_is_found():
    blocks = blocks_at(SLIPS)
    assert not questions.is_two_sided(blocks)
    assert questions.is_two_sided(SOUND)
    check = questions.slip([CHANCE], blocks, told=False)
    assert check.untested == "the zero of slip and force (slip of one sign)"
    assert isinstance(check.advice[0], MeasureSlips)
    assert max(check.advice[0].slips) < 0
    assert questions.slip([REAL], blocks, told=False).failed
    assert passed(questions.slip([CHANCE], SOUND, told=True))
