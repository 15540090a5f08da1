# SPDX-License-Identifier: MIT
"""The white noise of the slip sensors, and estimates of each run that are shrunk towards all."""

import numpy as np
from scipy.special import chdtri

from model.arrays import Array
from model.slip.samples import SlipSamples

ENDLESS = 1e9  # degrees of freedom of a variance that is known


def slip_noise_variance(samples: SlipSamples) -> Array:
    r"""Estimate the variance of the slip sensors' white noise, for each run.

    The estimate is a nugget: the mean squares :math:`S_l` of second differences over l = 1 and 2
    samples, extrapolated to none, :math:`(2 S_1 - S_2)/6`. Slow wander cancels in it, and so do
    sweeps, those that turn too. Its sampling variance for white noise of variance
    :math:`\sigma^2` is :math:`13\sigma^4/n` with n samples; estimates that scatter by no more
    between runs are replaced by one typical value, others are shrunk towards it. Runs of fewer than
    8 samples have the typical value. If all runs are that short, the noise variance is zero.

    Args:
        samples: The samples.

    Returns:
        Noise variance of one sample's slip ratio, shape (n_runs,) [-].
    """
    return noise_and_freedom(samples)[0]


def noise_and_freedom(samples: SlipSamples) -> tuple[Array, Array]:
    """Return each run's noise variance as `slip_noise_variance` does, and its degrees of freedom.

    The degrees of freedom are those of a chi-square of the same relative variance, (n_runs,) each;
    as many as those of all runs together for a typical value that replaces a run's own.
    """
    lengths = np.array([part.stop - part.start for part in samples.slices()])
    enough = lengths >= 8
    if not enough.any():
        return np.zeros(samples.n_runs), np.full(samples.n_runs, ENDLESS)
    nuggets = np.array([_nugget(samples.slip[part]) for part in samples.slices()])
    # Twice the squared mean over the variance are a chi-square's degrees of freedom: 2n/13.
    freedom = 2 * lengths / 13
    typical = median_variance(nuggets[enough], freedom[enough])
    share = own_share(nuggets, 13 * typical**2 / lengths, typical)
    noise = np.where(enough, np.maximum(typical + share * (nuggets - typical), 0.0), typical)
    return noise, shrunk_freedom(freedom, np.where(enough, share, 0.0), freedom[enough].sum())


def shrunk_freedom(freedom: Array, share: Array, together: float) -> Array:
    """Compute the degrees of freedom of a run's estimate shrunk towards that of all runs.

    Relative variances are added: that of its own part, and that of the typical value, which runs
    have in common.

    Args:
        freedom: Degrees of freedom of the run's own estimate, shape (n_runs,).
        share: Weight of its own estimate, from 0 to 1, shape (n_runs,) [-].
        together: Degrees of freedom of all runs together.
    """
    return 1 / (share**2 / freedom + (1 - share**2) / together)


def _nugget(slip: Array) -> float:
    """Estimate one run's nugget [-] from its slip ratios (n,), at least 0; 0 for fewer than 8."""
    if len(slip) < 8:
        return 0.0
    one = np.mean((slip[2:] - 2 * slip[1:-1] + slip[:-2]) ** 2)
    two = np.mean((slip[4:] - 2 * slip[2:-2] + slip[:-4]) ** 2)
    return max(0.0, float(2 * one - two) / 6)


def median_variance(estimates: Array, freedom: Array) -> float:
    """Compute the median of variance estimates, corrected for the skewness of their chi-square.

    Args:
        estimates: Variance estimates, shape (n,); the median of none is 0.
        freedom: Degrees of freedom of each estimate, shape (n,).
    """
    if len(estimates) == 0:
        return 0.0
    return float(np.median(estimates * freedom / chdtri(freedom, 0.5)))


def shrink(estimates: Array, sampling_variance: Array, typical: float) -> Array:
    """Shrink estimates towards a typical value in proportion to their sampling error.

    Empirical Bayes: where the estimates scatter by no more than an estimate's sampling error, the
    typical value replaces it; the further they scatter beyond it, the less it is changed. The
    scatter is about the typical value, the robust one of the median absolute deviation.

    Args:
        estimates: One estimate a run, shape (n_runs,).
        sampling_variance: Variance each estimate would have if all runs were alike, (n_runs,).
        typical: Value to shrink towards.
    """
    share = own_share(estimates, sampling_variance, typical)
    return typical + share * (estimates - typical)


def own_share(estimates: Array, sampling_variance: Array, typical: float) -> Array:
    """Compute the weight of each run's own estimate in `shrink`, shape (n_runs,) [-].

    It is 1 - sampling variance over variance between runs (from the median absolute deviation), at
    least 0; all 0 where more than half of the estimates are typical.
    """
    scatter = (1.4826 * np.median(np.abs(estimates - typical))) ** 2
    if scatter == 0:
        return np.zeros_like(estimates)
    return np.maximum(0.0, 1.0 - sampling_variance / scatter)
