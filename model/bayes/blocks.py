# SPDX-License-Identifier: MIT
"""Block means of the samples, with the variances that averaging within a block would hide.

Two kinds of variation blur a measured slip ratio, and they bias a fit in opposite ways. Sensor
noise is not in the true slip: a curve fitted through it is too flat (errors in variables). Slow
wander is in the true slip and changes the force: a curve fitted to its mean has too low a peak
(averaging over a bent curve). Their correlation in time separates the two. The noise is returned
as a variance of each block's slip, the wander as a variance within the block.
"""

from dataclasses import dataclass, replace

import numpy as np
from numpy.typing import NDArray
from scipy.special import chdtri, polygamma

from model.bayes.block_edges import BY_CHANCE, block_starts
from model.bayes.samples import SlipSamples
from model.slip.definition import SlipDefinition
from model.slip.law import Array

MOST_ERROR = 0.03  # relative error of the weight of a block's own slip; else the run's mean is used
NOISE_ALONE = 0.01  # probability
ALIKE = 2.5  # of runs alike, scatter over sampling variance: wander links blocks, and runs are few
MOST_FREEDOM = 1e6  # of a variance that many runs share


@dataclass(frozen=True)
class SlipBlocks:
    """Block means of slip, load and traction, in time order within each run.

    Attributes:
        slip: Best estimate of the block's mean true slip ratio, given the measured ones of its
            run, shape (n,) [-].
        normal_force: Mean measured normal force, shape (n,) [N].
        traction_force: Mean measured traction force, shape (n,) [N].
        count: Number of samples in the block, shape (n,).
        run: Index into `run_names`, non-decreasing, shape (n,).
        run_names: Name of each run.
        definition: Definition of the slip ratios: the speed that they are divided by.
        slip_wander: Variance of the true slip within the block, shape (n,) [-].
        slip_error: Variance of the error of `slip`, independent between blocks, shape (n,) [-].
        load_variance: Variance of the load within the block, shape (n,) [N^2].
        load_skewness: Skewness of the load within the block, shape (n,) [-].
        slip_load_covariance: Covariance of slip and load within the block, shape (n,) [N].
        run_slip_error: Variance of the error of `slip` that all blocks of a run share, shape
            (n_runs,) [-].
    """

    slip: Array
    normal_force: Array
    traction_force: Array
    count: NDArray[np.intp]
    run: NDArray[np.intp]
    run_names: tuple[str, ...]
    definition: SlipDefinition
    slip_wander: Array
    slip_error: Array
    load_variance: Array
    load_skewness: Array
    slip_load_covariance: Array
    run_slip_error: Array

    def __len__(self) -> int:
        """Return the number of blocks."""
        return len(self.slip)

    @property
    def n_runs(self) -> int:
        """Number of runs."""
        return len(self.run_names)

    def slip_variance(self) -> Array:
        """Return the variance of the true slip of a block's samples around `slip`, shape (n,) [-].

        It is the sum of `slip_wander`, `slip_error` and `run_slip_error`; a curved law has to be
        averaged over it.
        """
        return self.slip_wander + self.slip_error + self.run_slip_error[self.run]

    def run_starts(self) -> NDArray[np.intp]:
        """Return the index of each run's first block, then the number of blocks, (n_runs + 1,)."""
        return np.searchsorted(self.run, np.arange(self.n_runs + 1))

    def run_mean(self, block_values: Array) -> Array:
        """Average values (..., n) over each run's blocks, equally weighted, to (..., n_runs)."""
        starts = self.run_starts()
        return np.add.reduceat(block_values, starts[:-1], axis=-1) / np.diff(starts)

    def select_runs(self, keep: NDArray[np.bool_]) -> "SlipBlocks":
        """Return the blocks of some runs, the runs numbered anew from 0.

        Args:
            keep: Whether to keep each run, shape (n_runs,).
        """
        rows = keep[self.run]
        per_block = {name: getattr(self, name)[rows] for name in _PER_BLOCK}
        return replace(
            self,
            **per_block,
            run=(np.cumsum(keep) - 1)[self.run[rows]],
            run_names=tuple(np.array(self.run_names, dtype=object)[keep]),
            run_slip_error=self.run_slip_error[keep],
        )


_PER_BLOCK = (
    "slip", "normal_force", "traction_force", "count", "slip_wander", "slip_error",
    "load_variance", "load_skewness", "slip_load_covariance",
)  # fmt: skip


