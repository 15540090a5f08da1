# SPDX-License-Identifier: MIT
"""What is known of the true slip of blocks, given the measured slip of their run."""

import numpy as np
from numpy.typing import NDArray
from scipy.special import chdtri, fdtri, polygamma

from model.arrays import Array
from model.bayes.averaging.block_edges import BY_CHANCE
from model.bayes.averaging.slip_noise import median_variance, shrink, shrunk_freedom

MOST_ERROR = 0.1  # relative error of the weight of a block's own slip; else the run's mean is used
NOISE_ALONE = 0.01  # probability
ALIKE = 2.5  # of runs alike, scatter over sampling variance: wander links blocks, and runs are few


def calibrate_slip(
    slip: Array,
    count: NDArray[np.intp],
    run: NDArray[np.intp],
    noise: Array,
    noise_freedom: Array,
) -> tuple[Array, Array, Array]:
    r"""Replace each block's measured slip by its expectation given the slips of the whole run.

    Regression calibration: within a run of N samples, in blocks of n, with noise of variance
    :math:`\sigma^2` in each, the true block slips spread with variance :math:`\omega^2` around the
    run's mean :math:`m`, the measured ones with :math:`\omega^2 + \sigma^2/n`, so that
    :math:`E[\kappa|\hat\kappa] = m + \lambda(\hat\kappa - m)`,
    :math:`\lambda = \omega^2/(\omega^2 + \sigma^2/n)`. Its error has a part of its own in each
    block, variance :math:`\lambda\sigma^2/n`, and one the run shares,
    :math:`(1-\lambda)\sigma^2/N`, so that the variance of the run's mean is :math:`\sigma^2/N`. A
    likelihood that ignored the error of the measured slip, or gave the true slip a flat prior,
    would flatten the curve.

    A spread that noise alone could make counts as none. A wrong :math:`\lambda` would bias the
    slope by as much: where its own relative error is above `MOST_ERROR`, every block has the run's
    mean, with the errors :math:`\omega^2` and :math:`\sigma^2/N`.

    Args:
        slip: Mean measured slip of each block, shape (n,) [-].
        count: Number of samples in each block, shape (n,).
        run: Run of each block, shape (n,).
        noise: Variance of one sample's noise, shape (n_runs,) [-].
        noise_freedom: Degrees of freedom of that variance, shape (n_runs,).

    Returns:
        The slips (n,), and the variances of their own errors (n,) and shared ones (n_runs,).
    """
    n_blocks, n_samples = np.bincount(run), np.bincount(run, count)
    middle = np.bincount(run, slip * count) / n_samples
    error = noise * n_blocks / n_samples
    spare = np.maximum(n_blocks - 1, 1)
    total = np.bincount(run, (slip - middle[run]) ** 2) / spare
    several = n_blocks > 1
    spread, worth = np.zeros(len(total)), np.ones(len(total))
    spread[several], worth[several] = _beyond_noise(
        total[several], spare[several], error[several], noise_freedom[several]
    )
    weight = spread / np.maximum(spread + error, 1e-300)
    off = np.sqrt(2 / worth + 2 / noise_freedom)  # relative error of total over noise
    known = (1 - weight) * off <= MOST_ERROR * weight
    calibrated = middle[run] + np.where(known, weight, 0.0)[run] * (slip - middle[run])
    own, shared = np.where(known, weight * error, spread), np.where(known, 1 - weight, 1.0)
    return calibrated, own[run], shared * noise / n_samples


def calibrate_covariance(
    covariance: Array,
    load_variance: Array,
    count: NDArray[np.intp],
    run: NDArray[np.intp],
    noise: Array,
    noise_freedom: Array,
) -> tuple[Array, Array]:
    r"""Shrink each block's covariance of slip and load by what the noise of slip puts into it.

    In a block of n samples whose load varies by :math:`v`, noise of slip of variance
    :math:`\sigma^2` gives the covariance a variance of :math:`v\sigma^2/n`, and true slip that
    follows load, or wanders while load changes, one of :math:`vt`. As for the slips themselves,
    :math:`E[c|\hat c] = \lambda\hat c`, :math:`\lambda = t/(t + \sigma^2/n)`; t is that of the
    run, blocks weighted by :math:`v`.

    Args:
        covariance: Measured covariance of slip and load within each block, shape (n,) [N].
        load_variance: Variance of the load within each block, shape (n,) [N^2].
        count: Number of samples in each block, shape (n,).
        run: Run of each block, shape (n,).
        noise: Variance of one sample's noise of slip, shape (n_runs,) [-].
        noise_freedom: Degrees of freedom of that variance, shape (n_runs,).

    Returns:
        The covariances [N] and the variances of their errors [N^2], shape (n,) each.
    """
    amount = np.maximum(np.bincount(run, load_variance), 1e-300)
    total = np.bincount(run, covariance**2) / amount
    error = np.bincount(run, load_variance / count) * noise / amount
    freedom = np.maximum(amount**2 / np.maximum(np.bincount(run, load_variance**2), 1e-300), 1.0)
    spread, _ = _beyond_noise(total, freedom, error, noise_freedom)
    white = noise[run] / count
    weight = spread[run] / np.maximum(spread[run] + white, 1e-300)
    return weight * covariance, weight * white * load_variance


