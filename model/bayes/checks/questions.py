# SPDX-License-Identifier: MIT
"""The eight questions about a fit, each answered by one number and its limit."""

from collections.abc import Mapping, Sequence
from typing import Final

import numpy as np

from model.bayes.advice import (
    Advice,
    MeasureAlso,
    SampleAgain,
    SampleLonger,
    SamplePosterior,
    TryLaws,
    measure_slips,
)
from model.bayes.averaging.blocks import SlipBlocks
from model.bayes.averaging.load_levels import load_levels, nearest_level
from model.bayes.checks.causes import FORCE, LEAST_P, Cause, Effect, Finding, Question
from model.bayes.checks.check import Check, Outcome, decided, not_testable
from model.bayes.checks.comparison import LIMITS, Comparison
from model.bayes.checks.points import GroupResiduals
from model.bayes.checks.reach import Reach
from model.bayes.drawing.convergence import MAX_PARETO_K, Convergence
from model.bayes.estimate import ERRORS, MAX_MEAN, MAX_SPREAD, Agreement

MIDDLE: Final = (0.1, 0.9)
"""Quantiles between which most slips of a run lie."""
SAME: Final = 0.02
"""Width over slip, within which two set-points are the same [-]."""
MIN_REPEATED: Final = 0.25
"""Least share of the runs whose slip and load another run has too [-]."""
FEWEST_RUNS: Final = 4
MAX_RISE_GAP: Final = 0.5
"""Largest gap of tested slips on the rise, over the slip of the peak [-]."""
ONE_SIDED: Final = 0.1
"""Share of the larger side's slip that the smaller reaches, from which there are two sides [-]."""


def sampler(convergence: Convergence, agreement: Agreement | None) -> Check:
    """Ask whether the sampler converged and importance sampling gives the same.

    Args:
        convergence: Convergence diagnostics of the draws.
        agreement: Comparison of the sampler with importance sampling; None where the posterior was
            not sampled.
    """
    failures = convergence.failures()
    if failures:
        advice = (
            SampleLonger("sample longer", 2 * convergence.moves)
            if convergence.pareto_k is None
            else SamplePosterior("the weighted draws do not suffice")
        )
        return decided(Question.SAMPLER, False, "; ".join(failures), advice)
    if agreement is None:
        return not_testable(
            Question.SAMPLER,
            f"{convergence.summary()}; weighted draws alone, not confirmed by emcee",
            SamplePosterior("the weighted draws were not confirmed"), untested="sampling by emcee",
        )  # fmt: skip
    if not agreement.comparable:
        return decided(
            Question.SAMPLER, True, f"{convergence.summary()}; importance weights, Pareto k "
            f"{agreement.pareto_k:.2f} (below {MAX_PARETO_K:g} needed), cannot confirm it",
        )  # fmt: skip
    mean_limit = max(MAX_MEAN, ERRORS * agreement.mean_error)
    spread_limit = max(MAX_SPREAD, ERRORS * agreement.spread_error)
    return decided(
        Question.SAMPLER,
        agreement.mean <= mean_limit and agreement.spread <= spread_limit,
        f"{convergence.summary()}; importance sampling differs by {agreement.mean:.2f} sd, limit "
        f"{mean_limit:.2f}, and {agreement.spread:.0%} of the sd, limit {spread_limit:.0%}",
        SampleAgain("two computations of the posterior differ"),
    )


def plain_fit_agrees(found: Comparison | None, blocks: SlipBlocks) -> Check:
    """Ask whether plain fit and posterior differ by no more than they would on data of the model.

    Args:
        found: Their comparison; None where it could not be made.
        blocks: The block means.
    """
    if found is None:
        return not_testable(
            Question.PLAIN, "one test shows no scatter of a plain fit",
            MeasureAlso("one test shows no scatter", repeats=2), untested="repeatability (one run)",
        )  # fmt: skip
    return decided(
        Question.PLAIN,
        found.agree,
        f"beyond what noise explains its slope differs by {found.slope:+.1%} and its force by "
        f"{found.force:+.1%}, {found.distance:.1f} of the 99 % ellipse; limits {LIMITS[0]:.0%} and "
        f"{LIMITS[1]:.0%} outside of it",
        law_advice("the posterior and a plain fit of the same data differ", blocks),
    )