def slip_noise_variance(samples: SlipSamples) -> Array:
    r"""Estimate the variance of the slip sensors' white noise, for each run.

    The estimate is the nugget of the variogram: half the variance of the differences at lag 1 and
    2, extrapolated to lag 0, :math:`2\gamma_1 - \gamma_2`. Slow wander and steady sweeps cancel in
    it. Its sampling variance for white noise of variance :math:`\sigma^2` is :math:`7\sigma^4/n`
    with n samples; estimates that scatter by no more between runs are replaced by one typical
    value, others are shrunk towards it. Runs of fewer than 8 samples have the typical value. If all
    runs are that short, the noise variance is zero.

    Args:
        samples: The samples.

    Returns:
        Noise variance of one sample's slip ratio, shape (n_runs,) [-].
    """
    lengths = np.array([part.stop - part.start for part in samples.slices()])
    enough = lengths >= 8
    if not enough.any():
        return np.zeros(samples.n_runs)
    nuggets = np.array([_nugget(samples.slip[part]) for part in samples.slices()])
    # Twice the squared mean over the variance are a chi-square's degrees of freedom: 2n/7.
    typical = _median_variance(nuggets[enough], 2 * lengths[enough] / 7)
    own = _shrink(nuggets, 7 * typical**2 / lengths, typical)
    return np.where(enough, np.maximum(own, 0.0), typical)


def _nugget(slip: Array) -> float:
    """Estimate one run's nugget [-] from its slip ratios (n,), at least 0; 0 for fewer than 8."""
    if len(slip) < 8:
        return 0.0
    gamma_1 = 0.5 * np.var(slip[1:] - slip[:-1])
    gamma_2 = 0.5 * np.var(slip[2:] - slip[:-2])
    return max(0.0, float(2 * gamma_1 - gamma_2))


def _median_variance(estimates: Array, freedom: Array) -> float:
    """Compute the median of variance estimates, corrected for the skewness of their chi-square.

    Args:
        estimates: Variance estimates, shape (n,); the median of none is 0.
        freedom: Degrees of freedom of each estimate, shape (n,).
    """
    if len(estimates) == 0:
        return 0.0
    return float(np.median(estimates * freedom / chdtri(freedom, 0.5)))


def _shrink(estimates: Array, sampling_variance: Array, typical: float) -> Array:
    """Shrink estimates towards a typical value in proportion to their sampling error.

    Empirical Bayes: where the estimates scatter by no more than an estimate's sampling error, the
    typical value replaces it; the further they scatter beyond it, the less it is changed. The
    scatter is about the typical value, the robust one of the median absolute deviation.

    Args:
        estimates: One estimate a run, shape (n_runs,).
        sampling_variance: Variance each estimate would have if all runs were alike, (n_runs,).
        typical: Value to shrink towards.
    """
    scatter = (1.4826 * np.median(np.abs(estimates - typical))) ** 2
    if scatter == 0:
        return np.full_like(estimates, typical)
    own = np.maximum(0.0, 1.0 - sampling_variance / scatter)
    return typical + own * (estimates - typical)


def block_means(samples: SlipSamples, length: int) -> SlipBlocks:
    """Average the samples over blocks of about `length` samples, cut by `block_starts`.

    Every sample is used. Slip is not the plain mean but that of `_calibrate_slip`.

    Args:
        samples: The samples.
        length: Wanted number of samples in a block, at least 1.
    """
    noise = slip_noise_variance(samples)
    starts, run = block_starts(samples, length, noise=noise)
    count = np.diff(starts)
    slip, load, force = (
        _mean(values, starts)
        for values in (samples.slip, samples.normal_force, samples.traction_force)
    )
    slip_deviation = samples.slip - np.repeat(slip, count)
    load_deviation = samples.normal_force - np.repeat(load, count)
    spread = np.add.reduceat(slip_deviation**2, starts[:-1]) / np.maximum(count - 1, 1)
    load_variance = _mean(load_deviation**2, starts)
    calibrated, slip_error, run_slip_error = _calibrate_slip(slip, count, run, noise)
    return SlipBlocks(
        slip=calibrated,
        normal_force=load,
        traction_force=force,
        count=count,
        run=run,
        run_names=samples.run_names,
        definition=samples.definition,
        slip_wander=_wander(spread, count, run, noise),
        slip_error=slip_error,
        load_variance=load_variance,
        load_skewness=_skewness(_mean(load_deviation**3, starts), load_variance),
        slip_load_covariance=_mean(slip_deviation * load_deviation, starts),
        run_slip_error=run_slip_error,
    )


