# SPDX-License-Identifier: MIT
"""Look for what is wrong with the data of a fit: shifts, drift, two curves, faulty samples."""

from collections.abc import Mapping
from dataclasses import dataclass, replace

import numpy as np

from model.arrays import Array
from model.bayes.advice import CorrectData
from model.bayes.averaging.load_levels import load_levels
from model.bayes.checks.check import Check, decided, not_testable
from model.bayes.checks.faults import faults
from model.bayes.checks.fit import law_advice
from model.bayes.checks.groups import groups
from model.bayes.checks.linear import Linearised
from model.bayes.checks.terms import LOAD, SIDES, TIME, ZERO, Found, Suspect, find
from model.bayes.posterior import SlipPosterior
from model.bayes.preliminary import BlockChoice
from model.slip.samples import SlipSamples

TERM_P = 5e-4  # of each of a dozen terms: less than one sound set in 200 fails
SEEN = 3.5  # standard deviations, from which a term is beyond chance
NAMED_P = 1e-2  # of a term that is named where another check has failed
RIVAL = 0.6  # of the gain of the best term, from which another cannot be told from it
CLOSE = 9.0  # or by less than this
SMALLER_SIDE = 0.1  # of the larger side's slip, from which there are two sides
PEAK_SHARE = 0.5  # of the peak's slip, which is enough too
FEWEST_RUNS = 4  # to tell drift from scatter
CROSSING = "force is zero at zero slip"
ONE_CURVE = "driving and braking follow one curve"
STEADY = "nothing changes with time"
ONE_LAW = "loads follow one curve"
TERMS = (CROSSING, ONE_CURVE, STEADY, ONE_LAW)
"""Names of the checks whose causes are ranked by what they explain."""


@dataclass(frozen=True)
class Inspection:
    """What was found in the data.

    Attributes:
        checks: The checks, failed ones with their causes.
        suspected: The term that explains most, and one that cannot be told from it if there is
            one; empty if no term explains anything.
    """

    checks: tuple[Check, ...]
    suspected: tuple[Found, ...]


def inspect(
    posterior: SlipPosterior, fit: Linearised, samples: SlipSamples, choice: BlockChoice
) -> Inspection:
    """Make the checks of what may be wrong with the data.

    Args:
        posterior: The posterior of the fit.
        fit: The fit, linearised.
        samples: The samples that were fitted.
        choice: How they became blocks, with the autocorrelation time of their residuals.
    """
    two_sided = _is_two_sided(posterior, fit)
    n_runs = fit.blocks.n_runs
    one_sided = "" if two_sided else "zero of slip and force (slip of one sign)"
    few_runs = "" if n_runs >= FEWEST_RUNS else f"repeatability ({_runs(n_runs)})"
    families: list[tuple[str, Mapping[str, Suspect], str]] = [
        (CROSSING, ZERO, one_sided), (ONE_CURVE, SIDES, one_sided), (STEADY, TIME, few_runs),
    ]  # fmt: skip
    if len(load_levels(fit.blocks)) > 1:
        families.append((ONE_LAW, LOAD, ""))
    found = [(name, find(fit, suspects), why) for name, suspects, why in families]
    suspected = _suspected([each for _, some, _ in found for each in some])
    advice = suspected[0].advice if suspected else law_advice(fit.blocks)
    checks = (
        groups(fit, advice),
        *(_family(name, some, why) for name, some, why in found),
        *faults(
            posterior,
            fit,
            samples,
            explained=_explained(fit, suspected),
            choice=choice,
        ),
    )
    return Inspection(checks, suspected)


def _runs(n: int) -> str:
    """Format a number of runs as text."""
    return {1: "one run", 2: "two runs"}.get(n, f"{n} runs")


def _is_two_sided(posterior: SlipPosterior, fit: Linearised) -> bool:
    """Return whether slips of both signs reach far enough to show where force crosses zero.

    The smaller side must reach `SMALLER_SIDE` of the larger side's slip, or `PEAK_SHARE` of the
    least peak slip if that is less.
    """
    slip = fit.blocks.slip
    k = len(posterior.law.parameters)
    smaller, larger = sorted((slip.max(), -slip.min()))
    peak = np.min(posterior.law.peak_slip(load_levels(fit.blocks), fit.values[:k]))
    return bool(smaller > 0 and smaller >= min(SMALLER_SIDE * larger, PEAK_SHARE * float(peak)))


def _family(name: str, found: list[Found], untested: str) -> Check:
    """Check that no term of a family is in the data: the least p-value is above `TERM_P`.

    If it is, the check is not testable where `untested` says so, or where a term of the size that
    does harm (`Found.matters`) would not be seen.

    Args:
        name: Claim that is checked.
        found: Terms of the family, the one that explains most first.
        untested: What these data cannot test of it, with the reason in brackets; empty where they
            can.
    """
    worst = min(found, key=lambda each: each.term.p)
    evidence = (
        f"most likely {worst.text}, p = {worst.term.p:.2g}, expected above {TERM_P:g} for each of "
        f"{len(found)} terms"
    )
    if untested and worst.term.p > TERM_P:
        why = f"{untested.split('(')[1].rstrip(')')}; {evidence}"
        return not_testable(name, why, untested=untested)
    hidden = [each for each in found if SEEN * each.term.sd > each.matters]
    if hidden and worst.term.p > TERM_P:
        return _hidden(name, hidden[0], evidence)
    check = decided(name, worst.term.p > TERM_P, evidence, worst.advice)
    return replace(check, cause=worst.text) if check.failed else check


def _hidden(name: str, found: Found, evidence: str) -> Check:
    """Return a check that cannot be made: a term of harmful size would not be seen.

    The least that would be is `SEEN` of its standard deviations, which is more than `matters`.
    """
    least = SEEN * found.term.sd
    why = (
        f"what differs by less than {2 * least:.0%} would not show beside the rolling resistance "
        f"that is allowed for; {evidence}"
    )
    advice = CorrectData(
        f"{found.name} are not told apart from rolling resistance",
        "weigh the load cell in both directions; where the discs are known to roll more freely, "
        "state rolling_resistance in [rig_errors] of columns.toml",
    )
    untested = f"{found.name} alike (a difference of {2 * least:.0%} would not show)"
    return not_testable(name, why, untested=untested, advice=advice)


def _suspected(found: list[Found]) -> tuple[Found, ...]:
    """Return the term with the largest gain, and the next if it cannot be told from it.

    Only terms with a p-value below `NAMED_P` count; the result is empty without any. The next is
    the first whose gain is above `RIVAL` of the largest, or less than `CLOSE` below it.
    """
    ranked = sorted((x for x in found if x.term.p < NAMED_P), key=lambda each: -each.gain)
    if not ranked:
        return ()
    rivals = [
        each for each in ranked[1:]
        if each.gain > RIVAL * ranked[0].gain or ranked[0].gain - each.gain < CLOSE
    ]  # fmt: skip
    return (ranked[0], *rivals[:1])


def _explained(fit: Linearised, suspected: tuple[Found, ...]) -> Array:
    """Return the force that the best term explains beside the fit, shape (n,) [N].

    Zero without a term whose p-value is below `TERM_P`.
    """
    if suspected and suspected[0].term.p < TERM_P:
        best = suspected[0]
        force = {**ZERO, **SIDES, **TIME, **LOAD}[best.name].force(fit)
        return best.term.size * fit.beyond_fit(force)
    return np.zeros(len(fit.blocks))
