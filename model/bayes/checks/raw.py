# SPDX-License-Identifier: MIT
"""Faults that show in single samples and not in their means."""

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from model.arrays import Array
from model.bayes.averaging.slip_noise import slip_noise_variance
from model.slip.definition import slip_per_radius_error
from model.slip.law import SlipLaw
from model.slip.samples import SlipSamples

OUTLYING = 8.0  # robust standard deviations of a run, which no Gaussian sample reaches
OUTLYING_MEAN = 6.0  # of a table of means, whose rows are few
FARTHEST = 4.5  # standard deviations of slip noise: one sample in 150,000 lies beyond
LONG_RUN = 50  # samples, from which a run shows its own scatter
FEWEST_CLIPPED = 8
FEWEST_CLIPPED_MEANS = 4  # of a table of up to `FEW_ROWS` means, which hardly repeat
FEW_ROWS = 300
CLIPPED_EXCESS = 4.0  # samples at the extreme over samples at the next level
SLIPPING = 0.3  # of the largest traction over load: beyond, a zero error hides no sign
OPPOSED = 0.9  # share of a run's samples
STRETCH = 6  # equal successive samples that are looked at
UNLIKELY = 4.0  # times as many such stretches as by chance
PROMINENT = 30.0  # times the power of the frequencies beside
LARGE, LARGE_PERIODS = 15.0, 3  # the same, and periods in a run, of a large swing
LARGE_SWING = 0.2  # amplitude over traction of these
LEAST_SWING = 0.01  # amplitude over traction
FEWEST_SWINGING = 3  # runs
FEWEST_PERIODS = 4  # in a run: slower noise is stronger, too
STEADY = 0.1  # change of slip within a run that is no sweep, over the largest slip


@dataclass(frozen=True)
class Outliers:
    """Samples that leap from both neighbours.

    Attributes:
        count: Number of such samples.
        share: Their share of all samples [-].
        size: Median of their absolute leaps; 0 if there are none [N].
        runs: Indices of the runs that have some, those with the most first.
    """

    count: int
    share: float
    size: float
    runs: tuple[int, ...]


@dataclass(frozen=True)
class Clipped:
    """Samples of a force that lie at its extreme.

    Attributes:
        limit: The extreme [N].
        count: Number of samples exactly there.
    """

    limit: float
    count: int


def raw_residuals(samples: SlipSamples, law: SlipLaw, values: Array) -> tuple[Array, Array]:
    """Compute measured minus predicted traction of each sample, and the slope of force in slip.

    Noise of the slip sensors is not taken out, so that residuals scatter by slope times noise.

    Args:
        samples: The samples, n of them.
        law: The slip law, of k parameters.
        values: Law and measurement parameters, shape (k + 11,).

    Returns:
        Residuals and slopes, shape (n,) each [N].
    """
    k = len(law.parameters)
    g_t, c_r = values[k], values[k + 5]
    slip, load = _corrected(samples, values[k : k + 6])
    force = (1 + g_t) * (law.force(slip, load, values[:k]) - c_r * load)
    slope = (1 + g_t) * law.slip_derivative(slip, load, values[:k])
    return samples.traction_force - force, np.broadcast_to(slope, force.shape)


def reach_of_slip_noise(samples: SlipSamples, law: SlipLaw, values: Array) -> Array:
    """Compute how far noise of the slip sensors may move the residual of each sample.

    It is the larger change of force over 4.5 standard deviations of slip on either side. The slope
    would do where the curve is straight; at its peak the slope is zero, and noise that carries
    slip over the peak moves the force all the same.

    Args:
        samples: The samples, n of them.
        law: The slip law, of k parameters.
        values: Law and measurement parameters, shape (k + 11,).

    Returns:
        Changes of force, shape (n,) [N].
    """
    k = len(law.parameters)
    slip, load = _corrected(samples, values[k : k + 6])
    reach = FARTHEST * np.sqrt(slip_noise_variance(samples))[samples.run]
    force = law.force(slip, load, values[:k])
    low, high = (law.force(slip + sign * reach, load, values[:k]) for sign in (-1, 1))
    return (1 + values[k]) * np.maximum(np.abs(low - force), np.abs(high - force))


def _corrected(samples: SlipSamples, measurement: Array) -> tuple[Array, Array]:
    """Correct slip [-] and load [N] by the errors of radius and load cell, shape (n,) each."""
    _, g_n, b_n, c, epsilon, _ = measurement
    slip = samples.slip - epsilon * slip_per_radius_error(samples.slip, samples.definition)
    load = (1 + g_n) * samples.normal_force - b_n + c * samples.traction_force
    return slip, np.maximum(load, 1e-9)