def _mean(values: Array, starts: NDArray[np.intp]) -> Array:
    """Average sample values (n_samples,) over blocks from `starts`, which ends with n_samples."""
    return np.add.reduceat(values, starts[:-1]) / np.diff(starts)


def _skewness(third_moment: Array, variance: Array) -> Array:
    """Compute skewness from third moment and variance of each block; 0 where nothing varies."""
    varies = variance > 1e-12 * variance.max(initial=1e-300)
    return np.where(varies, third_moment / np.where(varies, variance, 1.0) ** 1.5, 0.0)


def _calibrate_slip(
    slip: Array, count: NDArray[np.intp], run: NDArray[np.intp], noise: Array
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
    mean, with the errors :math:`\omega^2` and :math:`\sigma^2/N`. Returns the slips (n,), their own
    (n,) and shared (n_runs,) variances.
    """
    n_blocks, n_samples = np.bincount(run), np.bincount(run, count)
    middle = np.bincount(run, slip * count) / n_samples
    error = noise * n_blocks / n_samples
    spare = np.maximum(n_blocks - 1, 1)
    total = np.bincount(run, (slip - middle[run]) ** 2) / spare
    several = n_blocks > 1
    spread, worth = np.zeros(len(total)), np.ones(len(total))
    spread[several], worth[several] = _beyond_noise(total[several], spare[several], error[several])
    weight = spread / np.maximum(spread + error, 1e-300)
    known = (1 - weight) * np.sqrt(2 / worth) <= MOST_ERROR * weight
    calibrated = middle[run] + np.where(known, weight, 0.0)[run] * (slip - middle[run])
    own, shared = np.where(known, weight * error, spread), np.where(known, 1 - weight, 1.0)
    return calibrated, own[run], shared * noise / n_samples


def _beyond_noise(total: Array, freedom: Array, error: Array) -> tuple[Array, Array]:
    """Estimate the variance of true slip between each run's blocks.

    Logarithms of the runs' variances are shrunk towards their typical value in proportion to their
    sampling error, `ALIKE` times the trigamma function of half the degrees of freedom. A variance
    that noise alone exceeds with the probability `NOISE_ALONE` counts as noise, by a chi-square of
    as many degrees of freedom as the shrunk variance is worth.

    Args:
        total: Variance of measured slip between blocks of each run, shape (n_runs,) [-].
        freedom: Its degrees of freedom, shape (n_runs,).
        error: The part of it that noise makes, shape (n_runs,) [-].

    Returns:
        The variance of true slip [-], and the degrees of freedom that the shrunk variance of
        measured slip is worth, (n_runs,) each.
    """
    if not total.any():
        return np.zeros_like(total), np.ones_like(total)
    typical = _median_variance(total, freedom)
    own = np.maximum(total, 1e-300)
    away = np.log(own / max(typical, 1e-300))
    scatter = (1.4826 * np.median(np.abs(away))) ** 2
    by_chance = ALIKE * polygamma(1, freedom / 2)
    share = np.maximum(0.0, 1.0 - by_chance / max(scatter, 1e-300))
    spread = own * np.exp((share - 1) * away)
    worth = np.minimum(freedom / np.maximum(share, 1e-6), MOST_FREEDOM)
    by_noise = error * chdtri(worth, NOISE_ALONE) / worth
    return np.where(spread > by_noise, np.maximum(spread - error, 0.0), 0.0), worth


def _wander(spread: Array, count: NDArray[np.intp], run: NDArray[np.intp], noise: Array) -> Array:
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
    shared = np.maximum(_shrink(of_run, error_of_run, float(np.median(of_run))), 0.0)[run]
    error = 2 * noise[run] * (noise[run] + 2 * shared) / spare
    own = shared**2 / np.maximum(shared**2 + error, 1e-300)
    jump = spread * spare > (noise[run] + shared) * chdtri(spare, BY_CHANCE)
    wander = np.where(jump, excess, shared + own * (excess - shared))
    # Around the block's own mean a variance is smaller by 1/n than around the true one.
    return np.maximum(wander, 0.0) * (1 - 1 / count)
