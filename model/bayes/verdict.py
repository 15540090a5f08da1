# SPDX-License-Identifier: MIT
"""Verdict on a fit: whether it converged, whether it can be trusted, and what to do next."""

from collections.abc import Mapping
from dataclasses import dataclass

import numpy as np

from model.bayes.advice import (
    Advice,
    ExcludeRuns,
    SampleLonger,
    TryLaws,
    WeighLoadCell,
    ZeroBeforeEach,
    beyond_the_peak,
    measure_slips,
    try_laws,
)
from model.bayes.blocks import SlipBlocks
from model.bayes.convergence import Convergence
from model.bayes.likelihood import predict_blocks
from model.bayes.residuals import MISFIT_P, Residuals, far_runs, largest_slips, load_levels
from model.bayes.rise import sampled_rise
from model.slip.law import Array, SlipLaw

RISE = "the rise of the curve is tested"  # name of a check of the data, not of the model
MAX_LAG_ONE = 0.05  # lag-1 correlation of whitened residuals
INSIDE = 0.9  # expected share of run means inside their intervals
MOST_NAMED = 3  # runs that evidence names
MIN_P = 0.01  # p-value of the share of run means inside their intervals
FEWEST_RUNS = 3  # with fewer, none of them inside has a p-value of 0.01 or more
MAX_MISFIT = 0.05  # of the peak force
MAX_OFFSET_SHARE = 0.2  # of the force variance, explained by run offsets
MAX_OFFSET_RATIO = 3.0  # a half-normal exceeds three scales once in 370
MIN_CONTRACTION = 0.75  # the posterior half as wide as the prior
MAX_RISE_GAP = 0.5  # of the peak's slip: three slips at least, and two of them before the peak
MIN_REACH = 2.5  # peak slips: where the curve has fallen clearly behind its peak


@dataclass(frozen=True)
class Check:
    """One check of a fit.

    Attributes:
        name: Claim that is checked, as text.
        passed: Whether the claim holds; None if these data cannot test it.
        evidence: Measured value and its limit, or why these data cannot test the claim, as text.
        advice: What to do when the claim does not hold; None for what cannot be tested.
    """

    name: str
    passed: bool | None
    evidence: str
    advice: Advice | None = None

    @property
    def failed(self) -> bool:
        """Whether the claim was tested and does not hold."""
        return self.passed is not None and not self.passed


@dataclass(frozen=True)
class Verdict:
    """Result of all checks of a fit.

    Attributes:
        convergence: Checks of the sampler's convergence.
        trust: Checks of the model against the data, and of what the data show of the curve.
        weak: Reason and advice for each weakly identified parameter, by the parameter's name.
    """

    convergence: tuple[Check, ...]
    trust: tuple[Check, ...]
    weak: Mapping[str, Advice]

    @property
    def converged(self) -> bool:
        """Whether no check of the sampler's convergence failed."""
        return not any(check.failed for check in self.convergence)

    @property
    def trustworthy(self) -> bool:
        """Whether no check failed, of convergence and of the model; see also `not_testable`."""
        return self.converged and not any(check.failed for check in self.trust)

    @property
    def not_testable(self) -> tuple[str, ...]:
        """Claims that these data cannot test, which neither passed nor failed."""
        return tuple(check.name for check in self.trust if check.passed is None)

    def headline(self) -> str:
        """Format the verdict as one line of text.

        Unless unconverged it names the claims that are not testable, and the weak parameters.
        """
        if not self.converged:
            return "NOT CONVERGED: do not use these numbers"
        failed = [check.name for check in self.trust if check.failed]
        result = "converged and trustworthy"
        if failed == [RISE]:
            result = "converged, but NOT TRUSTWORTHY: too few slips where the curve rises"
        elif failed:
            result = "converged, but NOT TRUSTWORTHY: the model does not describe these data"
        if self.not_testable:
            result += f"; not testable with these data: {', '.join(self.not_testable)}"
        return result + (f"; weakly identified: {', '.join(self.weak)}" if self.weak else "")

    def next_steps(self) -> tuple[Advice, ...]:
        """List the advice of failed checks, then that of `weak`, without repetition."""
        checks = (*self.convergence, *self.trust)
        failed = [check.advice for check in checks if check.failed and check.advice]
        return tuple(dict.fromkeys([*failed, *self.weak.values()]))


def judge(
    *,
    blocks: SlipBlocks,
    law: SlipLaw,
    values: Array,
    contraction: Mapping[str, float],
    convergence: Convergence,
    residuals: Residuals,
    offset_scale: float,
) -> Verdict:
    """Check convergence, offsets, run means, residuals, curve shape, slips and identification.

    Args:
        blocks: The block means.
        law: The slip law, of k parameters.
        values: Posterior draws of law and measurement parameters, shape (w, k + 8).
        contraction: 1 - posterior variance over prior variance of each sampled parameter, by
            name [-].
        convergence: Convergence diagnostics of the sampler.
        residuals: Analysis of the residuals.
        offset_scale: Scale of the prior on the run offsets' spread [N].
    """
    return Verdict(
        convergence=_convergence_checks(convergence),
        trust=(
            _offsets(blocks, law, values, offset_scale),
            _run_means(residuals, blocks),
            _whiteness(residuals, blocks, law),
            _shape(residuals, values, law, blocks),
            _rise(blocks, law, values),
        ),
        weak=_weak(blocks, law, values, contraction),
    )


