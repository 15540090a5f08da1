# SPDX-License-Identifier: MIT
"""Analysis of the residuals: whitened residuals, run means, and structure along the curve."""

from dataclasses import dataclass, replace

import numpy as np
from numpy.typing import NDArray
from scipy.linalg import solve_triangular
from scipy.special import fdtrc, fdtri, ndtri

from model.arrays import Array
from model.bayes.averaging.blocks import SlipBlocks
from model.bayes.averaging.load_levels import load_levels, nearest_level
from model.bayes.likelihood import PredictedForces, covariance_factors, predict_blocks
from model.slip.law import SlipLaw

SLIP_BINS = 8
FAR_SCORE = 2.0  # below, a run mean is not far out, however close the others are
CROSSED = 2.0  # groups of slip that a run crosses on average, from which runs are sweeps
MISFIT_P = 1e-3  # p-value below which a misfit is significant


@dataclass(frozen=True)
class Residuals:
    """Residuals of the fit, and tests on them.

    Attributes:
        whitened: Residual of each block less its expectation given the blocks before it in its run,
            over its standard deviation given these; white N(0, 1) if the model holds, shape (n,).
        lag_one: Correlation of successive whitened residuals within runs; 0 if no run has two
            blocks [-].
        run_score: Each run's mean residual over its predictive standard deviation, that of the
            parameters included, shape (n_runs,) [-].
        inside: Fraction of run means within their predictive 90 % interval [-].
        inside_p: Two-sided binomial p-value of that fraction against 90 % [-].
        misfit: Root-mean-square residual that is a function of slip, over the largest predicted
            traction at its load: of all loads together, or if some misfits are significant the
            largest of these, over all loads or at one. Repeated measurements do not average it
            away; 0 if no two runs share a slip and load [-].
        misfit_p: p-value of the F test of `misfit` against the scatter between runs, of a single
            load times the number of loads; NaN if no two runs share a slip and load [-].
        detectable: Misfit over all loads that would have the p-value `MISFIT_P`, at the scatter
            found; NaN if no two runs share a slip and load [-].
        r_squared: Fraction of the variance of the fitted block means that is explained [-].
        rmse: Root-mean-square residual of block means [N].
        rmse_over_load: Root-mean-square of each block's residual over its measured load [-].
    """

    whitened: Array
    lag_one: float
    run_score: Array
    inside: float
    inside_p: float
    misfit: float
    misfit_p: float
    detectable: float
    r_squared: float
    rmse: float
    rmse_over_load: float


def analyse_residuals(blocks: SlipBlocks, law: SlipLaw, values: Array) -> Residuals:
    """Compute residuals, measured minus posterior mean prediction, and the tests on them.

    Args:
        blocks: The block means.
        law: The slip law, of k parameters.
        values: Posterior draws of law and measurement parameters, shape (w, k + 11).

    Raises:
        LinAlgError: The covariance of a run's blocks is singular.
    """
    from scipy.stats import binomtest  # late: takes longest of all to import

    predicted = predict_blocks(blocks, law, values)
    residual = blocks.traction_force - predicted.force.mean(axis=0)
    factors = covariance_factors(blocks, predicted.mean(), values.mean(axis=0))
    score = _run_scores(blocks, residual, factors, blocks.run_mean(predicted.force).std(axis=0))
    inside = int(np.sum(np.abs(score) <= ndtri(0.95)))
    whitened = _whiten(blocks, residual, factors)
    repeating = _structure(blocks, residual, predicted)
    variance = np.mean((blocks.traction_force - blocks.traction_force.mean()) ** 2)
    return Residuals(
        whitened=whitened,
        lag_one=lag_correlation(whitened, blocks.run, 1)[0],
        run_score=score,
        inside=inside / blocks.n_runs,
        inside_p=float(binomtest(inside, blocks.n_runs, 0.9).pvalue),
        misfit=repeating.misfit,
        misfit_p=repeating.p,
        detectable=repeating.detectable,
        r_squared=float(1 - np.mean(residual**2) / variance),
        rmse=float(np.sqrt(np.mean(residual**2))),
        rmse_over_load=float(np.sqrt(np.mean((residual / blocks.normal_force) ** 2))),
    )


