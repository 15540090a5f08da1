# SPDX-License-Identifier: MIT
"""Preliminary least-squares fit: starting points, and choice of the block length."""

from dataclasses import dataclass

import numpy as np
from scipy.optimize import least_squares

from model.arrays import Array
from model.bayes.averaging.blocks import SlipBlocks, block_means
from model.bayes.averaging.fast_wander import FastWander, fast_wander
from model.bayes.averaging.slip_noise import slip_noise_variance
from model.bayes.priors import Prior
from model.errors import FitError
from model.slip.law import SlipLaw
from model.slip.samples import SlipSamples

N_TRIALS = 400  # prior draws that are tried as starts
N_CLIMBS = 5  # best of them that are optimised
MAX_BLOCKS = 3000  # largest number of blocks
MAX_SLIP_SPREAD = 0.45  # of the slip scale within a block; more, and the quadrature is biased
MIN_BLOCKS_PER_RUN = 5
MEMORIES = 2  # correlation times in a block: means over shorter ones are not an AR(1) process


def least_squares_values(
    blocks: SlipBlocks, law: SlipLaw, *, priors: dict[str, Prior], rng: np.random.Generator
) -> Array:
    """Fit a law's parameters to block means by robust least squares from many starts.

    Of `N_TRIALS` prior draws and the prior median, as far as valid, the best `N_CLIMBS` are
    optimised. Of the valid results, and the best draw, the one with the least sum of absolute
    scaled residuals and coordinates is returned.

    Args:
        blocks: The block means.
        law: The slip law.
        priors: Priors of the law's parameters by name; they regularise weakly.
        rng: Source of randomness of the starting points, which are prior draws.

    Returns:
        Values of the law's k parameters, valid at the measured loads, shape (k,).

    Raises:
        FitError: No prior draw is valid at the measured loads, or a residual overflowed.
    """
    chosen = [priors[p.name] for p in law.parameters]
    scale = float(np.std(blocks.traction_force)) / 20

    def values(z: Array) -> Array:
        """Map coordinates z (k,) to values of the law's parameters (k,)."""
        return np.array([prior.value(x) for prior, x in zip(chosen, z, strict=True)])

    def misfit(z: Array) -> Array:
        """Return the n scaled residuals, then z, standard normal a priori, shape (n + k,)."""
        with np.errstate(all="ignore"):
            force = law.force(blocks.slip, blocks.normal_force, values(z))
        # A trial may be beyond all numbers: NaN counts as no force, infinity as the largest float.
        return np.append((blocks.traction_force - np.nan_to_num(force)) / scale, z)

    def valid(z: Array) -> bool:
        """Return whether the law is valid at z at each of `loads`."""
        with np.errstate(all="ignore"):
            return bool(np.all(law.valid(loads, values(z))))

    loads = np.quantile(blocks.normal_force, [0.0, 0.25, 0.5, 0.75, 1.0])
    trials = np.vstack([np.zeros(len(chosen)), rng.standard_normal((N_TRIALS, len(chosen)))])
    ranked = sorted(filter(valid, trials), key=lambda z: float(np.abs(misfit(z)).sum()))
    if not ranked:
        raise FitError(
            f"no parameters within the priors of the law '{law.name}' are valid at loads of "
            f"{loads[0]:g} to {loads[-1]:g} N; check the unit of the load"
        )
    try:
        climbs = [
            least_squares(misfit, z, loss="soft_l1", max_nfev=100).x for z in ranked[:N_CLIMBS]
        ]
    except ValueError as error:  # raised by scipy where a residual overflows
        raise FitError(
            f"no curve of '{law.name}' comes near a traction force of up to "
            f"{np.abs(blocks.traction_force).max():.3g} N at loads of {loads[0]:.3g} to "
            f"{loads[-1]:.3g} N ({error}); check their units"
        ) from error
    candidates = [*filter(valid, climbs), ranked[0]]
    return values(min(candidates, key=lambda z: float(np.abs(misfit(z)).sum())))


def correlation_time(residual: Array, slices: list[slice], *, white: Array) -> float:
    """Estimate the integrated autocorrelation time of residuals, run means removed [samples].

    One plus twice the sum of the autocorrelation pooled over runs, up to Sokal's window (the first
    lag of at least five times the sum so far). At least 1, the value of white noise. A known white
    part of the residual does not count: it would hide the correlation of the rest. Residuals are
    scaled down where it is large, or few runs of much white noise would outweigh all others.

    Args:
        residual: Residual of each sample, shape (n,).
        slices: Range of each run's samples.
        white: Variance of the known white part of each residual, shape (n,).
    """
    centred = [residual[part] - residual[part].mean() for part in slices]
    neighbours = np.median([np.mean(own[1:] * own[:-1]) for own in centred if len(own) > 1] or [0])
    variance = max(float(neighbours), 1e-3 * float(np.mean(residual**2))) + white
    if not variance.all():
        return 1.0
    total = np.zeros(max(len(own) for own in centred))
    for own, part in zip(centred, slices, strict=True):
        spectrum = np.fft.rfft(own / np.sqrt(variance[part]), 2 * len(own))
        total[: len(own)] += np.fft.irfft(np.abs(spectrum) ** 2)[: len(own)]
    total[0] -= np.sum(white / variance)
    total[0] = max(total[:2])  # no variance is below the covariance of neighbours
    if total[0] <= 0:
        return 1.0
    time = 2 * np.cumsum(total / total[0]) - 1
    beyond = np.arange(len(time)) >= 5 * time
    window = int(np.argmax(beyond)) if beyond.any() else len(time) - 1
    return max(1.0, float(time[window]))


