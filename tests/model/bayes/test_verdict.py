# SPDX-License-Identifier: MIT
"""Every check of the verdict planted once, and whole fits that must not be trusted."""

from dataclasses import replace

import numpy as np
import pytest

from model.bayes.advice import (
    ExcludeRuns,
    MeasureSlips,
    SampleLonger,
    TryLaws,
    WeighLoadCell,
    ZeroBeforeEach,
)
from model.bayes.checks.check import Outcome
from model.bayes.checks.inspection import Inspection, inspect
from model.bayes.checks.linear import linearise
from model.bayes.drawing.weighted import importance_draws
from model.bayes.fit import prepare_fit
from model.bayes.posterior import LoadCell
from model.bayes.preliminary import BlockChoice
from model.bayes.residuals import analyse_residuals
from model.bayes.verdict import State, Verdict, judge
from model.slip import Brush
from model.slip.thesis_curve import THESIS_LAW, THESIS_VALUES
from rig.slip_rig.imperfections import TYPICAL_RIG
from rig.slip_rig.sweep import SweepPlan
from support.judged_fits import (
    AGREED,
    CONVERGED,
    RIG_VALUES,
    WELL_INFORMED,
    blocks_at,
    clean,
    draws,
    failed,
    two_sided,
    verdict_on,
)
from support.linearised_fits import CHOICE, linearised
from support.simulated_sweep import simulate_sweep

TYRE_VALUES = (20.0, 1.4, 1.2, 0.2)  # its peak lies at slip 0.16
EVENLY = np.linspace(0.09, 1.0, 6)
ONE_RUN = replace(
    two_sided(0.4, loads=(6.0,), per_run=4), run=np.zeros(96, dtype=int), run_names=("a",),
    run_slip_error=np.zeros(1),
)  # fmt: skip


def test_fit_without_fault_is_trusted():
    verdict = verdict_on()
    assert verdict.trustworthy
    assert verdict.headline() == "converged and trustworthy"
    assert verdict.next_steps() == ()


CONVERGENCE_FAULTS = {
    "R-hat between ensembles is 1.020, limit 1.01": {"r_hat": np.array([1.0, 1.02])},
    "Monte Carlo error over posterior spread is 0.060": {"mcse": np.array([0.01, 0.06])},
    "bulk effective sample size is 399, at least 400 needed": {"ess_bulk": np.array([5e3, 399.0])},
    "tail effective sample size is 120, at least 400 needed": {"ess_tail": np.array([120.0, 5e3])},
    "chain length in autocorrelation times is 40, at least 50 needed": {"length": 400},
}


@pytest.mark.parametrize("evidence", CONVERGENCE_FAULTS)
def test_broken_rule_of_convergence_is_named_with_its_figure(evidence):
    verdict = verdict_on(convergence=replace(CONVERGED, **CONVERGENCE_FAULTS[evidence]))
    assert not verdict.converged
    assert not verdict.trustworthy
    assert [check.evidence.startswith(evidence) for check in failed(verdict)] == [True]
    assert verdict.headline().startswith("NOT CONVERGED")
    moves = 2 * replace(CONVERGED, **CONVERGENCE_FAULTS[evidence]).moves
    assert verdict.next_steps() == (SampleLonger("sample longer", moves),)


TRUST_FAULTS = {
    "residuals are white": ({"lag_one": 0.5}, "forces drift within runs"),
    "run means are predicted": (
        {"inside": 0.4, "inside_p": 1e-4},
        "run means scatter more than the model predicts",
    ),
    "the law fits the shape of the curve": (
        {"misfit": 0.12, "misfit_p": 1e-6},
        "forces differ from the curve in the same way",
    ),
}


@pytest.mark.parametrize("check", TRUST_FAULTS)
def test_fault_in_the_residuals_costs_the_trust_but_not_the_convergence(check):
    changes, advice = TRUST_FAULTS[check]
    verdict = verdict_on(residuals=clean(**changes))
    assert [c.name for c in failed(verdict)] == [check]
    assert verdict.converged
    assert not verdict.trustworthy
    assert "NOT TRUSTWORTHY" in verdict.headline()
    assert verdict.next_steps()[0].reason.startswith(advice)


