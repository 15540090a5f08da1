# SPDX-License-Identifier: MIT
"""Checks of the computation: convergence of the sampler, and agreement of two samplers."""

from model.bayes.advice import SampleAgain, SampleLonger, SamplePosterior
from model.bayes.checks.check import Check, Outcome, decided, not_testable
from model.bayes.drawing.convergence import MAX_PARETO_K, Convergence
from model.bayes.estimate import ERRORS, MAX_MEAN, MAX_SPREAD, Agreement

ENGINES = "two computations of the posterior agree"
MOST_ERROR = 3.0  # times the limits: with more the comparison says nothing


def convergence_checks(convergence: Convergence) -> tuple[Check, ...]:
    """Return one failed check for each unmet criterion, or one passed check."""
    advice = (
        SampleLonger("sample longer", 2 * convergence.moves)
        if convergence.pareto_k is None
        else SamplePosterior("the weighted draws do not suffice")
    )
    failures = convergence.failures()
    if failures:
        return tuple(decided("sampler", False, failure, advice) for failure in failures)
    return (decided("sampler", True, convergence.summary(), advice),)


def engines(found: Agreement | None) -> Check:
    """Check that sampler and importance sampling give the same means and spreads.

    They may differ by `MAX_MEAN` standard deviations and `MAX_SPREAD`, or by `ERRORS` Monte Carlo
    errors of the difference where that is more. Not testable where the importance weights are not
    reliable, where these errors raise a limit to more than `MOST_ERROR` times its constant, or
    where the posterior was not sampled (None).
    """
    advice = SampleAgain("two computations of the posterior differ")
    if found is None:
        return Check(
            ENGINES,
            Outcome.NOT_TESTABLE,
            "not made: the posterior was not sampled, its draws are weighted ones of an "
            "approximation",
            SamplePosterior("the weighted draws were not confirmed"),
            "second computation (posterior not sampled)",
        )
    if not found.comparable:
        return not_testable(
            ENGINES,
            f"the importance weights are not reliable, Pareto k = {found.pareto_k:.2f} is "
            f"{MAX_PARETO_K:g} or more; the posterior is far from Gaussian",
            untested="second computation (weights not reliable)",
        )
    mean_limit = max(MAX_MEAN, ERRORS * found.mean_error)
    spread_limit = max(MAX_SPREAD, ERRORS * found.spread_error)
    if mean_limit > MOST_ERROR * MAX_MEAN or spread_limit > MOST_ERROR * MAX_SPREAD:
        return not_testable(
            ENGINES,
            f"too few draws count: their Monte Carlo error is {found.mean_error:.2f} sd in means "
            f"and {found.spread_error:.0%} in spreads",
            untested="second computation (too few draws)",
        )
    return decided(
        ENGINES,
        found.mean <= mean_limit and found.spread <= spread_limit,
        f"means differ by up to {found.mean:.2f} sd, limit {mean_limit:.2f}, spreads by up to "
        f"{found.spread:.0%}, limit {spread_limit:.0%} (Pareto k = {found.pareto_k:.2f}); limits "
        f"are {ERRORS:g} Monte Carlo errors where these are above {MAX_MEAN:g} sd and "
        f"{MAX_SPREAD:.0%}",
        advice,
    )