def law_advice(reason: str, blocks: SlipBlocks) -> TryLaws:
    """Advise to try other laws, with driving and braking apart if slips have both signs.

    Args:
        reason: What was found.
        blocks: The block means.
    """
    return TryLaws(reason, both_signs=is_two_sided(blocks))


def is_two_sided(blocks: SlipBlocks) -> bool:
    """Return whether slips of the smaller side reach `ONE_SIDED` of the larger side's."""
    smaller, larger = sorted((blocks.slip.max(), -blocks.slip.min()))
    return bool(smaller > ONE_SIDED * larger)


def points(found: GroupResiduals | None, fit: Sequence[Finding], blocks: SlipBlocks) -> Check:
    """Ask whether the curve goes through the points, by load and slip.

    Args:
        found: Mean residuals by load and slip; None where the fit absorbs all.
        fit: Findings that belong to this question.
        blocks: The block means.
    """
    if found is None:
        return not_testable(
            Question.POINTS, "as many parameters as groups of points",
            MeasureAlso("points are too few", repeats=2), untested="shape of the curve",
        )  # fmt: skip
    evidence = (
        f"means by load and slip differ by {found.share:.1%} of the peak beyond chance, limit "
        f"{FORCE:.0%} where p is up to {LEAST_P:g} (p = {found.p:.2g}); furthest {found.worst()}"
    )
    holds = found.p > LEAST_P or found.share < FORCE
    real = [each for each in fit if each.real]
    if holds and not real:
        return decided(Question.POINTS, True, evidence)
    advice = [each.advice for each in real] or [law_advice("points lie beside the curve", blocks)]
    texts = "".join(f"; {each.text}" for each in real)
    return decided(Question.POINTS, False, evidence + texts, *advice)


def of_findings(
    question: Question, found: Sequence[Finding], sound: str, notes: Sequence[str] = ()
) -> Check:
    """Answer a question by its findings: no where one is real.

    Args:
        question: The question.
        found: Findings that belong to it.
        sound: What to say where there is none.
        notes: What to say beside it.
    """
    real = sorted((each for each in found if each.real), key=lambda each: -each.gain)
    if real:
        evidence = "; ".join(f"{each.text} (p = {each.p:.1g}; {each.effect})" for each in real[:3])
        return decided(question, False, evidence, *(each.advice for each in real[:2]))
    nearest = min(found, key=lambda each: each.p, default=None)
    least = (
        ""
        if nearest is None or nearest.p > 0.5
        else (f"; least likely by chance: {nearest.text} (p = {nearest.p:.2g}, {nearest.effect})")
    )
    return decided(question, True, "; ".join([sound + least, *notes]))


def repeat(found: Sequence[Finding], blocks: SlipBlocks) -> Check:
    """Ask whether runs repeat: zeros, friction, drift, and unused columns.

    Not testable for fewer than `FEWEST_RUNS`, or where under `MIN_REPEATED` of them are repeated.
    """
    share = repeated_share(blocks)
    sound = f"{share:.0%} of {blocks.n_runs} runs have the slip and load of another"
    check = of_findings(Question.REPEAT, found, f"{sound}, at least {MIN_REPEATED:.0%} needed")
    if check.failed or (blocks.n_runs >= FEWEST_RUNS and share >= MIN_REPEATED):
        return check
    number = {1: "one run", 2: "two runs", 3: "three runs"}.get(blocks.n_runs, "no set-point twice")
    return not_testable(
        Question.REPEAT, f"{sound}, {MIN_REPEATED:.0%} and {FEWEST_RUNS} runs needed",
        MeasureAlso("no set-point was measured twice", repeats=2),
        untested=f"repeatability ({number})",
    )  # fmt: skip


