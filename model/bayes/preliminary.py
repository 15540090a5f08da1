# SPDX-License-Identifier: MIT
"""Choice of how many samples are averaged in a block, by the residuals of a plain fit."""

from dataclasses import dataclass

import numpy as np

from model.arrays import Array
from model.bayes.averaging.blocks import block_means
from model.bayes.averaging.fast_wander import FastWander, fast_wander
from model.bayes.averaging.slip_noise import slip_noise_variance
from model.bayes.plain.fit import PlainFit
from model.slip.samples import SlipSamples

MAX_BLOCKS = 3000  # largest number of blocks
MAX_SLIP_SPREAD = 0.45  # of the slip scale within a block; more, and the quadrature is biased
MIN_BLOCKS_PER_RUN = 5
MOST_SETTLED = 6000  # blocks, from which on no more are tried
MOVED = 0.2  # of a standard deviation, by which averaging may move the plain fit
AVERAGED_OUT = "to average out the slip sensors' noise"
MEMORIES = 2  # correlation times in a block: means over shorter ones are not an AR(1) process


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
        plain: The plain fit, which tells loads and noise of runs; None where each law's own does.
    """

    length: int
    correlation: float | None
    reason: str
    wander: FastWander | None = None
    plain: PlainFit | None = None

    @property
    def wander_share(self) -> float:
        """Share of the white part of slip that blocks take for wander [-]."""
        return 0.0 if self.wander is None else self.wander.used


def choose_block_length(
    samples: SlipSamples, plain: PlainFit, *, length: int | None = None
) -> BlockChoice:
    """Choose how many samples to average in a block, from the residuals of a plain fit.

    A block is at least `MEMORIES` autocorrelation times of the residuals long, long enough that the
    slip sensors' noise averages to a tenth of the curve's slip scale (the slip at which its initial
    slope reaches its largest force), and that there are at most 3,000 blocks. The slip sensors'
    white noise is no part of that time: the likelihood has it apart. What it does to the answer
    overrides these: a run of median length keeps 5 blocks, the standard deviation of true slip in
    nine of ten blocks is at most 0.45 slip scales, and averaging the plain fit's own curve moves
    its slope and force by less than `MOVED` of their standard deviation; down to single samples.

    Args:
        samples: The samples.
        plain: The plain fit of them.
        length: The length where it is not to be chosen, but only the noise of slip looked at.
    """
    run_length = int(np.median([part.stop - part.start for part in samples.slices()]))
    longest = max(1, run_length // MIN_BLOCKS_PER_RUN)
    slip = plain.true_slip(samples.slip)
    residual = plain.residual(samples.slip, samples.normal_force, samples.traction_force)
    slip_noise = slip_noise_variance(samples)
    slope = plain.law.slip_derivative(slip, samples.normal_force, plain.values)
    wander = fast_wander(samples, residual, slope)
    if length is not None:
        return BlockChoice(length, None, "as asked for", wander, plain)
    correlation = correlation_time(
        residual, samples.slices(), white=slope**2 * slip_noise[samples.run]
    )
    slip_scale = plain.slip_scale
    noise = float(np.median(slip_noise))
    wanted = {
        "twice the correlation time of the noise": int(np.ceil(MEMORIES * correlation)),
        AVERAGED_OUT: max(1, int(np.ceil(noise * (10 / slip_scale) ** 2))),
        f"at most {MAX_BLOCKS} blocks": int(np.ceil(len(samples) / MAX_BLOCKS)),
    }
    reason, chosen = max(wanted.items(), key=lambda item: item[1])
    if chosen > longest:
        reason, chosen = f"at least {MIN_BLOCKS_PER_RUN} blocks a run", longest
    steady = _steady_length(samples, chosen, MAX_SLIP_SPREAD * slip_scale)
    if steady < chosen:
        reason, chosen = "so that slip changes little within a block", steady
    settled = _settled_length(samples, plain, chosen, wanted[AVERAGED_OUT])
    if settled < chosen:
        reason, chosen = "so that averaging hardly moves the plain fit", settled
    return BlockChoice(chosen, correlation, reason, wander, plain)


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


def _settled_length(samples: SlipSamples, plain: PlainFit, length: int, least: int) -> int:
    """Halve a block length until averaging moves the plain fit by less than `MOVED`, or it is 1.

    Args:
        samples: The samples.
        plain: The plain fit of them.
        length: Number of samples in a block to start from.
        least: Number of samples in the mean of which the noise of slip is small; slip without
            noise is interpolated between these means.
    """
    if plain.of_run_means or not len(plain.draws):
        return length
    slip = np.empty(len(samples))
    for part in samples.slices():
        own, n = samples.slip[part], part.stop - part.start
        edges = np.linspace(0, n, max(1, n // least) + 1).astype(int)
        means = np.add.reduceat(own, edges[:-1]) / np.diff(edges)
        slip[part] = np.interp(np.arange(n), 0.5 * (edges[1:] + edges[:-1] - 1), means)
    while length > 1:
        blocks = block_means(samples, length)
        if len(blocks) > MOST_SETTLED or plain.moved_by_averaging(slip, blocks) < MOVED:
            break
        length = length // 2
    return length