def _not_testable(name: str, why: str) -> Check:
    return Check(name, None, f"not testable with these data: {why}")


def _convergence_checks(convergence: Convergence) -> tuple[Check, ...]:
    """Return one failed check for each unmet criterion, or one passed check."""
    advice = SampleLonger("sample longer", 2 * convergence.moves)
    failures = convergence.failures()
    if failures:
        return tuple(Check("sampler", False, failure, advice) for failure in failures)
    return (Check("sampler", True, convergence.summary(), advice),)


def _whiteness(residuals: Residuals, blocks: SlipBlocks, law: SlipLaw) -> Check:
    """Check that whitened residuals of successive blocks are hardly correlated.

    The limit is `MAX_LAG_ONE`, or more for few blocks; not testable if no run has two blocks.
    """
    name = "residuals are white"
    pairs = len(blocks) - blocks.n_runs
    if pairs == 0:
        return _not_testable(name, "no run has two blocks; a shorter block length would make them")
    limit = lag_one_limit(pairs)
    return Check(
        name,
        abs(residuals.lag_one) < limit,
        f"lag-1 correlation of whitened residuals {residuals.lag_one:+.3f}, limit {limit:.2f}",
        _whiteness_advice(residuals, blocks, law),
    )


def _whiteness_advice(residuals: Residuals, blocks: SlipBlocks, law: SlipLaw) -> Advice:
    """Choose between another law and shorter runs: drift neither alternates nor repeats by slip."""
    if residuals.lag_one < 0 or residuals.misfit_p < MISFIT_P:
        return _law_advice(blocks, law)
    return ZeroBeforeEach("forces drift within runs, so that intervals are too narrow")


def _law_advice(blocks: SlipBlocks, law: SlipLaw) -> TryLaws:
    """Advise another law; slips of both signs, beyond noise about zero, may need one each."""
    smaller = min(blocks.slip.max(), -blocks.slip.min())
    return try_laws(
        "forces differ from the curve in the same way in all runs", law.name,
        both_signs=bool(smaller > 0.1 * np.abs(blocks.slip).max()),
    )  # fmt: skip


def lag_one_limit(pairs: int) -> float:
    """Return the largest lag-1 correlation of a good fit: `MAX_LAG_ONE`, or more for few pairs [-].

    White noise exceeds it once in 100.
    """
    return float(max(MAX_LAG_ONE, 2.6 / np.sqrt(pairs)))


def _run_means(residuals: Residuals, blocks: SlipBlocks) -> Check:
    """Check that about 90 % of run means lie inside their predictive 90 % intervals.

    Passed if the two-sided binomial p-value is above `MIN_P`: more may fail it as well as fewer.
    Not testable with so few runs that none inside is no rarer than that.
    """
    name = "run means are predicted"
    if blocks.n_runs < FEWEST_RUNS:
        return _not_testable(name, f"runs: {blocks.n_runs}; expected {FEWEST_RUNS} or more")
    far = [blocks.run_names[run] for run in far_runs(residuals.run_score)]
    strange = f"; far from all others: {', '.join(far[:MOST_NAMED])}" if far else ""
    more = f" and {len(far) - MOST_NAMED} more" if len(far) > MOST_NAMED else ""
    return Check(
        name,
        residuals.inside_p > MIN_P and not far,
        f"{residuals.inside:.0%} of {blocks.n_runs} run means inside their 90 % interval "
        f"(p = {residuals.inside_p:.2g}, expected above {MIN_P:g}){strange}{more}",
        _run_advice(residuals, far),
    )


def _run_advice(residuals: Residuals, far: list[str]) -> Advice:
    """Choose what to do about run means: leave runs out, measure again, or state the load cell."""
    if far:
        return ExcludeRuns("these runs do not belong to the others", tuple(far))
    if residuals.inside < INSIDE:
        return ZeroBeforeEach("run means scatter more than the model predicts")
    return WeighLoadCell(
        "run means scatter less than the model predicts, so that intervals are too wide"
    )


