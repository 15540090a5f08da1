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

from model.arrays import Array
from model.bayes.averaging.block_edges import block_starts
from model.bayes.averaging.slip_calibration import (
    calibrate_covariance,
    calibrate_slip,
    wander_within,
)
from model.bayes.averaging.slip_noise import noise_and_freedom, slip_noise_variance
from model.slip.definition import SlipDefinition
from model.slip.samples import SlipSamples


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
        load_error: Variance of the error of `normal_force`, independent between blocks, shape (n,)
            [N^2].
        noise_size: Size of the noise of traction over that of the usual run, shape (n,) [-].
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
    load_error: Array
    noise_size: Array

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
    "load_variance", "load_skewness", "slip_load_covariance", "load_error", "noise_size",
)  # fmt: skip


def block_means(samples: SlipSamples, length: int, *, wander_share: float = 0.0) -> SlipBlocks:
    """Average the samples over blocks of about `length` samples, cut by `block_starts`.

    Every sample is used. Slip is not the plain mean but that of `calibrate_slip`.

    Args:
        samples: The samples.
        length: Wanted number of samples in a block, at least 1.
        wander_share: Share of the white part of measured slip that is wander of the true slip, as
            `fast_wander` tells it [-].
    """
    white, noise_freedom = noise_and_freedom(samples)
    starts, run = block_starts(samples, length, noise=slip_noise_variance(samples))
    noise = (1 - wander_share) * white
    found = _moments(samples, starts)
    slip, load, force, count = found.slip, found.load, found.force, found.count
    spread = found.slip_square * count / np.maximum(count - 1, 1)
    load_variance = found.load_square
    calibrated, slip_error, run_slip_error = calibrate_slip(slip, count, run, noise, noise_freedom)
    covariance, covariance_error = calibrate_covariance(
        found.product, load_variance, count, run, noise, noise_freedom,
    )  # fmt: skip
    # Slope times slip is about force, so that an error of the covariance is one of slip over load.
    slip_error = slip_error + covariance_error / np.maximum(load, 1e-9) ** 2
    return SlipBlocks(
        slip=calibrated,
        normal_force=load,
        traction_force=force,
        count=count,
        run=run,
        run_names=samples.run_names,
        definition=samples.definition,
        slip_wander=wander_within(spread, count, run, noise),
        slip_error=slip_error,
        load_variance=load_variance,
        load_skewness=_skewness(found.load_third, load_variance),
        slip_load_covariance=covariance,
        run_slip_error=run_slip_error,
        load_error=np.zeros(len(load)),
        noise_size=np.ones(len(load)),
    )


@dataclass(frozen=True)
class _Moments:
    """Means of each block, and moments about them; shape (n,) each."""

    slip: Array
    load: Array
    force: Array
    count: NDArray[np.intp]
    slip_square: Array
    load_square: Array
    load_third: Array
    product: Array


def _moments(samples: SlipSamples, starts: NDArray[np.intp]) -> _Moments:
    """Compute the moments of blocks from `starts`, which ends with the number of samples."""
    count = np.diff(starts)

    def mean(values: Array) -> Array:
        """Average one value a sample over each block."""
        return np.add.reduceat(values, starts[:-1]) / count

    slip, load, force = (
        mean(values) for values in (samples.slip, samples.normal_force, samples.traction_force)
    )
    of_slip = samples.slip - np.repeat(slip, count)
    of_load = samples.normal_force - np.repeat(load, count)
    return _Moments(
        slip, load, force, count, mean(of_slip**2), mean(of_load**2), mean(of_load**3),
        mean(of_slip * of_load),
    )  # fmt: skip


def _skewness(third_moment: Array, variance: Array) -> Array:
    """Compute each block's skewness; 0 where the variance is below 1e-12 of the largest block's."""
    varies = variance > 1e-12 * variance.max(initial=1e-300)
    return np.where(varies, third_moment / np.where(varies, variance, 1.0) ** 1.5, 0.0)
