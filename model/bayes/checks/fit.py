# SPDX-License-Identifier: MIT
"""Checks of the model against the data: run offsets, run means, whiteness, shape of the curve."""

import numpy as np

from model.arrays import Array
from model.bayes.advice import (
    Advice,
    ExcludeRuns,
    MeasureAlso,
    TryLaws,
    WeighLoadCell,
    ZeroBeforeEach,
)
from model.bayes.averaging.blocks import SlipBlocks
from model.bayes.checks.check import Check, decided, not_testable
from model.bayes.checks.repeats import repeated_share
from model.bayes.likelihood import predict_blocks
from model.bayes.residuals import MISFIT_P, Residuals, far_runs
from model.slip.law import SlipLaw

MAX_LAG_ONE = 0.05  # lag-1 correlation of whitened residuals
FEWEST_IN_RUN = 6  # blocks; with fewer, slow noise is not told from the offset of a run
FEWEST_PAIRS = 27  # of successive blocks: with fewer the limit is above 0.5, which any noise meets
INSIDE = 0.9  # expected share of run means inside their intervals
MOST_NAMED = 3  # runs that evidence names
MIN_P = 0.01  # p-value of the share of run means inside their intervals
FEWEST_RUNS = 3  # with fewer, none of them inside has a p-value of 0.01 or more
MAX_MISFIT = 0.05  # of the peak force
MAX_OFFSET_SHARE = 0.2  # of the force variance, explained by run offsets
MAX_OFFSET_RATIO = 3.0  # a half-normal exceeds three scales once in 370
MIN_REPEATED = 0.25  # share of the runs whose slip and load another run has too
PASSES = 2  # of each set-point, where none was repeated


def offsets(blocks: SlipBlocks, law: SlipLaw, values: Array, scale: float) -> Check:
    """Check that the posterior mean of the offsets' standard deviation is small.

    Its square is at most `MAX_OFFSET_SHARE` of the sum of that square and the variance of the
    fitted curve, and it is at most `MAX_OFFSET_RATIO` times `scale`. Not testable with one run.

    Args:
        blocks: The block means.
        law: The slip law, of k parameters.
        values: Posterior draws of law and measurement parameters, shape (w, k + 11).
        scale: Scale of the prior on the run offsets' spread [N].
    """
    name = "zero offsets between runs are small"
    if blocks.n_runs == 1:
        return _one_run(name, "there is one run; their spread is the prior's")
    tau = float(values[:, -1].mean())
    # Also what varies within runs, as slip is swept: an offset cannot stand in for that.
    curve = float(np.std(predict_blocks(blocks, law, values).force.mean(axis=0)))
    share = tau**2 / (tau**2 + curve**2) if tau > 0 else 0.0
    return decided(
        name,
        share <= MAX_OFFSET_SHARE and tau <= MAX_OFFSET_RATIO * scale,
        f"they explain {share:.0%} of the force variance, limit {MAX_OFFSET_SHARE:.0%}; their "
        f"standard deviation is {tau:.3g} N, limit {MAX_OFFSET_RATIO * scale:.3g} N",
        ZeroBeforeEach("zero offsets between runs are too large to be told from the curve"),
    )


def _one_run(name: str, why: str) -> Check:
    """Return a check that cannot be made because there is one run."""
    advice = MeasureAlso("one run does not show what repeats", repeats=PASSES)
    return not_testable(name, why, untested="repeatability (one run)", advice=advice)


def run_means(residuals: Residuals, blocks: SlipBlocks) -> Check:
    """Check that about 90 % of run means lie inside their predictive 90 % intervals.

    Passed if the two-sided binomial p-value is above `MIN_P`, which more may fail as well as fewer,
    and `far_runs` finds none. Not testable with fewer than `FEWEST_RUNS`.
    """
    name = "run means are predicted"
    why = f"runs: {blocks.n_runs}; expected {FEWEST_RUNS} or more"
    if blocks.n_runs == 1:
        return _one_run(name, why)
    if blocks.n_runs < FEWEST_RUNS:
        advice = MeasureAlso("two runs do not show how far runs scatter", repeats=PASSES)
        return not_testable(name, why, untested="repeatability (two runs)", advice=advice)
    far = [blocks.run_names[run] for run in far_runs(residuals.run_score)]
    strange = f"; far from all others: {', '.join(far[:MOST_NAMED])}" if far else ""
    more = f" and {len(far) - MOST_NAMED} more" if len(far) > MOST_NAMED else ""
    return decided(
        name,
        residuals.inside_p > MIN_P and not far,
        f"{residuals.inside:.0%} of {blocks.n_runs} run means inside their 90 % interval "
        f"(p = {residuals.inside_p:.2g}, expected above {MIN_P:g}){strange}{more}",
        _run_advice(residuals, far),
    )


def _run_advice(residuals: Residuals, far: list[str]) -> Advice:
    """Choose advice on run means: leave out runs that are `far`, if any.

    Otherwise zero before each run where fewer than `INSIDE` of them are inside their intervals, or
    weigh the load cell where more are.
    """
    if far:
        return ExcludeRuns("these runs do not belong to the others", tuple(far))
    if residuals.inside < INSIDE:
        return ZeroBeforeEach("run means scatter more than the model predicts")
    return WeighLoadCell(
        "run means scatter less than the model predicts, so that intervals are too wide"
    )