def _whiten(blocks: SlipBlocks, residual: Array, factors: list[Array]) -> Array:
    """Solve L x = r for each run, r its residuals and L its lower Cholesky factor, (n,) [-]."""
    parts = np.split(residual, blocks.run_starts()[1:-1])
    return np.concatenate(
        [solve_triangular(L, r, lower=True) for L, r in zip(factors, parts, strict=True)]
    )


def _run_scores(
    blocks: SlipBlocks, residual: Array, factors: list[Array], run_spread: Array
) -> Array:
    """Divide each run's mean residual by its predictive standard deviation, (n_runs,) [-].

    That is the root of the squares of `run_spread`, the standard deviation of its predicted mean
    over the draws (n_runs,) [N], and of the mean's scatter by the covariance with these `factors`.
    """
    sizes = np.diff(blocks.run_starts())
    scatter = np.array([np.linalg.norm(L.sum(axis=0)) for L in factors]) / sizes
    return blocks.run_mean(residual) / np.hypot(scatter, run_spread)


def far_runs(score: Array) -> NDArray[np.intp]:
    """Find runs whose mean is far from those of the other runs, the farthest first.

    The distance is that from the median score in robust standard deviations, 1.4826 times the
    median absolute deviation: a few strange runs widen the predictive intervals of all, and then
    lie inside their own. Where one is farther than 5 + 60 / n, which of n runs of white scores
    happens less than once in 1,000, and its absolute score is above `FAR_SCORE`, the indices of all
    that are farther than half of that limit are returned; else none.

    Args:
        score: Score of each run, as `Residuals.run_score`, shape (n_runs,) [-].

    >>> far_runs(np.append(np.linspace(-0.5, 0.5, 20), [-4.0, 0.6])).tolist()
    [20]
    """
    distance = np.abs(score - np.median(score))
    scale = 1.4826 * np.median(distance)
    limit = (5 + 60 / len(score)) * scale
    if not np.any((distance > limit) & (np.abs(score) > FAR_SCORE)):
        return np.array([], dtype=np.intp)
    order = np.argsort(-distance)
    return order[distance[order] > limit / 2]


def lag_correlation(values: Array, run: NDArray[np.intp], lag: int) -> tuple[float, int]:
    """Compute the correlation of values some lag apart within runs, from -1 to 1, and its pairs.

    Their mean is known to be zero and is not subtracted.

    Args:
        values: One value a block, of mean zero, shape (n,).
        run: Index of each block's run, non-decreasing, shape (n,).
        lag: Distance of a pair, at least 1 [blocks].

    Returns:
        The correlation, 0 without pairs [-], and the number of pairs.
    """
    same_run = run[lag:] == run[:-lag]
    late, early = values[lag:][same_run], values[:-lag][same_run]
    size = np.sqrt(np.sum(late**2) * np.sum(early**2))
    return (float(np.sum(late * early) / size) if size > 0 else 0.0), len(late)


@dataclass(frozen=True)
class _Repeating:
    """Result of an analysis of variance: as the fields of `Residuals` with the same meaning.

    `detectable` is the misfit that would have the p-value `MISFIT_P`.
    """

    misfit: float
    p: float
    detectable: float


