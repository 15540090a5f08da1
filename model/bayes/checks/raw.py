# SPDX-License-Identifier: MIT
"""Faults that show in single samples and not in their means: outliers, clipping, delay, sign."""

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray
from scipy.special import stdtr

from model.arrays import Array
from model.bayes.averaging.slip_noise import slip_noise_variance
from model.slip.definition import slip_per_radius_error
from model.slip.law import SlipLaw
from model.slip.samples import SlipSamples

OUTLYING = 8.0  # robust standard deviations of a run, which no Gaussian sample reaches
FARTHEST = 4.5  # standard deviations of slip noise: one sample in 150,000 lies beyond
LONG_RUN = 50  # samples, from which a run shows its own scatter
FEWEST_CLIPPED = 8
CLIPPED_EXCESS = 4.0  # samples at the extreme over samples at the next level
SLIPPING = 0.3  # of the largest traction over load: beyond, a zero error hides no sign
OPPOSED = 0.9  # share of a run's samples
PIECE = 20  # samples of the shortest piece of a run whose scatter tells how sure a delay is
FEWEST_OUTLIERS = 3
OUTLIER_SHARE = 1e-4  # of the samples


@dataclass(frozen=True)
class Outliers:
    """Samples that leap from both neighbours.

    Attributes:
        count: Number of such samples.
        share: Their share of all samples [-].
        size: Median of their absolute leaps; 0 if there are none [N].
        run: Index of the run with the most of them; 0 if there are none.
    """

    count: int
    share: float
    size: float
    run: int

    @property
    def matter(self) -> bool:
        """Whether there are `FEWEST_OUTLIERS` and `OUTLIER_SHARE` of the samples, or more."""
        return self.count >= FEWEST_OUTLIERS and self.share >= OUTLIER_SHARE


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
    leap, and no less than half of that. A leap smaller than one beside it does not count.

    Args:
        samples: The samples.
        residual: Residual of each sample, shape (n,) [N].
        by_slip: How far noise of slip may move each residual, shape (n,) [N].
    """
    leap, reach = np.zeros(len(samples)), np.zeros(len(samples))
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
    limit = np.maximum(OUTLYING * own[samples.run], reach)
    # A leap of one sample makes two of half the size, of the other sign, beside it.
    far = (size > limit) & (limit > 0) & _is_peak(size)
    count = int(far.sum())
    run = int(np.bincount(samples.run[far], minlength=samples.n_runs).argmax()) if count else 0
    typical = float(np.median(size[far])) if count else 0.0
    return Outliers(count, count / len(samples), typical, run)


def _is_peak(size: Array) -> NDArray[np.bool_]:
    """Return whether each value is no less than its neighbours, shape (n,)."""
    padded = np.concatenate([[0.0], size, [0.0]])
    return (size >= padded[:-2]) & (size >= padded[2:])


def clipped(force: Array) -> Clipped | None:
    """Find a force that stops at a limit: many samples exactly at the extreme, few just below.

    Of a cell whose readings are counts every level has many samples; at a limit there are
    `FEWEST_CLIPPED` or more, and over `CLIPPED_EXCESS` times as many as at either of the next two
    levels. A maximum counts if it is positive, a minimum if it is negative.

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
        if counts[-1] >= FEWEST_CLIPPED and counts[-1] > beside:
            return Clipped(sign * float(levels[-1]), int(counts[-1]))
    return None


@dataclass(frozen=True)
class Delay:
    """Delay of traction behind slip.

    Attributes:
        steps: Delay in samples, positive where traction comes later.
        t: Delay over its standard deviation, from the scatter between pieces of runs [-].
        p: Its two-sided p-value, by Student's t of the number of pieces that count [-].
    """

    steps: float
    t: float
    p: float


def delay(samples: SlipSamples, residual: Array, slope: Array, *, span: int) -> Delay:
    r"""Estimate the delay of traction behind slip from how residuals follow the change of slip.

    With traction late by a time d, the residual is :math:`-d\,f_\kappa\,\dot\kappa` to first order.
    Residuals are averaged over `span` samples to either side, and slip changes from the mean of
    those before to that of those after: noise of the slip sensors cancels in their product.

    Args:
        samples: The samples.
        residual: Residual of each sample, shape (n,) [N].
        slope: Slope of force in slip, shape (n,) [N].
        span: Samples to either side, at least 1.

    Returns:
        The delay; 0 with a p-value of 1 where slip changes in no run, or the runs that hold two
        windows have fewer than three pieces.
    """
    upper, lower = [], []
    window = 2 * span + 1
    change = np.concatenate([-np.ones(span), [0.0], np.ones(span)]) / (span * (span + 1))
    for part in samples.slices():
        if part.stop - part.start < 2 * window:
            continue
        rate = np.correlate(samples.slip[part], change, "valid")
        rate = rate * np.correlate(slope[part], np.ones(window) / window, "valid")
        mean = np.correlate(residual[part], np.ones(window) / window, "valid")
        mean = mean - mean.mean()
        pieces = max(1, len(mean) // max(2 * window, PIECE))
        for r, e in zip(np.array_split(rate, pieces), np.array_split(mean, pieces), strict=True):
            upper.append(-float(r @ e))
            lower.append(float(r @ r))
    u, v = np.array(upper), np.array(lower)
    if len(u) < 3 or v.sum() <= 0:
        return Delay(0.0, 0.0, 1.0)
    steps = float(u.sum() / v.sum())
    freedom = max(float(v.sum() ** 2 / np.sum(v**2)) - 1, 1.0)  # of pieces that count
    sd = float(np.sqrt(np.sum((u - steps * v) ** 2) * (freedom + 1) / freedom) / v.sum())
    t = steps / sd if sd > 0 else 0.0
    return Delay(steps, t, float(2 * stdtr(freedom, -abs(t))))


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
