# SPDX-License-Identifier: MIT
"""Scores of an ensemble of paths: energy score, CRPS, and coverage and width of intervals."""

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np
from scipy.spatial.distance import pdist
from scipy.stats import binom

from model.arrays import Array
from model.errors import DomainError
from model.poses import wrap

LEVELS = (0.5, 0.9, 0.95)  # probabilities of the central intervals


@dataclass(frozen=True)
class EnsembleScores:
    """Mean scores over all poses; lower is better, except coverage, which should be its level.

    Attributes:
        energy: Mean energy score of position [m].
        crps: Mean continuous ranked probability score of x, y [m] and yaw [rad], shape (3,).
        levels: Probabilities of the central intervals [-].
        coverage: Share of tracked x, y and yaw within the intervals, shape (levels, 3) [-].
        width: Mean width of the intervals of x, y and yaw, shape (levels, 3) [m, m, rad].

    Scores and coverage of yaw are NaN if a tracked yaw is.
    """

    energy: float
    crps: Array
    levels: tuple[float, ...]
    coverage: Array
    width: Array


def centred(draws: Array, observed: Array) -> Array:
    """Shift observed headings by whole turns to within half a turn of the draws' mean heading.

    Args:
        draws: x, y, yaw of every draw at every time, shape (m, n, 3) [m, m, rad].
        observed: Tracked x, y, yaw, shape (n, 3) [m, m, rad].

    Returns:
        The observed values with shifted yaw, shape (n, 3) [m, m, rad].
    """
    mean = draws[..., 2].mean(axis=0)
    return np.column_stack([observed[:, :2], mean + wrap(observed[:, 2] - mean)])


def ensemble_scores(draws: Array, observed: Array) -> EnsembleScores:
    """Compute mean scores of an ensemble against a track at the same times.

    Energy score and CRPS are the unbiased ("fair") estimates for a finite ensemble; for a single
    draw they are its distance and absolute error. Tracked yaw may differ by whole turns.

    Args:
        draws: x, y, yaw of every draw at every time, the tracker's noise included where it is
            known, shape (m, n, 3) [m, m, rad].
        observed: Tracked x, y, yaw; yaw NaN where it is not known, shape (n, 3) [m, m, rad].

    Raises:
        DomainError: Shapes do not match.
    """
    if draws.ndim != 3 or draws.shape[1:] != observed.shape or observed.shape[1] != 3:
        raise DomainError(
            f"draws have shape {draws.shape} and tracked poses {observed.shape}; expected "
            "(m, n, 3) and (n, 3)"
        )
    observed = centred(draws, observed)
    coverage, width = interval_coverage(draws, observed, LEVELS)
    return EnsembleScores(
        energy=float(np.mean(energy_score(draws[..., :2], observed[:, :2]))),
        crps=crps(draws, observed).mean(axis=0),
        levels=LEVELS,
        coverage=coverage,
        width=width,
    )


def crps(draws: Array, observed: Array) -> Array:
    r"""Compute the continuous ranked probability score :math:`E|X-y| - E|X-X'|/2`.

    X and X' are two different draws, y is the observed value; the result is NaN where y is.

    Args:
        draws: Values of every draw, shape (m, ...).
        observed: Observed values, shape (...).

    Returns:
        Scores, shape (...), in the unit of the values; the absolute error for a single draw.
    """
    m = len(draws)
    error = np.abs(draws - observed).mean(axis=0)
    if m == 1:
        return error
    # Sorted, the mean distance of two draws is a sum over ranks: no m x m table.
    ranks = (2 * np.arange(1, m + 1) - m - 1).reshape(-1, *[1] * (draws.ndim - 1))
    return error - (ranks * np.sort(draws, axis=0)).sum(axis=0) / (m * (m - 1))


def energy_score(draws: Array, observed: Array) -> Array:
    r"""Compute the energy score :math:`E|X-y| - E|X-X'|/2` of points, the multivariate CRPS.

    X and X' are two different draws of a point, y is the observed one, | | the Euclidean length.

    Args:
        draws: Points of every draw, shape (m, n, d).
        observed: Observed points, shape (n, d).

    Returns:
        Scores, shape (n,), in the unit of the points; the distance for a single draw.
    """
    error = np.linalg.norm(draws - observed, axis=-1).mean(axis=0)
    if len(draws) == 1:
        return error
    return error - 0.5 * np.array([pdist(each).mean() for each in np.moveaxis(draws, 0, 1)])


def interval_coverage(
    draws: Array, observed: Array, levels: Sequence[float]
) -> tuple[Array, Array]:
    """Compute coverage and mean width of central intervals over n times, for each of k values.

    Args:
        draws: Values of every draw, shape (m, n, k).
        observed: Observed values; NaN where unknown, shape (n, k).
        levels: Probabilities of the intervals [-].

    Returns:
        Shares of observed values inside, NaN for values of which any is unknown, and mean widths,
        both of shape (levels, k).
    """
    p = np.asarray(levels)
    low, high = np.quantile(draws, (1 - p) / 2, axis=0), np.quantile(draws, (1 + p) / 2, axis=0)
    inside = np.where(np.isnan(observed), np.nan, (low <= observed) & (observed <= high))
    return inside.mean(axis=1), (high - low).mean(axis=1)


def coverage_range(level: float, n: int) -> tuple[float, float]:
    """Compute the central 95 % range of the share of n independent values in an interval.

    Errors of poses of one walk are alike, so that their share lies outside more often than in one
    case of twenty; `model.metrics.consistency` judges a band with that dependence.

    Args:
        level: Probability of the interval [-].
        n: Number of values.

    Returns:
        Lowest and highest share of the binomial distribution's central 95 % [-].

    >>> low, high = coverage_range(0.9, 14)
    >>> round(14 * low), round(14 * high)
    (10, 14)
    """
    low, high = binom.interval(0.95, n, level)
    return float(low) / n, float(high) / n