def _shape(residuals: Residuals, values: Array, law: SlipLaw, blocks: SlipBlocks) -> Check:
    """Check that the misfit that all runs share is small or not significant, at each load too.

    It fails above `MAX_MISFIT` of the peak force at its load with a p-value below `MISFIT_P`. Not
    testable if no two runs share a slip and load, or too few do for a misfit of that size to show.
    """
    name = "the law fits the shape of the curve"
    if np.isnan(residuals.misfit_p):
        return _not_testable(name, "no two runs share a slip and load; repeat runs")
    failed = residuals.misfit > MAX_MISFIT and residuals.misfit_p < MISFIT_P
    if not failed and residuals.detectable > MAX_MISFIT:
        return _not_testable(
            name,
            "runs scatter so much, or so few share a slip and load, that a misfit of "
            f"{residuals.detectable:.1%} of the peak force or less is not told from chance, limit "
            f"{MAX_MISFIT:.0%}; repeat runs",
        )
    return Check(
        name,
        not failed,
        f"the misfit that all runs share is {residuals.misfit:.1%} of the peak force, limit "
        f"{MAX_MISFIT:.0%} where p is below {MISFIT_P:g} (p = {residuals.misfit_p:.2g})",
        _law_advice(blocks, law),
    )


def _offsets(blocks: SlipBlocks, law: SlipLaw, values: Array, scale: float) -> Check:
    """Check that run offsets explain little variance and are within three prior scales [N].

    Their share of the variance, with that of the fitted curve, is at most `MAX_OFFSET_SHARE`.
    """
    tau = float(values[:, -1].mean())
    # Also what varies within runs, as slip is swept: an offset cannot stand in for that.
    curve = float(np.std(predict_blocks(blocks, law, values).force.mean(axis=0)))
    share = tau**2 / (tau**2 + curve**2) if tau > 0 else 0.0
    return Check(
        "zero offsets between runs are small",
        share <= MAX_OFFSET_SHARE and tau <= MAX_OFFSET_RATIO * scale,
        f"they explain {share:.0%} of the force variance, limit {MAX_OFFSET_SHARE:.0%}; their "
        f"standard deviation is {tau:.3g} N, limit {MAX_OFFSET_RATIO * scale:.3g} N",
        ZeroBeforeEach("zero offsets between runs are too large to be told from the curve"),
    )


def _rise(blocks: SlipBlocks, law: SlipLaw, values: Array) -> Check:
    """Check that tested slips between zero and the peak leave no gap above `MAX_RISE_GAP`.

    Where they do, slope and peak are those of the law's shape, which nothing has tested there.
    """
    rise = sampled_rise(blocks, law, values)
    if not len(rise.further):
        return _not_testable(RISE, "the curve has no peak")
    return Check(
        RISE,
        rise.gap <= MAX_RISE_GAP,
        f"between zero and the peak tested slips lie up to {rise.gap:.2f} of the peak's slip apart"
        f", limit {MAX_RISE_GAP:g}",
        measure_slips(
            "slips between zero and the peak are missing", loads=rise.loads, slips=rise.further,
            definition=blocks.definition,
        ),
    )  # fmt: skip


def _weak(
    blocks: SlipBlocks, law: SlipLaw, values: Array, contraction: Mapping[str, float]
) -> dict[str, Advice]:
    """Return the law's weakly identified parameters by name, with reason and advice.

    Weak are sampled parameters with a contraction below `MIN_CONTRACTION` and, of a law with a
    shape factor, shape and friction if `slip_reach` is below `MIN_REACH`.
    """
    names = [parameter.name for parameter in law.parameters]
    weak: dict[str, Advice] = {
        name: Advice(
            f"{name}: data reduce its prior variance by {max(contraction[name], 0):.0%}, not by "
            f"{MIN_CONTRACTION:.0%}; use F_max and BCD, peak force and initial slope, instead"
        )
        for name in names
        if contraction.get(name, 1.0) < MIN_CONTRACTION
    }
    reach = slip_reach(blocks, law, values)
    if "shape" in names and reach < MIN_REACH:
        reason = (
            f"shape C and peak factor D cannot be separated: slip ends at {reach:.1f} times the "
            f"peak's slip (0 without a peak), {MIN_REACH:g} are needed; use F_max and BCD, peak "
            "force and initial slope, instead, or measure larger slips"
        )
        advice = measure_slips(
            reason, loads=load_levels(blocks), definition=blocks.definition,
            slips=beyond_the_peak(_peaks(blocks, law, values), blocks.slip),
        )  # fmt: skip
        weak |= {"shape": advice, "friction": advice}
    return weak


def slip_reach(blocks: SlipBlocks, law: SlipLaw, values: Array) -> float:
    """Compute the largest tested slip over the median peak slip, the largest of all loads [-].

    0 at loads where the median curve has no peak.

    Args:
        blocks: The block means.
        law: The slip law, of k parameters.
        values: Posterior draws of law and measurement parameters, shape (w, k + 8).
    """
    return float(np.max(largest_slips(blocks) / _peaks(blocks, law, values)))


def _peaks(blocks: SlipBlocks, law: SlipLaw, values: Array) -> Array:
    """Return the slip of the median curve's peak at each load level, or one for all [-]."""
    k = len(law.parameters)
    return np.median(law.peak_slip(load_levels(blocks), values[:, :k].T[:, :, None]), axis=0)