def repeated_share(blocks: SlipBlocks) -> float:
    """Compute the share of the runs of which another run has the slips and the load, 0 to 1 [-].

    Two runs do if they lie nearest to the same of `load_levels` and the ranges of the middle 80 %
    of their block slips, each at least `SAME` of the slip wide, overlap by half of the smaller one.
    """
    parts = np.split(np.arange(len(blocks)), blocks.run_starts()[1:-1])
    loads = np.array([max(float(np.median(blocks.normal_force[part])), 1e-9) for part in parts])
    level = nearest_level(loads, load_levels(blocks))
    low, high = np.array([np.quantile(blocks.slip[part], MIDDLE) for part in parts]).T
    least = 0.5 * SAME * np.maximum(np.maximum(np.abs(low), np.abs(high)), 1e-6)
    middle, half = 0.5 * (low + high), np.maximum(0.5 * (high - low), least)
    low, high = middle - half, middle + half
    shared = np.minimum(high[:, None], high) - np.maximum(low[:, None], low)
    smaller = np.minimum((high - low)[:, None], high - low)
    again = (shared >= 0.5 * smaller) & (level[:, None] == level)
    np.fill_diagonal(again, False)
    return float(again.any(axis=1).mean())


def reach(found: Reach) -> Check:
    """Ask whether rise and peak are measured, and at more than one load."""
    evidence = (
        f"tested slips on the rise lie up to {found.gap:.2f} of the peak's slip apart, limit "
        f"{MAX_RISE_GAP:g}; slip reaches {found.peak:.2g} times the peak's, at least 1 needed; "
        f"loads: {found.loads}"
    )
    missing: dict[str, Advice] = {}
    if found.unmeasured:
        missing[f"{' and '.join(found.unmeasured)} (not measured)"] = found.on_the_rise
    elif found.gap > MAX_RISE_GAP:
        missing["the rise (too few slips)"] = found.on_the_rise
    if found.peak < 1:
        missing["the peak (slip ends before it)"] = found.beyond_the_peak
    if found.loads == 1:
        missing["other loads"] = found.other_loads
    if not missing:
        return Check(Question.REACH, Outcome.PASSED, evidence)
    return not_testable(Question.REACH, evidence, *missing.values(), untested=", ".join(missing))


def slip(found: Sequence[Finding], blocks: SlipBlocks, *, told: bool) -> Check:
    """Ask whether the slip is plausible: where force crosses zero, and how slip is defined.

    Args:
        found: Findings that belong to this question.
        blocks: The block means.
        told: Whether slips lie on both sides of zero, or near it.
    """
    sound = "a shift of slip or force, and another definition, would show"
    check = of_findings(Question.SLIP, found, sound)
    if check.failed or told:
        return check
    low, high = float(blocks.slip.min()), float(blocks.slip.max())
    other = np.geomspace(0.1, 1.0, 8) * (-high if high > -low else -low)
    advice = measure_slips(
        "the other side of zero is missing", loads=load_levels(blocks), slips=other,
        definition=blocks.definition,
    )  # fmt: skip
    return not_testable(
        Question.SLIP,
        f"slip goes from {low:.3g} to {high:.3g}: one side does not show where force crosses zero",
        advice,
        untested="the zero of slip and force (slip of one sign)",
    )


def by_question(findings: Sequence[Finding]) -> Mapping[Question, list[Finding]]:
    """Return the findings of each question."""
    return {q: [each for each in findings if each.question is q] for q in Question}


def misfit(found: GroupResiduals | None, blocks: SlipBlocks) -> list[Finding]:
    """Return the misfit of the curve by load and slip as a finding, whose cause may be the law.

    Args:
        found: Mean residuals by load and slip; None where the fit absorbs all.
        blocks: The block means.
    """
    if found is None:
        return []
    text = f"points lie beside the curve, {found.worst()}"
    return [
        Finding(
            Question.POINTS, (Cause.LAW,), text, found.gain, found.p, Effect(0.0, found.share),
            law_advice(text, blocks), generic=True,
        )
    ]  # fmt: skip