def _structure(blocks: SlipBlocks, residual: Array, predicted: PredictedForces) -> _Repeating:
    """Split the residual into a part that repeats along the curve and the scatter between runs.

    The groups are `SLIP_BINS` bins of slip at each of `load_levels`, a group's replicates the means
    of the runs in it.

    Args:
        blocks: The block means.
        residual: Measured minus predicted traction of each block, shape (n,) [N].
        predicted: Predicted tractions and slopes, each shape (draws, n).

    Returns:
        What repeats, over the largest predicted traction; 0 and NaN if no group has two runs. It is
        the largest significant misfit of all analyses, over all loads and at each, since over all
        loads together the small ones hardly count; if none is significant, that over all loads. For
        one load the largest traction is that load times the largest ratio of traction to load at
        any, and the p-value is multiplied by the number of loads. `detectable` is that over all
        loads.
    """
    force, slope = predicted.force.mean(axis=0), predicted.slope.mean(axis=0)
    levels = load_levels(blocks)
    level = nearest_level(np.maximum(blocks.normal_force, 1e-9), levels)
    edges = np.unique(np.quantile(blocks.slip, np.linspace(0, 1, SLIP_BINS + 1)[1:-1]))
    group = level * (SLIP_BINS + 1) + np.searchsorted(edges, blocks.slip, side="right")
    found = _repeating(residual / np.abs(force).max(), slope, group, blocks.run)
    peaks = [np.abs(force[level == i]).max(initial=0.0) for i in range(len(levels))]
    share = float((peaks / levels).max())
    for i, load in enumerate(levels):
        mine = level == i
        part = residual[mine] / (share * load), slope[mine], group[mine], blocks.run[mine]
        alone = _repeating(*part)
        found += [replace(each, p=each.p * len(levels)) for each in alone]
    if not found:
        return _Repeating(0.0, float("nan"), float("nan"))
    most = max(found, key=lambda each: each.misfit * (each.p < MISFIT_P))
    return replace(most, detectable=found[0].detectable)


def _repeating(
    values: Array, slope: Array, group: NDArray[np.intp], run: NDArray[np.intp]
) -> list[_Repeating]:
    """Split values by analyses of variance over the means of each run in each group.

    Where runs cross two groups or more on average, as sweeps do, the first is two-way: each run's
    offset and slip error (a multiple of the curve's slope) are taken out. The last is one-way:
    there the means of one run share its offset and count as one for the degrees of freedom. An
    analysis without a degree of freedom left for the scatter, or for the groups, is left out; the
    list is empty if all are, or without values.
    """
    if not len(values):
        return []
    cells, index = np.unique(np.stack([group, run]), axis=1, return_inverse=True)
    means = np.bincount(index.ravel(), values) / np.bincount(index.ravel())
    design = (cells[0][:, None] == np.unique(cells[0])).astype(float)
    _, runs = np.unique(cells[1], return_inverse=True)
    shared = len(means) / (runs.max() + 1)  # groups of a run
    found = [_analysed(means, design, 0, shared)]
    if shared >= CROSSED:
        slopes = np.bincount(index.ravel(), slope) / np.bincount(index.ravel())
        rest, taken = np.column_stack([means, design]), 0
        for each in range(runs.max() + 1):
            mine = runs == each
            own = np.column_stack([np.ones(mine.sum()), slopes[mine]])
            solution, _, rank, _ = np.linalg.lstsq(own, rest[mine], rcond=1e-9)
            rest[mine] -= own @ solution
            taken += int(rank)
        found.insert(0, _analysed(rest[:, 0], rest[:, 1:], taken, 1.0))
    return [each for each in found if each is not None]


def _analysed(values: Array, design: Array, taken: int, shared: float) -> _Repeating | None:
    """Test by an F test what groups explain of values against the rest.

    Args:
        values: Mean of each run in each group, shape (n,).
        design: Indicator of each group in columns, shape (n, groups).
        taken: Degrees of freedom already taken out of the values.
        shared: Number of values that count as one, by which degrees of freedom are divided.

    Returns:
        The result; None if no degree of freedom is left for the rest, or none for the groups.
    """
    solution, _, rank, _ = np.linalg.lstsq(design, values, rcond=1e-9)
    spare = len(values) - taken - int(rank)
    if spare < 1 or rank < 1:
        return None
    explained = design @ solution
    between = float(np.sum(explained**2)) / rank
    within = max(float(np.sum((values - explained) ** 2)) / spare, 1e-300)
    size = float(np.sum(design**2)) / rank  # values of a group
    freedom = rank / shared, spare / shared
    return _Repeating(
        misfit=float(np.sqrt(max(0.0, between - within) / size)),
        p=float(fdtrc(*freedom, between / within)),
        detectable=float(np.sqrt((fdtri(*freedom, 1 - MISFIT_P) - 1) * within / size)),
    )