def whiteness(residuals: Residuals, blocks: SlipBlocks) -> Check:
    """Check that the absolute lag-1 correlation of whitened residuals is below `lag_one_limit`.

    Not testable with fewer than `FEWEST_PAIRS` pairs of successive blocks in the same run, nor
    where the median run has fewer than `FEWEST_IN_RUN` blocks: noise that changes slowly and the
    offset of a run are not told apart there.
    """
    name = "residuals are white"
    pairs, in_run = len(blocks) - blocks.n_runs, float(np.median(np.diff(blocks.run_starts())))
    if pairs < FEWEST_PAIRS or in_run < FEWEST_IN_RUN:
        return not_testable(
            name,
            f"pairs of successive blocks: {pairs}; expected {FEWEST_PAIRS} or more, and "
            f"{FEWEST_IN_RUN} blocks in a run, found {in_run:.0f}; longer runs, or a shorter block "
            "length, would make them",
            untested="noise in time (too short)",
            advice=MeasureAlso("runs are too short to show their noise", times=4.0),
        )
    limit = lag_one_limit(pairs)
    return decided(
        name,
        abs(residuals.lag_one) < limit,
        f"lag-1 correlation of whitened residuals {residuals.lag_one:+.3f}, limit {limit:.2f}",
        _whiteness_advice(residuals, blocks),
    )


def _whiteness_advice(residuals: Residuals, blocks: SlipBlocks) -> Advice:
    """Choose advice on correlated residuals: another law, or zeroing before each run for drift.

    Another law if the lag-1 correlation is negative or `misfit_p` below `MISFIT_P`: drift makes
    neither that correlation nor a misfit that runs share at a slip and load.
    """
    if residuals.lag_one < 0 or residuals.misfit_p < MISFIT_P:
        return law_advice(blocks)
    return ZeroBeforeEach("forces drift within runs, so that intervals are too narrow")


def law_advice(blocks: SlipBlocks) -> TryLaws:
    """Advise to try other laws, and to tell driving from braking if slips have both signs.

    Both signs: the smaller side reaches more than a tenth of the largest absolute slip.
    """
    smaller = min(blocks.slip.max(), -blocks.slip.min())
    return TryLaws(
        "forces differ from the curve in the same way in all runs",
        both_signs=bool(smaller > 0.1 * np.abs(blocks.slip).max()),
    )


def lag_one_limit(pairs: int) -> float:
    """Return the largest lag-1 correlation of a good fit [-].

    It is 2.6 over the root of the number of pairs, which white noise exceeds once in 100, but no
    less than `MAX_LAG_ONE`, which binds from 2,704 pairs on.
    """
    return float(max(MAX_LAG_ONE, 2.6 / np.sqrt(pairs)))


def shape(residuals: Residuals, blocks: SlipBlocks) -> Check:
    """Check that the misfit that all runs share is small or not significant, at each load too.

    It fails above `MAX_MISFIT` of the peak force at its load with a p-value below `MISFIT_P`. Not
    testable with one run or without two runs that share a slip and load; nor, where it does not
    fail, if a misfit of that size would not show or less than `MIN_REPEATED` of the runs are
    repeated.
    """
    name = "the law fits the shape of the curve"
    if blocks.n_runs == 1:
        return _one_run(name, "one run does not show which misfit repeats")
    again = MeasureAlso("no set-point was measured twice", repeats=PASSES)
    untested = "repeatability (no slip and load in two runs)"
    if np.isnan(residuals.misfit_p):
        why = "no two runs share a slip and load; repeat runs"
        return not_testable(name, why, untested=untested, advice=again)
    failed = residuals.misfit > MAX_MISFIT and residuals.misfit_p < MISFIT_P
    if not failed and residuals.detectable > MAX_MISFIT:
        return not_testable(
            name,
            "runs scatter so much, or so few share a slip and load, that a misfit of "
            f"{residuals.detectable:.1%} of the peak force or less is not told from chance, limit "
            f"{MAX_MISFIT:.0%}; repeat runs",
            untested="shape of the curve (runs scatter)",
            advice=MeasureAlso("runs scatter too much to show the curve's shape", repeats=PASSES),
        )
    repeated = repeated_share(blocks)
    if not failed and repeated < MIN_REPEATED:
        return not_testable(
            name,
            f"{repeated:.0%} of the runs have a slip and load that another run has, expected "
            f"{MIN_REPEATED:.0%} or more; the misfit that neighbouring slips share is "
            f"{residuals.misfit:.1%} of the peak force",
            untested=untested,
            advice=again,
        )
    return decided(
        name,
        not failed,
        f"the misfit that all runs share is {residuals.misfit:.1%} of the peak force, limit "
        f"{MAX_MISFIT:.0%} where p is below {MISFIT_P:g} (p = {residuals.misfit_p:.2g})",
        law_advice(blocks),
    )