def outliers(samples: SlipSamples, residual: Array, by_slip: Array) -> Outliers:
    """Find samples whose residual leaps from both neighbours by more than noise makes.

    A leap is the residual less the mean of its neighbours. It is too large beyond `OUTLYING` robust
    deviations and beyond the reach of slip noise in the three. A robust deviation is 1.4826 times
    the median absolute leap of the run or, of runs shorter than `LONG_RUN`, of all samples that
    leap, and no less than half of that. A leap smaller than one beside it does not count. Of means
    of trials, which have no neighbours, the residual itself less the median one is the leap.

    Args:
        samples: The samples.
        residual: Residual of each sample, shape (n,) [N].
        by_slip: How far noise of slip may move each residual, shape (n,) [N].
    """
    leap, reach = np.zeros(len(samples)), np.zeros(len(samples))
    if len(samples) <= 2 * samples.n_runs:  # means of trials: those of a curve stand alone
        leap = residual - np.median(residual)
    for part in samples.slices():
        own, square = residual[part], by_slip[part] ** 2
        if len(own) > 2:
            leap[part][1:-1] = own[1:-1] - 0.5 * (own[2:] + own[:-2])
            reach[part][1:-1] = np.sqrt(square[1:-1] + 0.25 * (square[2:] + square[:-2]))
    size = np.abs(leap)
    long = np.array([part.stop - part.start >= LONG_RUN for part in samples.slices()])
    every = 1.4826 * float(np.median(size[leap != 0])) if leap.any() else 0.0
    own = np.array([1.4826 * np.median(size[part]) for part in samples.slices()])
    own = np.where(long, np.maximum(own, 0.5 * every), every)
    means = len(samples) <= 2 * samples.n_runs
    limit = np.maximum((OUTLYING_MEAN if means else OUTLYING) * own[samples.run], reach)
    # A leap of one sample makes two of half the size, of the other sign, beside it.
    far = (size > limit) & (limit > 0) & (_is_peak(size) | means)
    count = np.bincount(samples.run[far], minlength=samples.n_runs)
    runs = [int(i) for i in np.argsort(-count, kind="stable") if count[i]]
    typical = float(np.median(size[far])) if runs else 0.0
    return Outliers(int(far.sum()), float(np.mean(far)), typical, tuple(runs))


def _is_peak(size: Array) -> NDArray[np.bool_]:
    """Return whether each value is no less than its neighbours, shape (n,)."""
    padded = np.concatenate([[0.0], size, [0.0]])
    return (size >= padded[:-2]) & (size >= padded[2:])


def clipped(force: Array) -> Clipped | None:
    """Find a force that stops at a limit: many samples exactly at the extreme, few just below.

    Of a cell whose readings are counts every level has many samples; at a limit there are
    `FEWEST_CLIPPED` or more, or `FEWEST_CLIPPED_MEANS` of few, and over `CLIPPED_EXCESS` times as
    many as at either of the next two levels. A maximum counts if it is positive, a minimum if it is
    negative.

    Args:
        force: Measured force of each sample, shape (n,) [N].

    Returns:
        The samples at the upper limit, or else at the lower; None if there is no limit, or the
        force has fewer than three levels.
    """
    for sign in (1.0, -1.0):
        levels, counts = np.unique(sign * force, return_counts=True)
        if len(levels) < 3 or levels[-1] <= 0:
            continue
        beside = CLIPPED_EXCESS * counts[-3:-1].max()
        fewest = FEWEST_CLIPPED if len(force) > FEW_ROWS else FEWEST_CLIPPED_MEANS
        if counts[-1] >= fewest and counts[-1] > beside:
            return Clipped(sign * float(levels[-1]), int(counts[-1]))
    return None


def frozen(force: Array, run: NDArray[np.intp]) -> float:
    """Compute the share of samples in stretches of equal values that chance does not make [-].

    Readings of a coarse converter repeat too: with the share e of equal neighbours, a stretch of
    `STRETCH` or more has the probability e to the power of its length. The share counts where such
    stretches are `UNLIKELY` by that.

    Args:
        force: Measured force, shape (n,) [N].
        run: Run of each sample, shape (n,).
    """
    same = (np.diff(force) == 0) & (np.diff(run) == 0)
    edges = np.flatnonzero(np.diff(np.concatenate([[0], same.astype(int), [0]])))
    lengths = edges[1::2] - edges[::2] + 1 if len(edges) else np.array([0])
    long = lengths[lengths >= STRETCH]
    short = lengths[lengths < STRETCH]
    pairs = max(len(same) - int(np.sum(long - 1)), 1)
    equal = (float(np.sum(np.maximum(short - 1, 0))) + 1) / pairs
    expected = len(force) * equal ** (STRETCH - 1)
    return float(np.sum(long)) / len(force) if len(long) > UNLIKELY * (1 + expected) else 0.0


@dataclass(frozen=True)
class Oscillation:
    """Oscillation of traction within runs.

    Attributes:
        amplitude: Amplitude over the traction, of the middle run that oscillates [-].
        frequency: Its frequency, in Hz where there are times, else in periods a sample.
        runs: Number of runs that oscillate.
        in_slip: Whether measured slip swings alike, or the force follows the slope of the curve
            rather than its height: it is the slip that swings.
    """

    amplitude: float
    frequency: float
    runs: int
    in_slip: bool


