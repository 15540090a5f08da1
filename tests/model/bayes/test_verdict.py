# SPDX-License-Identifier: MIT
"""Answers make a state, a headline and next steps; whole fits are trusted where they may be."""

from dataclasses import replace
from types import SimpleNamespace

import numpy as np
import pytest

from model.bayes.advice import Advice, ZeroBeforeEach
from model.bayes.checks.causes import Cause, Effect, Finding, Question
from model.bayes.checks.check import Check, Outcome, decided, not_testable
from model.bayes.fit import prepare_fit
from model.bayes.posterior import LoadCell
from model.bayes.preliminary import BlockChoice
from model.bayes.priors import LogNormal
from model.bayes.stated_priors import StatedPriors
from model.bayes.verdict import MEANINGS, State, Verdict, block_columns, judge
from model.slip.thesis_curve import THESIS_LAW, THESIS_VALUES
from rig.slip_rig.imperfections import TYPICAL_RIG
from rig.slip_rig.sweep import SweepPlan
from support.judged_fits import AGREED, CONVERGED, WELL_INFORMED
from support.quick_fits import few_starts
from support.simulated_sweep import simulate_sweep

YES = tuple(Check(question, Outcome.PASSED, "sound") for question in Question)
FOUND = Finding(
    Question.REPEAT, (Cause.MATERIALS,), "frictions differ", 90.0, 1e-9, Effect(0.0, 0.03),
    Advice("sort"),
)  # fmt: skip


def verdict(*changed: Check, **more) -> Verdict:
    """Return a verdict of eight yeses but for some answers."""
    other = {check.name: check for check in changed}
    return Verdict(tuple(other.get(check.name, check) for check in YES), **more)


NO = decided(Question.REPEAT, False, "p = 0", Advice("repeat"))
UNTOLD = not_testable(Question.SLIP, "one side", Advice("measure"), untested="the zero of slip")
UNSAMPLED = decided(Question.SAMPLER, False, "R-hat", Advice("longer"))

STATES = {
    "trustworthy": (verdict(), State.TRUSTWORTHY, ()),
    "not fully tested; untested: the zero of slip": (
        verdict(UNTOLD), State.AS_TESTED, ("measure",),
    ),
    "not trustworthy; no cause stands out; Do runs repeat? No.": (
        verdict(NO, UNTOLD), State.NOT_TRUSTWORTHY, ("repeat",),
    ),
    "not trustworthy; likely wrong: two materials (frictions differ)": (
        verdict(NO, UNTOLD, found=(FOUND,)), State.NOT_TRUSTWORTHY, ("sort",),
    ),
    "not trustworthy: the sampler did not converge": (
        verdict(UNSAMPLED, converged=False), State.NOT_TRUSTWORTHY, ("longer",),
    ),
    "not trustworthy; no cause stands out; Did the sampler converge? No.": (
        verdict(UNSAMPLED), State.NOT_TRUSTWORTHY, ("longer",),  # two computations differ
    ),
}  # fmt: skip


@pytest.mark.parametrize("headline", STATES)
def test_the_worst_answer_makes_the_state_and_the_headline_says_why(headline):
    given, state, steps = STATES[headline]
    assert given.headline() == headline
    assert given.state is state
    assert len(state.split()) <= 3
    assert state in MEANINGS
    assert tuple(step.reason for step in given.next_steps()) == steps
    assert (given.trustworthy, given.doubtful) == (
        state is State.TRUSTWORTHY, state is State.NOT_TRUSTWORTHY,
    )  # fmt: skip


def test_a_fit_that_did_not_converge_is_sampled_longer_first():
    steps = verdict(UNSAMPLED, NO, found=(FOUND,), converged=False).next_steps()
    assert steps[0].reason == "longer"


def test_causes_are_named_only_where_an_answer_is_no():
    assert verdict(UNTOLD, found=(FOUND,)).causes == ()
    other = replace(FOUND, causes=(Cause.COLUMN,), advice=Advice("part"))
    both = verdict(NO, found=(FOUND, other))
    assert both.causes == ("two materials", "an unused column")
    assert [step.reason for step in both.next_steps()] == ["sort", "part"]


def test_advice_and_untested_things_are_said_once():
    again = replace(UNTOLD, name=Question.PLAIN)
    assert verdict(UNTOLD, again).untested == ("the zero of slip",)
    assert verdict(UNTOLD, again).next_steps() == UNTOLD.advice


def test_an_unused_column_is_averaged_over_the_blocks():
    blocks = SimpleNamespace(count=np.array([2, 3, 1]))
    fit = SimpleNamespace(posterior=SimpleNamespace(blocks=blocks))
    samples = SimpleNamespace(others={"room": np.array([1.0, 3.0, 1.0, 2.0, 6.0, 5.0])})
    np.testing.assert_allclose(block_columns(fit, samples)["room"], [2.0, 3.0, 5.0])


# --- whole fits of simulated sweeps; the sampler's evidence is taken as good

HALF = np.geomspace(0.005, 0.5, 7)


@few_starts()
def judged(*, offset_sd=0.05, stated=StatedPriors()):  # noqa: B008
    """Fit a simulated sweep of slips on both sides, each twice, and judge it."""
    rng = np.random.default_rng(1)
    plan = SweepPlan(
        slips=(*-HALF, *HALF, *-HALF, *HALF), loads=(4.0, 12.0), rate=50.0, duration=2.0
    )
    rig = replace(TYPICAL_RIG, offset_sd=offset_sd)
    samples = simulate_sweep(
        THESIS_LAW, THESIS_VALUES, plan=plan, imperfections=rig, rng=rng
    ).samples
    fit = prepare_fit(
        samples, THESIS_LAW, load_cell=LoadCell(zero_stability=0.1), rng=rng,
        block_choice=BlockChoice(20, None, "as planned"), validate=False, stated=stated,
    )  # fmt: skip
    z = rng.multivariate_normal(fit.laplace.mode, fit.laplace.covariance, 200)
    return judge(
        fit, samples, z=z, contraction=WELL_INFORMED, convergence=CONVERGED, agreement=AGREED
    )


def test_a_sound_rig_is_trusted_and_answers_eight_questions():
    found = judged()
    assert [check.name for check in found.checks] == list(Question)
    assert found.state is not State.NOT_TRUSTWORTHY, found.headline()
    assert found.causes == found.weak == ()


def test_a_wrong_prior_of_the_stiffness_makes_the_plain_fit_disagree():
    wrong = StatedPriors({"slip_stiffness": LogNormal(0.7 * float(THESIS_VALUES[0]), 0.01)})
    found = judged(stated=wrong)
    assert Question.PLAIN in {check.name for check in found.checks if check.failed}


def test_offsets_far_beyond_the_load_cells_stability_are_not_believed():
    found = judged(offset_sd=1.5)
    assert found.causes[0] == Cause.FORCE_ZERO
    assert isinstance(found.next_steps()[0], ZeroBeforeEach)
