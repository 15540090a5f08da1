# SPDX-License-Identifier: MIT
"""Verdict on a fit: eight questions, what is likely wrong, and what to do next."""

from collections.abc import Mapping
from dataclasses import dataclass
from enum import StrEnum

import numpy as np

from model.arrays import Array
from model.bayes.advice import Advice
from model.bayes.checks import questions
from model.bayes.checks.between_runs import scatter_between_runs
from model.bayes.checks.causes import Finding, Question, likely, named
from model.bayes.checks.check import Check, Outcome
from model.bayes.checks.comparison import compare_plain
from model.bayes.checks.linear import linearise
from model.bayes.checks.points import group_residuals
from model.bayes.checks.reach import reach_of, weak_parameters
from model.bayes.checks.samples import sample_findings
from model.bayes.checks.terms import find, suspects
from model.bayes.drawing.convergence import Convergence
from model.bayes.estimate import Agreement
from model.bayes.fit import PreparedFit
from model.slip.samples import SlipSamples


class State(StrEnum):
    """The verdict in up to three words, from the best to the worst."""

    TRUSTWORTHY = "trustworthy"
    AS_TESTED = "not fully tested"
    NOT_TRUSTWORTHY = "not trustworthy"


MEANINGS = {
    State.TRUSTWORTHY: "use the curve, with its intervals, within the tested slips and loads",
    State.AS_TESTED: "use the curve where what is untested does not matter to you",
    State.NOT_TRUSTWORTHY: "do not use the curve",
}
"""What each state means for the person who asks."""


@dataclass(frozen=True)
class Verdict:
    """Answers to the eight questions about a fit, and what follows from them.

    Attributes:
        checks: The questions, answered.
        weak: Names of parameters that the data hardly tell.
        found: What is likely wrong with the data, the likeliest first; empty where nothing is.
        notes: What is told beside it, and spoils nothing.
        converged: Whether the sampler converged.
    """

    checks: tuple[Check, ...]
    weak: tuple[str, ...] = ()
    found: tuple[Finding, ...] = ()
    notes: tuple[str, ...] = ()
    converged: bool = True

    @property
    def state(self) -> State:
        """The verdict: that of the worst answer."""
        if any(check.failed for check in self.checks):
            return State.NOT_TRUSTWORTHY
        return State.AS_TESTED if self.untested else State.TRUSTWORTHY

    @property
    def trustworthy(self) -> bool:
        """Whether every question could be answered, and every answer is yes."""
        return self.state is State.TRUSTWORTHY

    @property
    def doubtful(self) -> bool:
        """Whether an answer is no."""
        return self.state is State.NOT_TRUSTWORTHY

    @property
    def untested(self) -> tuple[str, ...]:
        """What these data cannot tell, without repetition."""
        return tuple(dict.fromkeys(each.untested for each in self.checks if each.untested))

    @property
    def causes(self) -> tuple[str, ...]:
        """What is likely wrong, one or two of the closed list `Cause`; empty where nothing is."""
        return tuple(str(cause) for cause in named(self.found)) if self.doubtful else ()

    def headline(self) -> str:
        """Format the verdict as one line of text."""
        if not self.converged:
            return f"{self.state}: the sampler did not converge"
        if self.causes:
            reason = f"likely wrong: {' or '.join(self.causes)} ({self.found[0].text})"
        elif self.doubtful:
            failed = [check.name for check in self.checks if check.failed]
            reason = f"no cause stands out; {' '.join(failed)} No."
        elif self.untested:
            reason = f"untested: {', '.join(self.untested)}"
        else:
            return str(self.state)
        return f"{self.state}; {reason}"

    def next_steps(self) -> tuple[Advice, ...]:
        """List what to do, without repetition: for what is likely wrong, else for each question."""
        if self.causes:
            sampler = [a for c in self.checks if c.name == Question.SAMPLER for a in c.advice]
            return tuple(dict.fromkeys([*sampler, *(each.advice for each in self.found[:2])]))
        asked = [check for check in self.checks if check.outcome is not Outcome.PASSED]
        failed = [check for check in asked if check.failed] or asked
        return tuple(dict.fromkeys(advice for check in failed for advice in check.advice))


def judge(
    fit: PreparedFit,
    samples: SlipSamples,
    *,
    z: Array,
    contraction: Mapping[str, float],
    convergence: Convergence,
    agreement: Agreement | None,
) -> Verdict:
    """Answer the eight questions about a fit.

    Args:
        fit: The fit.
        samples: The samples that were fitted.
        z: Posterior draws of its coordinates, shape (w, d).
        contraction: 1 - posterior variance over prior variance of each sampled parameter, by
            name [-].
        convergence: Convergence diagnostics of the draws.
        agreement: Comparison of the sampler with importance sampling; None where the posterior was
            not sampled.

    Raises:
        LinAlgError: The covariance of a run's blocks is singular.
    """
    posterior = fit.posterior
    blocks, law, values = posterior.blocks, posterior.law, posterior.values(z)
    stability = fit.load_cell.zero_stability
    linear = linearise(posterior, z, zero_stability=stability)
    groups = group_residuals(linear)
    of_samples, notes = sample_findings(posterior, linear, samples, fit.plain)
    timed = samples.time is not None
    terms, without = find(linear, suspects(linear, block_columns(fit, samples), timed=timed))
    left = groups if without is linear else group_residuals(without)
    findings = [
        *of_samples,
        *terms,
        *scatter_between_runs(linear, stability),
        *questions.misfit(left, blocks),
    ]
    of = questions.by_question(findings)
    compared = compare_plain(posterior, linear, fit.plain, np.random.default_rng(0))
    two_sided = questions.is_two_sided(blocks)
    checks = (
        questions.sampler(convergence, agreement),
        questions.plain_fit_agrees(compared, blocks),
        questions.points(groups, of[Question.POINTS], blocks),
        questions.repeat(of[Question.REPEAT], blocks),
        questions.reach(reach_of(blocks, law, values, contraction)),
        questions.of_findings(
            Question.RAW, of[Question.RAW], "no outliers, limits, frozen values or lags", notes
        ),
        questions.slip(of[Question.SLIP], blocks, told=two_sided),
        questions.of_findings(Question.UNITS, of[Question.UNITS], "values lie within their priors"),
    )
    weak = weak_parameters(blocks, law, values, contraction)
    return Verdict(checks, weak, likely(findings), tuple(notes), convergence.converged)


def block_columns(fit: PreparedFit, samples: SlipSamples) -> dict[str, Array]:
    """Average the unused columns of the samples over the blocks of a fit, shape (n,) each."""
    count = fit.posterior.blocks.count
    starts = np.cumsum(count) - count
    return {
        name: np.add.reduceat(values, starts) / count for name, values in samples.others.items()
    }