def _beyond_noise(
    total: Array, freedom: Array, error: Array, noise_freedom: Array
) -> tuple[Array, Array]:
    """Estimate the variance of true slip in each run beyond what noise makes.

    Logarithms of the runs' variances are shrunk towards their typical value in proportion to their
    sampling error, `ALIKE` times the trigamma function of half the degrees of freedom. A variance
    that noise alone exceeds with the probability `NOISE_ALONE` or more counts as noise, by the F
    distribution of as many degrees of freedom as the shrunk variance and the noise are worth.

    Args:
        total: Variance of measured slip in each run, shape (n_runs,) [-].
        freedom: Its degrees of freedom, shape (n_runs,).
        error: The part of it that noise makes, shape (n_runs,) [-].
        noise_freedom: Degrees of freedom of `error`, shape (n_runs,).

    Returns:
        The variance of true slip [-], and the degrees of freedom that the shrunk variance of
        measured slip is worth, (n_runs,) each; 0 and 1 if `total` is zero in all runs.
    """
    if not total.any():
        return np.zeros_like(total), np.ones_like(total)
    typical = median_variance(total, freedom)
    own = np.maximum(total, 1e-300)
    away = np.log(own / max(typical, 1e-300))
    scatter = (1.4826 * np.median(np.abs(away))) ** 2
    by_chance = ALIKE * polygamma(1, freedom / 2)
    share = np.maximum(0.0, 1.0 - by_chance / max(scatter, 1e-300))
    spread = own * np.exp((share - 1) * away)
    worth = shrunk_freedom(freedom, share, freedom.sum() / ALIKE)
    by_noise = error * fdtri(worth, noise_freedom, 1 - NOISE_ALONE)
    return np.where(spread > by_noise, np.maximum(spread - error, 0.0), 0.0), worth


def wander_within(
    spread: Array, count: NDArray[np.intp], run: NDArray[np.intp], noise: Array
) -> Array:
    r"""Estimate the variance of the true slip around its mean in each block, shape (n,) [-].

    Each block's own estimate, the sample variance of its n measured slips (`spread`) less the noise
    :math:`\sigma^2` (`noise`, one a run), is shrunk towards the mean :math:`\bar w` of its run,
    itself shrunk towards the median run's. The weights are its sampling variance
    :math:`(2\sigma^4 + 4\bar w\sigma^2)/(n-1)` and the variance :math:`\bar w^2` that slow wander
    has between blocks. Clipping each estimate at zero, or keeping only the large ones, would bias
    the wander upwards where there is only noise. A block with a significantly larger spread
    contains a jump and keeps its own estimate. Zero if no block has two samples.
    """
    if not (count > 1).any():
        return np.zeros_like(spread)
    spare = np.maximum(count - 1, 1)
    excess = np.where(count > 1, spread - noise[run], 0.0)
    of_run = np.bincount(run, excess) / np.bincount(run)
    error_of_run = np.bincount(run, 2 * noise[run] ** 2 / spare) / np.bincount(run) ** 2
    shared = np.maximum(shrink(of_run, error_of_run, float(np.median(of_run))), 0.0)[run]
    error = 2 * noise[run] * (noise[run] + 2 * shared) / spare
    own = shared**2 / np.maximum(shared**2 + error, 1e-300)
    jump = spread * spare > (noise[run] + shared) * chdtri(spare, BY_CHANCE)
    wander = np.where(jump, excess, shared + own * (excess - shared))
    # Around the block's own mean a variance is smaller by 1/n than around the true one.
    return np.maximum(wander, 0.0) * (1 - 1 / count)
