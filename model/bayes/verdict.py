# SPDX-License-Identifier: MIT
"""Verdict on a fit: whether it converged, whether it can be trusted, and what to do next."""

from collections.abc import Mapping
from dataclasses import dataclass
from enum import StrEnum

from model.arrays import Array
from model.bayes.advice import Advice
from model.bayes.averaging.blocks import SlipBlocks
from model.bayes.checks.check import Check, Outcome
from model.bayes.checks.fit import offsets, run_means, shape, whiteness
from model.bayes.checks.inspection import TERMS, Inspection
from model.bayes.checks.reach import RISE, loads, peak, rise, weak_parameters
from model.bayes.checks.sampling import convergence_checks, engines
from model.bayes.drawing.convergence import Convergence
from model.bayes.estimate import Agreement
from model.bayes.residuals import Residuals
from model.slip.law import SlipLaw

MOST_CAUSES = 3  # that a headline names


class State(StrEnum):
    """How far a fit can be trusted, from the best to the worst."""

    TRUSTWORTHY = "trustworthy"
    AS_TESTED = "trustworthy as far as tested"
    NOT_TRUSTWORTHY = "not trustworthy"
    NOT_CONVERGED = "not converged"


@dataclass(frozen=True)
class Verdict:
    """Result of all checks of a fit.

    Attributes:
        convergence: Checks of the sampler's convergence.
        trust: Checks of the model against the data, and of what the data show of the curve.
        weak: Reason and advice for each weakly identified parameter, by the parameter's name.
        suspected: What may be wrong with the data, the most likely first; more than one where
            these cannot be told apart.
    """

    convergence: tuple[Check, ...]
    trust: tuple[Check, ...]
    weak: Mapping[str, Advice]
    suspected: tuple[str, ...] = ()

    @property
    def checks(self) -> tuple[Check, ...]:
        """All checks, those of the sampler first."""
        return (*self.convergence, *self.trust)

    @property
    def converged(self) -> bool:
        """Whether no check of the sampler's convergence failed."""
        return not any(check.failed for check in self.convergence)

    @property
    def state(self) -> State:
        """How far the fit can be trusted: the worst state that its checks give.

        Not converged if a check of convergence failed, not trustworthy if one of `trust` failed, as
        tested if one of these is not testable, else trustworthy.
        """
        if not self.converged:
            return State.NOT_CONVERGED
        if any(check.failed for check in self.trust):
            return State.NOT_TRUSTWORTHY
        return State.AS_TESTED if self.not_testable else State.TRUSTWORTHY

    @property
    def trustworthy(self) -> bool:
        """Whether every check was made and passed: `State.TRUSTWORTHY`."""
        return self.state is State.TRUSTWORTHY

    @property
    def doubtful(self) -> bool:
        """Whether a check failed, of convergence or of the model."""
        return self.state in (State.NOT_TRUSTWORTHY, State.NOT_CONVERGED)

    @property
    def not_testable(self) -> tuple[str, ...]:
        """Claims that these data cannot test, which neither passed nor failed."""
        return tuple(check.name for check in self.trust if check.outcome is Outcome.NOT_TESTABLE)

    @property
    def untested(self) -> tuple[str, ...]:
        """What the headline says of these claims, without repetition."""
        return tuple(dict.fromkeys(check.untested for check in self.trust if check.untested))

    @property
    def causes(self) -> tuple[str, ...]:
        """What is probably wrong with the data, up to `MOST_CAUSES`; empty unless `trust` failed.

        Faults of single samples and runs come first; then the terms that explain most, which may
        be two that cannot be told apart.
        """
        if not any(check.failed for check in self.trust):
            return ()
        faults = [c.cause for c in self.trust if c.cause and c.name not in TERMS]
        return tuple(dict.fromkeys([*faults, *self.suspected]))[:MOST_CAUSES]

    def headline(self) -> str:
        """Format the verdict as one line of text.

        Unless unconverged it names what is untested, and the weak parameters.
        """
        failed = [check.name for check in self.trust if check.failed]
        if self.state is State.NOT_CONVERGED:
            return "NOT CONVERGED: do not use these numbers"
        if failed == [RISE]:
            result = "converged, but NOT TRUSTWORTHY: too few slips where the curve rises"
        elif failed:
            result = "converged, but NOT TRUSTWORTHY: the model does not describe these data"
            if self.causes:
                result += f"; probable cause: {', or '.join(self.causes)}"
        else:
            result = f"converged and {self.state}"
        if self.untested:
            result += f"; untested: {', '.join(self.untested)}"
        return result + (f"; weakly identified: {', '.join(self.weak)}" if self.weak else "")

    def next_steps(self) -> tuple[Advice, ...]:
        """List the advice of failed checks, of `weak` and of untested ones, without repetition."""
        failed = [check.advice for check in self.checks if check.failed and check.advice]
        untested = [check.advice for check in self.checks if check.untested and check.advice]
        return tuple(dict.fromkeys([*failed, *self.weak.values(), *untested]))


def judge(
    *,
    blocks: SlipBlocks,
    law: SlipLaw,
    values: Array,
    contraction: Mapping[str, float],
    convergence: Convergence,
    residuals: Residuals,
    agreement: Agreement | None,
    inspection: Inspection,
    offset_scale: float,
) -> Verdict:
    """Check convergence, offsets, run means, residuals, curve, slips and what else may be wrong.

    Args:
        blocks: The block means.
        law: The slip law, of k parameters.
        values: Posterior draws of law and measurement parameters, shape (w, k + 11).
        contraction: 1 - posterior variance over prior variance of each sampled parameter, by
            name [-].
        convergence: Convergence diagnostics of the sampler.
        residuals: Analysis of the residuals.
        agreement: Comparison of the sampler with importance sampling; None where the posterior was
            not sampled.
        inspection: What was looked for in the data.
        offset_scale: Scale of the prior on the run offsets' spread [N].
    """
    return Verdict(
        convergence=convergence_checks(convergence),
        trust=(
            engines(agreement),
            offsets(blocks, law, values, offset_scale),
            run_means(residuals, blocks),
            whiteness(residuals, blocks),
            shape(residuals, blocks),
            rise(blocks, law, values),
            peak(blocks, law, values),
            loads(blocks),
            *inspection.checks,
        ),
        weak=weak_parameters(blocks, law, values, contraction),
        suspected=tuple(found.text for found in inspection.suspected),
    )