@pytest.mark.parametrize("misfit", [0.001, 0.08])
def test_a_shape_of_which_the_limit_would_not_show_is_not_testable(misfit):
    blind = clean(misfit=misfit, misfit_p=0.02, detectable=0.12)
    verdict = verdict_on(residuals=blind)
    assert verdict.not_testable == ("the law fits the shape of the curve",)
    (check,) = [check for check in verdict.trust if check.untested]
    assert "12.0% of the peak force" in check.evidence
    found = verdict_on(residuals=replace(blind, misfit=0.2, misfit_p=1e-4))
    assert [c.name for c in failed(found)] == ["the law fits the shape of the curve"]


@pytest.mark.parametrize("changes", [{"lag_one": -0.6}, {"lag_one": 0.6, "misfit_p": 1e-4}])
def test_correlation_that_is_no_drift_is_answered_by_another_law(changes):
    (step,) = verdict_on(residuals=clean(**changes)).next_steps()
    assert isinstance(step, TryLaws)


def test_runs_that_do_not_belong_to_the_others_cost_the_trust_and_are_named():
    score = np.append(np.linspace(-0.5, 0.5, 11), -5.0)
    verdict = verdict_on(residuals=clean(run_score=score, inside_p=1.0))
    (check,) = failed(verdict)
    assert check.name == "run means are predicted"
    assert check.evidence.endswith("far from all others: l")
    assert verdict.next_steps() == (ExcludeRuns("these runs do not belong to the others", ("l",)),)


def test_run_means_that_scatter_too_little_ask_for_a_known_load_cell():
    residuals = clean(inside=1.0, inside_p=1e-3)
    (step,) = verdict_on(residuals=residuals).next_steps()
    assert isinstance(step, WeighLoadCell)


def test_correlation_is_judged_by_how_many_pairs_there_are():
    few, many = two_sided(0.4, per_run=2), two_sided(0.4, per_run=400)
    slight = clean(lag_one=0.1)
    assert not failed(verdict_on(residuals=slight, blocks=few))
    assert failed(verdict_on(residuals=slight, blocks=many))


def test_trials_of_one_block_cannot_be_correlated():
    verdict = verdict_on(blocks=two_sided(0.4, per_run=1), residuals=clean(lag_one=0.9))
    assert verdict.state is State.AS_TESTED


@pytest.mark.parametrize("changes", [{"misfit": 0.3, "misfit_p": 0.2},
                                     {"misfit": 0.01, "misfit_p": 1e-9}])  # fmt: skip
def test_misfit_must_be_both_large_and_beyond_chance(changes):
    assert verdict_on(residuals=clean(**changes)).trustworthy


def test_offsets_as_large_as_the_curve_carry_it():
    verdict = verdict_on(values=draws(RIG_VALUES, offset_spread=1.8), offset_scale=5.0)
    (check,) = failed(verdict)
    assert check.name == "zero offsets between runs are small"
    assert "standard deviation is 1.8 N" in check.evidence
    assert isinstance(verdict.next_steps()[0], ZeroBeforeEach)


def test_offsets_far_beyond_the_load_cells_stability_are_not_believed():
    small_beside_the_curve = draws(RIG_VALUES, offset_spread=0.04)
    assert verdict_on(values=small_beside_the_curve, offset_scale=0.02).trustworthy
    assert failed(verdict_on(values=small_beside_the_curve, offset_scale=0.01))


def test_slips_that_leap_over_the_rise_cost_the_trust_and_are_told_what_to_add():
    verdict = verdict_on(blocks=blocks_at(np.append(-EVENLY[::-1], EVENLY)))
    (check,) = failed(verdict)
    assert check.name == "the rise of the curve is tested"
    assert "up to 1.00 of the peak's slip apart, limit 0.5" in check.evidence
    assert verdict.headline() == (
        "converged, but NOT TRUSTWORTHY: too few slips where the curve rises"
    )
    (step,) = verdict.next_steps()
    assert isinstance(step, MeasureSlips)
    assert step.loads == (6.0, 12.0)
    assert 0 < min(step.slips) < 0.01


