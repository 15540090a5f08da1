# SPDX-License-Identifier: MIT
"""Residuals of a fit: whitened ones, and those of run means."""

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray
from scipy.linalg import solve_triangular

from model.arrays import Array
from model.bayes.averaging.blocks import SlipBlocks
from model.bayes.likelihood import covariance_factors, predict_blocks
from model.slip.law import SlipLaw


@dataclass(frozen=True)
class Residuals:
    """Residuals of a fit.

    Attributes:
        whitened: Residual of each block less its expectation given the blocks before it in its run,
            over its standard deviation given these; white N(0, 1) if the model holds, shape (n,).
        run_score: Each run's mean residual over its predictive standard deviation, that of the
            parameters included, shape (n_runs,) [-].
        r_squared: Fraction of the variance of the fitted block means that is explained [-].
        rmse: Root-mean-square residual of block means [N].
        rmse_over_load: Root-mean-square of each block's residual over its measured load [-].
    """

    whitened: Array
    run_score: Array
    r_squared: float
    rmse: float
    rmse_over_load: float


def analyse_residuals(blocks: SlipBlocks, law: SlipLaw, values: Array) -> Residuals:
    """Compute residuals, measured minus posterior mean prediction.

    Args:
        blocks: The block means.
        law: The slip law, of k parameters.
        values: Posterior draws of law and measurement parameters, shape (w, k + 11).

    Raises:
        LinAlgError: The covariance of a run's blocks is singular.
    """
    predicted = predict_blocks(blocks, law, values)
    residual = blocks.traction_force - predicted.force.mean(axis=0)
    factors = covariance_factors(blocks, predicted.mean(), values.mean(axis=0))
    variance = np.mean((blocks.traction_force - blocks.traction_force.mean()) ** 2)
    spread = blocks.run_mean(predicted.force).std(axis=0)
    return Residuals(
        whitened=_whiten(blocks, residual, factors),
        run_score=_run_scores(blocks, residual, factors, spread),
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
