# SPDX-License-Identifier: MIT
"""Means over blocks of successive samples, with what the averaging hides kept beside them.

Two things blur a measured slip ratio, and they bias a fit in opposite ways. Sensor noise is not in
the true slip: a curve fitted through it is too flat (errors in variables). Wander is: the force
answers to it, and a curve fitted to its mean is too blunt (averaging over a bent curve). Both are
told apart by their correlation in time and handed on: the noise as a variance of each block's slip,
the wander as a variance within the block.
"""

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from model.bayes.samples import SlipSamples
from model.slip.definition import SlipDefinition
from model.slip.law import Array

MIN_SAMPLES_FOR_OWN_NOISE = 100  # a run this long estimates its noise variance to about 20 %


@dataclass(frozen=True)
class SlipBlocks:
    """Block means of slip, load and traction, in time order within each run.

    Attributes:
        slip: Best estimate of the block's mean true slip ratio, shape (n,) [-].
        normal_force: Mean measured normal force, shape (n,) [N].
        traction_force: Mean measured traction force, shape (n,) [N].
        count: Samples in the block, shape (n,).
        run: Index of the run, non-decreasing, shape (n,).
        run_names: Name of each run.
        definition: What the slip ratios are divided by.
        slip_wander: Variance of the true slip within the block, shape (n,) [-].
        slip_error: Variance of the error of `slip`, independent between blocks, shape (n,) [-].
        slip_load_covariance: Covariance of slip and load within the block, shape (n,) [N].
        run_slip_error: Variance of the error of `slip` that a run shares, shape (n_runs,) [-].
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
    slip_load_covariance: Array
    run_slip_error: Array

    def __len__(self) -> int:
        """Count the blocks."""
        return len(self.slip)

    @property
    def n_runs(self) -> int:
        """Count the runs."""
        return len(self.run_names)

    def slip_variance(self) -> Array:
        """Return the variance of the true slip of a sample around `slip`, shape (n,) [-].

        Wander and both errors together: what a bent curve must be averaged over.
        """
        return self.slip_wander + self.slip_error + self.run_slip_error[self.run]

    def run_starts(self) -> NDArray[np.intp]:
        """Return the index of each run's first block and, last, the number of blocks."""
        return np.searchsorted(self.run, np.arange(self.n_runs + 1))

    def run_mean(self, block_values: Array) -> Array:
        """Average a quantity over each run's blocks, shape (..., n) to (..., n_runs)."""
        starts = self.run_starts()
        return np.add.reduceat(block_values, starts[:-1], axis=-1) / np.diff(starts)

    def select_runs(self, keep: NDArray[np.bool_]) -> "SlipBlocks":
        """Return the blocks of some runs.

        Args:
            keep: Which runs to keep, shape (n_runs,).
        """
        rows = keep[self.run]
        return SlipBlocks(
            slip=self.slip[rows],
            normal_force=self.normal_force[rows],
            traction_force=self.traction_force[rows],
            count=self.count[rows],
            run=(np.cumsum(keep) - 1)[self.run[rows]],
            run_names=tuple(np.array(self.run_names, dtype=object)[keep]),
            definition=self.definition,
            slip_wander=self.slip_wander[rows],
            slip_error=self.slip_error[rows],
            slip_load_covariance=self.slip_load_covariance[rows],
            run_slip_error=self.run_slip_error[keep],
        )


def slip_noise_variance(samples: SlipSamples) -> Array:
    r"""Estimate the variance of the slip sensors' white noise, for each run.

    The nugget of the variogram: half the variance of the differences at lag 1 and 2, drawn on to
    lag 0, :math:`2\gamma_1 - \gamma_2`. Slow wander and steady sweeps cancel in it. Runs too short
    for an estimate of their own take the median over runs; runs of fewer than 8 samples say
    nothing and count as noise-free.

    Args:
        samples: The samples.

    Returns:
        Noise variance of one sample's slip ratio, shape (n_runs,) [-].
    """
    lengths = np.array([part.stop - part.start for part in samples.slices()])
    nuggets = np.array([_nugget(samples.slip[part]) for part in samples.slices()])
    enough = lengths >= 8
    pooled = float(np.median(nuggets[enough])) if enough.any() else 0.0
    return np.where(lengths >= MIN_SAMPLES_FOR_OWN_NOISE, nuggets, pooled)