def test_a_model_that_misfits_is_named_before_the_slips_that_are_missing():
    verdict = verdict_on(
        blocks=blocks_at(np.append(-EVENLY[::-1], EVENLY)), residuals=clean(lag_one=0.6)
    )
    assert "the model does not describe" in verdict.headline()
    assert len(verdict.next_steps()) == 2


NOT_TESTABLE = {
    "residuals are white": {"blocks": two_sided(0.4, per_run=1)},
    "run means are predicted": {
        "blocks": blocks_at(np.array([0.4]), per_run=24, loads=(6.0,)),
        "residuals": clean(inside=0.0, inside_p=0.0100001),
    },
    "the law fits the shape of the curve": {"residuals": clean(misfit=0.0, misfit_p=float("nan"))},
    "the rise of the curve is tested": {"law": Brush(), "values": draws((20.0, 0.38))},
    "the peak lies within the tested slips": {"blocks": two_sided(0.045)},
    "dependence on load is tested": {"blocks": two_sided(0.4, loads=(6.0, 6.0))},
    "two computations of the posterior agree": {"agreement": replace(AGREED, pareto_k=0.71)},
    "zero offsets between runs are small": {"blocks": ONE_RUN},
}


@pytest.mark.parametrize("name", NOT_TESTABLE)
def test_what_the_data_cannot_test_neither_passes_nor_fails_and_is_named(name):
    verdict = verdict_on(**NOT_TESTABLE[name])
    (check,) = [check for check in verdict.trust if check.name == name]
    assert check.outcome is Outcome.NOT_TESTABLE
    assert (check.passed, check.failed) == (False, False)
    assert check.evidence.startswith("not testable with these data: ")
    assert name in verdict.not_testable
    assert check.untested in verdict.headline().split("; untested: ")[1]
    assert not verdict.trustworthy
    assert check.advice is None or check.advice in verdict.next_steps()


def test_what_was_not_tested_costs_the_plain_headline_and_no_more():
    verdict = verdict_on(blocks=ONE_RUN, residuals=clean(inside=1.0, misfit_p=float("nan")))
    assert verdict.state is State.AS_TESTED
    assert not verdict.doubtful
    assert verdict.headline().startswith("converged and trustworthy as far as tested; untested: ")
    assert verdict.untested.count("repeatability (one run)") == 1
    assert "dependence on load (one load: it is the prior's)" in verdict.untested


def test_three_runs_are_enough_to_test_whether_run_means_are_predicted():
    blocks = blocks_at(np.array([0.01, 0.03, 0.9]), per_run=16)
    verdict = verdict_on(blocks=blocks, residuals=clean(inside=0.0, inside_p=1e-3))
    assert "run means are predicted" in [check.name for check in failed(verdict)]


def test_causes_are_named_only_where_a_check_failed_and_faults_before_terms():
    posterior, fit, samples = linearised(
        lambda s: replace(
            s,
            slip=s.slip - 0.004 * (1 - s.slip),
            traction_force=s.traction_force + 4 * (np.arange(len(s)) % 97 == 50),
        )
    )
    found = inspect(posterior, fit, samples, CHOICE)
    headline = verdict_on(inspection=found).headline()
    assert "; probable cause: outliers: " in headline
    assert "or true slip is larger by +0.00" in headline
    assert headline.index("outliers") < headline.index("true slip")
    assert verdict_on(inspection=Inspection((), found.suspected)).causes == ()


def test_a_fit_that_has_not_converged_says_nothing_else():
    bad = replace(CONVERGED, length=400)
    verdict = verdict_on(convergence=bad, **NOT_TESTABLE["the rise of the curve is tested"])
    assert verdict.headline() == "NOT CONVERGED: do not use these numbers"