def oscillation(samples: SlipSamples, residual: Array, slope: Array) -> Oscillation | None:
    """Find an oscillation of traction within runs; None unless `FEWEST_SWINGING` have one.

    A run oscillates where a frequency has `PROMINENT` times the power of those beside it, more than
    noise of any memory has at one of them, and the amplitude is `LEAST_SWING` of its traction.

    Args:
        samples: The samples, n of them.
        residual: Measured minus predicted traction, shape (n,) [N].
        slope: Slope of the curve in slip, shape (n,) [N].
    """
    found = [
        swing
        for part in samples.slices()
        if (swing := _swing(samples, residual, slope, part)) is not None
    ]
    if len(found) < max(FEWEST_SWINGING, 0.1 * samples.n_runs):
        return None
    amplitude, level, steep, by_slip, frequency = np.array(found).T
    follows = _spread(amplitude / level) > _spread(amplitude / np.maximum(steep, 1e-300))
    in_slip = bool(np.median(by_slip / amplitude) > 0.5 or follows)
    return Oscillation(
        float(np.median(amplitude / level)), float(np.median(frequency)), len(found), in_slip
    )


def _swing(
    samples: SlipSamples, residual: Array, slope: Array, part: slice
) -> tuple[float, float, float, float, float] | None:
    """Return amplitude, mean traction, slope, amplitude by slip [N] and frequency of a run's swing.

    None where it has none, and in sweeps. The amplitude is half of what 95 % of the residuals span.
    """
    n = part.stop - part.start
    window, trend = np.hanning(n), np.linspace(-1, 1, n)
    swept = 2 * abs(np.polyfit(trend, samples.slip[part], 1)[0]) if n > 1 else 0.0
    if n < LONG_RUN or max(swept, np.std(samples.slip[part])) > STEADY * np.abs(samples.slip).max():
        return None

    def detrended(values: Array) -> Array:
        """Subtract the quadratic trend over the run from values, shape (n,)."""
        return values - np.polyval(np.polyfit(trend, values, 2), trend)

    force = detrended(residual[part])
    spectrum = np.abs(np.fft.rfft(force * window)) ** 2
    height = spectrum / _beside(spectrum)
    height[:LARGE_PERIODS] = 0
    top = int(np.argmax(height))
    span, level = (
        np.quantile(force, [0.025, 0.975]),
        float(np.mean(np.abs(samples.traction_force[part]))),
    )
    amplitude = 0.5 * float(span[1] - span[0])
    large = amplitude >= LARGE_SWING * level
    needed, first = (LARGE, LARGE_PERIODS) if large else (PROMINENT, FEWEST_PERIODS)
    if height[top] < needed or top < first or level == 0 or amplitude < LEAST_SWING * level:
        return None
    fine = top + np.linspace(-1, 1, 41)
    waves = np.exp(-2j * np.pi * np.outer(fine, np.arange(n)) / n)
    best = int(np.argmax(np.abs(waves @ (force * window))))
    slip = 2 * abs(waves[best] @ (detrended(samples.slip[part]) * window)) / window.sum()
    steep = float(np.mean(np.abs(slope[part])))
    step = 1.0 if samples.time is None else float(np.median(np.diff(samples.time[part])))
    return amplitude, level, steep, float(slip) * steep, float(fine[best]) / n / step


def _beside(spectrum: Array) -> Array:
    """Return the typical power of 12 frequencies beside each one but its two neighbours, (n,)."""
    padded = np.pad(spectrum, 8, mode="reflect" if len(spectrum) > 8 else "edge")
    windows = np.lib.stride_tricks.sliding_window_view(padded, 17)
    beside = np.concatenate([windows[:, :6], windows[:, -6:]], axis=1)
    return np.maximum(np.median(beside, axis=1) / np.log(2), 1e-300)


def _spread(ratio: Array) -> float:
    """Return the spread of the logarithm of ratios [-]."""
    return float(np.std(np.log(np.maximum(ratio, 1e-300))))


def opposed_runs(samples: SlipSamples) -> NDArray[np.bool_]:
    """Find runs whose traction opposes their slip, shape (n_runs,).

    Only samples whose traction over load is beyond `SLIPPING` of the largest (the 95 % quantile)
    count, so that zero errors of slip or force hide no sign. They have to be half of a run's
    samples or more, and their slip and traction of unlike signs in more than `OPPOSED` of them.

    Args:
        samples: The samples.
    """
    ratio = np.abs(samples.traction_force) / np.maximum(np.abs(samples.normal_force), 1e-9)
    large = ratio > SLIPPING * np.quantile(ratio, 0.95)
    against = samples.slip * samples.traction_force < 0
    n_large = np.bincount(samples.run[large], minlength=samples.n_runs)
    n_against = np.bincount(samples.run[large & against], minlength=samples.n_runs)
    long = np.bincount(samples.run, minlength=samples.n_runs)
    return (n_against > OPPOSED * n_large) & (n_large >= np.maximum(1, 0.5 * long))