def _nugget(slip: Array) -> float:
    if len(slip) < 8:
        return 0.0
    gamma_1 = 0.5 * np.var(slip[1:] - slip[:-1])
    gamma_2 = 0.5 * np.var(slip[2:] - slip[:-2])
    return max(0.0, float(2 * gamma_1 - gamma_2))


def block_means(samples: SlipSamples, length: int) -> SlipBlocks:
    """Average the samples over blocks of about `length` samples, none across two runs.

    Every sample is used: a run is cut into round(n / length) blocks of nearly equal size.

    Args:
        samples: The samples.
        length: Wanted samples in a block, at least 1.
    """
    starts, run = _block_starts(samples, length)
    count = np.diff(starts)
    slip, load, force = (
        _mean(values, starts)
        for values in (samples.slip, samples.normal_force, samples.traction_force)
    )
    noise = slip_noise_variance(samples)
    slip_deviation = samples.slip - np.repeat(slip, count)
    load_deviation = samples.normal_force - np.repeat(load, count)
    spread = np.add.reduceat(slip_deviation**2, starts[:-1]) / np.maximum(count - 1, 1)
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
        slip_load_covariance=_mean(slip_deviation * load_deviation, starts),
        run_slip_error=run_slip_error,
    )


def _block_starts(samples: SlipSamples, length: int) -> tuple[NDArray[np.intp], NDArray[np.intp]]:
    """Return where each block starts (and the end) and the run each block belongs to."""
    starts, run = [], []
    for index, part in enumerate(samples.slices()):
        n_blocks = max(1, round((part.stop - part.start) / length))
        edges = np.linspace(part.start, part.stop, n_blocks + 1).round().astype(np.intp)
        starts.append(edges[:-1])
        run.append(np.full(n_blocks, index, dtype=np.intp))
    return np.append(np.concatenate(starts), len(samples)), np.concatenate(run)


def _mean(values: Array, starts: NDArray[np.intp]) -> Array:
    return np.add.reduceat(values, starts[:-1]) / np.diff(starts)


def _calibrate_slip(
    slip: Array, count: NDArray[np.intp], run: NDArray[np.intp], noise: Array
) -> tuple[Array, Array, Array]:
    r"""Replace each block's measured slip by its expectation given the whole run's.

    Regression calibration: within a run the true block slips spread with variance
    :math:`\omega^2` around the run's mean :math:`m`, the measured ones with
    :math:`\omega^2 + \sigma^2/n`, so that
    :math:`E[\kappa|\hat\kappa] = m + \lambda(\hat\kappa - m)`,
    :math:`\lambda = \omega^2/(\omega^2 + \sigma^2/n)`. Its error has a part of its own in each
    block, variance :math:`\lambda\sigma^2/n`, and one the run shares, that of m. A likelihood
    that took the measured slip at its word, or gave the true one a flat prior, would flatten the
    curve.
    """
    starts = np.searchsorted(run, np.arange(run[-1] + 2))
    calibrated, own_error = slip.copy(), np.zeros_like(slip)
    shared_error = np.zeros(len(starts) - 1)
    for index in range(len(starts) - 1):
        part = slice(starts[index], starts[index + 1])
        error = noise[index] / count[part].mean()
        total = np.var(slip[part], ddof=1) if starts[index + 1] - starts[index] > 1 else 0.0
        weight = max(0.0, 1.0 - error / total) if total > 0 else 0.0
        middle = np.average(slip[part], weights=count[part])
        calibrated[part] = middle + weight * (slip[part] - middle)
        own_error[part] = weight * error
        shared_error[index] = (1 - weight) ** 2 * noise[index] / count[part].sum()
    return calibrated, own_error, shared_error


def _wander(spread: Array, count: NDArray[np.intp], run: NDArray[np.intp], noise: Array) -> Array:
    """Return the variance of the true slip within each block.

    A block whose spread stands out of the noise keeps its own; the others share their run's mean,
    because clipping each at zero would invent wander where there is only noise.
    """
    excess = np.where(count > 1, spread - noise[run], 0.0)
    shared = np.maximum(np.bincount(run, excess) / np.bincount(run), 0.0)[run]
    stands_out = excess > 3 * noise[run] * np.sqrt(2 / np.maximum(count - 1, 1))
    return np.where(stands_out, excess, shared)