def test_sweep_that_stops_soon_after_the_peak_names_shape_and_friction_weak():
    blocks = two_sided(0.3, loads=(1500.0, 2500.0))
    verdict = verdict_on(blocks=blocks, values=draws(TYRE_VALUES),
                         offset_scale=10.0)  # fmt: skip
    assert set(verdict.weak) == {"shape", "friction"}
    assert "cannot be separated" in verdict.weak["shape"].reason
    assert "peak force and initial slope" in verdict.weak["friction"].reason
    assert verdict.trustworthy
    assert verdict.headline().endswith("weakly identified: shape, friction")
    assert len(verdict.next_steps()) == 1, "one reason is said once"


def test_parameter_that_stays_as_wide_as_its_prior_is_weak():
    verdict = verdict_on(contraction=WELL_INFORMED | {"curvature": 0.3})
    assert list(verdict.weak) == ["curvature"]
    assert "variance by 30%" in verdict.weak["curvature"].reason


def test_contraction_below_zero_reads_as_none():
    verdict = verdict_on(contraction=WELL_INFORMED | {"shape": -0.04})
    assert "variance by 0%" in verdict.weak["shape"].reason


def test_law_without_a_shape_factor_needs_no_reach():
    verdict = verdict_on(law=Brush(), values=draws((20.0, 0.38)), blocks=two_sided(0.1))
    assert verdict.weak == {}


def test_failed_fit_keeps_its_weak_parameters_in_the_headline():
    verdict = verdict_on(
        residuals=clean(misfit=0.2, misfit_p=1e-9),
        contraction=WELL_INFORMED | {"shape": 0.1},
    )
    assert "NOT TRUSTWORTHY" in verdict.headline()
    assert verdict.headline().endswith("weakly identified: shape")


# Whole fits of simulated sweeps; the sampler's evidence is taken as good.


def verdict_on_sweep(*, offset_sd: float, zero_stability: float, seed: int = 1) -> Verdict:
    """Fit a simulated sweep of one set-point a run by the second engine and judge it."""
    rng = np.random.default_rng(seed)
    plan = SweepPlan(slips=tuple(np.linspace(0.005, 0.9, 14) ** 1.5), loads=(4.0, 12.0), rate=100.0)
    rig = replace(TYPICAL_RIG, offset_sd=offset_sd)
    sweep = simulate_sweep(THESIS_LAW, THESIS_VALUES, plan=plan, imperfections=rig, rng=rng)
    fit = prepare_fit(
        sweep.samples, THESIS_LAW, load_cell=LoadCell(zero_stability=zero_stability), rng=rng,
        block_choice=BlockChoice(20, None, "as planned"),
    )  # fmt: skip
    weighted = importance_draws(fit.posterior.log_density, fit.approximation, n=1000, rng=rng)
    z = weighted.resample(400, rng=rng)
    values = fit.posterior.values(z)
    names = [parameter.name for parameter in fit.posterior.free]
    return judge(
        blocks=fit.posterior.blocks,
        law=THESIS_LAW,
        values=values,
        contraction=dict(zip(names, 1 - z.var(axis=0), strict=True)),
        convergence=CONVERGED,
        agreement=AGREED,
        inspection=inspect(
            fit.posterior,
            linearise(fit.posterior, z),
            sweep.samples,
            fit.block_choice,
        ),
        residuals=analyse_residuals(fit.posterior.blocks, THESIS_LAW, values),
        offset_scale=zero_stability,
    )


def test_typical_rig_is_trusted_as_far_as_it_was_tested():
    verdict = verdict_on_sweep(offset_sd=0.05, zero_stability=0.1)
    assert verdict.state is State.AS_TESTED, failed(verdict)
    assert "shape" not in verdict.weak


@pytest.mark.parametrize("zero_stability", [5.0, 0.1])
def test_offsets_that_swallow_the_curve_are_found_under_any_prior(zero_stability):
    verdict = verdict_on_sweep(offset_sd=1.5, zero_stability=zero_stability)
    assert not verdict.trustworthy
    assert any(isinstance(step, ZeroBeforeEach) for step in verdict.next_steps())