@dataclass(frozen=True)
class BlockChoice:
    """How samples become blocks: the length with the reason for it, and what their noise is.

    Attributes:
        length: Wanted number of samples in a block.
        correlation: Integrated autocorrelation time of the residuals; None if the length was
            given [samples].
        reason: Text of a few words: the criterion that determined the length.
        wander: How much of the white part of slip is wander of the true slip, by the force; None
            where nothing tells it.
    """

    length: int
    correlation: float | None
    reason: str
    wander: FastWander | None = None

    @property
    def wander_share(self) -> float:
        """Share of the white part of slip that blocks take for wander [-]."""
        return 0.0 if self.wander is None else self.wander.used


def choose_block_length(
    samples: SlipSamples,
    law: SlipLaw,
    *,
    priors: dict[str, Prior],
    rng: np.random.Generator,
    length: int | None = None,
) -> BlockChoice:
    """Choose how many samples to average in a block, from residuals of a preliminary fit.

    A block is at least `MEMORIES` autocorrelation times of the residuals long, long enough that the
    slip sensors' noise averages to a tenth of the curve's slip scale (the slip at which its initial
    slope reaches its largest force), and that there are at most 3,000 blocks. The slip sensors'
    white noise is no part of that time: the likelihood has it apart. Two limits override these: a
    run of median length keeps 5 blocks, and the standard deviation of true slip in nine of ten
    blocks is at most 0.45 slip scales. The length is 1 at least.

    Args:
        samples: The samples.
        law: The slip law of the preliminary fit.
        priors: Priors of the law's parameters by name.
        rng: Source of randomness of the preliminary fit.
        length: The length where it is not to be chosen, but only the noise of slip looked at.

    Raises:
        FitError: The preliminary fit failed, as `least_squares_values` says.
    """
    run_length = int(np.median([part.stop - part.start for part in samples.slices()]))
    longest = max(1, run_length // MIN_BLOCKS_PER_RUN)
    coarse = block_means(samples, max(1, min(longest, len(samples) // 1000)))
    values = least_squares_values(coarse, law, priors=priors, rng=rng)
    residual = samples.traction_force - law.force(samples.slip, samples.normal_force, values)
    slip_noise = slip_noise_variance(samples)
    slope = law.slip_derivative(samples.slip, samples.normal_force, values)
    wander = fast_wander(samples, residual, slope)
    if length is not None:
        return BlockChoice(length, None, "as asked for", wander)
    correlation = correlation_time(
        residual, samples.slices(), white=slope**2 * slip_noise[samples.run]
    )
    slip_scale = _slip_scale(law, values, float(np.median(samples.normal_force)))
    noise = float(np.median(slip_noise))
    wanted = {
        "twice the correlation time of the noise": int(np.ceil(MEMORIES * correlation)),
        "to average out the slip sensors' noise": int(np.ceil(noise * (10 / slip_scale) ** 2)),
        f"at most {MAX_BLOCKS} blocks": int(np.ceil(len(samples) / MAX_BLOCKS)),
    }
    reason, chosen = max(wanted.items(), key=lambda item: item[1])
    if chosen > longest:
        reason, chosen = f"at least {MIN_BLOCKS_PER_RUN} blocks a run", longest
    steady = _steady_length(samples, chosen, MAX_SLIP_SPREAD * slip_scale)
    if steady < chosen:
        reason, chosen = "so that slip changes little within a block", steady
    return BlockChoice(chosen, correlation, reason, wander)


def _slip_scale(law: SlipLaw, values: Array, load: float) -> float:
    """Compute the slip at which a line of the initial slope reaches the largest force [-].

    That is the largest force at slip ratios of 1e-4 to 1.

    Args:
        law: The slip law.
        values: Parameters of the law, shape (k,).
        load: Normal force [N].
    """
    slip = np.geomspace(1e-4, 1.0, 200)
    largest = float(np.max(law.force(slip, load, values)))
    return largest / float(law.slip_derivative(0.0, load, values))


def _steady_length(samples: SlipSamples, length: int, largest_spread: float) -> int:
    """Halve a block length until true slip varies little within nine of ten blocks, or it is 1.

    Args:
        samples: The samples.
        length: Number of samples in a block to start from, the longest.
        largest_spread: Limit of the slip's standard deviation within a block [-].
    """
    while length > 1:
        wander = np.sqrt(block_means(samples, length).slip_wander)
        if np.quantile(wander, 0.9) <= largest_spread:
            break
        length = max(1, length // 2)
    return length
