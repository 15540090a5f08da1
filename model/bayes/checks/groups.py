# SPDX-License-Identifier: MIT
"""Mean residuals of raw samples by load and side, judged jointly against their uncertainty."""

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray
from scipy.special import chdtrc

from model.arrays import Array
from model.bayes.advice import Advice
from model.bayes.averaging.load_levels import load_levels, nearest_level
from model.bayes.checks.check import Check, decided, not_testable
from model.bayes.checks.linear import Linearised

GROUPS = "mean residuals of each load and side are zero"
MIN_P = 0.01
ONE_RUN_P = 1e-5
OUTER = 0.6  # of the largest slip of a load and side, beyond which slips are judged on their own
MOST_NAMED = 3


@dataclass(frozen=True)
class GroupResiduals:
    """Mean residuals of m groups of samples, each of one load and side.

    Attributes:
        load: Load level, shape (m,) [N].
        driving: Whether slips are positive, shape (m,).
        mean: Mean of measured minus predicted traction over a group's samples, shape (m,) [N].
        sd: Standard deviation that the fitted model gives that mean, less what the fit absorbs,
            shape (m,) [N].
        square: Chi-square of all means together, with their correlations [-].
        freedom: Its degrees of freedom: directions in which a mean can differ from zero.
    """

    load: Array
    driving: NDArray[np.bool_]
    mean: Array
    sd: Array
    square: float
    freedom: int

    @property
    def p(self) -> float:
        """Probability of a chi-square as large, if all means are zero; 1 without freedom [-]."""
        return float(chdtrc(self.freedom, self.square)) if self.freedom else 1.0

    def worst(self) -> str:
        """Format the `MOST_NAMED` groups whose means are most standard deviations from zero."""
        order = np.argsort(-np.abs(self.mean / self.sd))[:MOST_NAMED]
        return ", ".join(
            f"{self.mean[i]:+.2g} ± {self.sd[i]:.2g} N at {self.load[i]:.3g} N "
            f"{'driving' if self.driving[i] else 'braking'}"
            for i in order
        )


def group_residuals(fit: Linearised, *, outer: bool = False) -> GroupResiduals:
    r"""Compute mean residuals by load and side, and their joint chi-square.

    Groups are the blocks nearest to one load level and of one sign of slip. With measured and
    predicted traction y and f, and columns of W that average a group's samples, the means are
    W'(y - f). Their covariance is :math:`W' L (1 - Q Q') L' W`, with the Cholesky factor L of the
    blocks' covariance and the basis Q of what the fit absorbs, which the chi-square also takes out
    of the means.

    Args:
        fit: The linearised fit.
        outer: Whether to look only at slips beyond `OUTER` of the largest of their load and side.
    """
    blocks = fit.blocks
    levels = load_levels(blocks)
    level = nearest_level(np.maximum(blocks.normal_force, 1e-9), levels)
    group = 2 * level + (blocks.slip > 0)
    if outer:
        largest = np.zeros(2 * len(levels))
        np.maximum.at(largest, group, np.abs(blocks.slip))
        group = np.where(np.abs(blocks.slip) > OUTER * largest[group], group, -1)
    names = np.unique(group[group >= 0])
    weights = (group[:, None] == names) * blocks.count[:, None].astype(float)
    weights /= weights.sum(axis=0)
    spread = _unwhitened(fit, weights)
    n = len(blocks)
    spread = np.vstack([spread, np.zeros((len(fit.rest) - n, len(names)))])
    spread -= fit.basis @ (fit.basis.T @ spread)
    covariance = spread.T @ spread
    mean = spread.T @ fit.rest
    sd = np.sqrt(np.diag(covariance))
    square, freedom = _chi_square(mean / sd, covariance / np.outer(sd, sd))
    raw = weights.T @ fit.residual
    return GroupResiduals(levels[names // 2], names % 2 == 1, raw, sd, square, freedom)


def _unwhitened(fit: Linearised, weights: Array) -> Array:
    """Multiply weights (n, m) by the transposed factor of each run's covariance, (n, m) [N]."""
    parts = np.split(weights, fit.blocks.run_starts()[1:-1])
    return np.concatenate([L.T @ part for L, part in zip(fit.factors, parts, strict=True)])


def _chi_square(score: Array, correlation: Array) -> tuple[float, int]:
    """Compute the chi-square of correlated scores, and its degrees of freedom.

    Eigen-directions of the correlation with a variance up to 0.001 are left out.
    """
    size, vectors = np.linalg.eigh(correlation)
    kept = size > 1e-3
    return float(np.sum((vectors.T @ score)[kept] ** 2 / size[kept])), int(kept.sum())


def groups(fit: Linearised, advice: Advice | None) -> Check:
    """Check that mean residuals by load and side are zero, jointly, of all slips and of large ones.

    Passed if the p-values of both chi-squares are above `MIN_P`. One run does not show how runs
    scatter: it fails below `ONE_RUN_P`, and is not testable above.

    Args:
        fit: The linearised fit.
        advice: What to do if they are not; None if nothing explains them.
    """
    every, large = group_residuals(fit), group_residuals(fit, outer=True)
    worst = min(every, large, key=lambda each: each.p)
    where = f" beyond {OUTER:.0%} of the largest slip" if worst is large else ""
    one_run = fit.blocks.n_runs == 1
    limit = ONE_RUN_P if one_run else MIN_P
    evidence = (
        f"chi-square {worst.square:.1f} of {len(worst.mean)} groups{where}, p = {worst.p:.2g}, "
        f"expected above {limit:g}; furthest: {worst.worst()}"
    )
    if one_run and worst.p > limit:
        why = f"one run does not show how runs scatter; {evidence}"
        return not_testable(GROUPS, why, untested="repeatability (one run)")
    return decided(GROUPS, worst.p > limit, evidence, advice)
