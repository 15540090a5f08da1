# SPDX-License-Identifier: MIT
"""Tests of the uniformity of ranks: chi-square of a histogram, and the ECDF in a simultaneous band.

The band is that of Säilynoja, Bürkner and Vehtari (2022), "Graphical test for discrete uniformity
and its applications in goodness-of-fit evaluation and multiple sample comparison", Statistics and
Computing 32: pointwise binomial intervals whose common level is such that the whole empirical
distribution function lies inside with a stated probability. That probability is computed exactly.
"""

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray
from scipy.special import bdtr, bdtrc, chdtrc, gammaln

from model.arrays import Array

DRAWS = 99
"""Draws that a true value is ranked among, so that ranks are 0 to 99."""
BINS = 20
"""Bins of the histogram, of five ranks each."""
_HALVINGS = 25


@dataclass(frozen=True)
class Band:
    """Simultaneous band of the number of ranks that are at most r.

    Attributes:
        ranks: The ranks r, shape (m,).
        low: Least number inside the band, shape (m,).
        high: Largest number inside the band, shape (m,).
        n: Number of ranks.
    """

    ranks: NDArray[np.intp]
    low: NDArray[np.intp]
    high: NDArray[np.intp]
    n: int

    @property
    def expected(self) -> Array:
        """Share of uniform ranks that is at most r, shape (m,) [-]."""
        return (self.ranks + 1) / (DRAWS + 1)


def histogram(ranks: NDArray[np.intp]) -> NDArray[np.intp]:
    """Count ranks from 0 to `DRAWS` in `BINS` equal bins, shape (BINS,)."""
    return np.bincount(ranks * BINS // (DRAWS + 1), minlength=BINS)


def chi_square_p(ranks: NDArray[np.intp]) -> float:
    """Compute the p-value of the chi-square of the histogram against equal bins.

    Args:
        ranks: Ranks from 0 to `DRAWS`, shape (n,), n at least 1.

    >>> round(chi_square_p(np.arange(100)), 3)
    1.0
    """
    expected = len(ranks) / BINS
    return float(chdtrc(BINS - 1, np.sum((histogram(ranks) - expected) ** 2) / expected))


def cumulative(ranks: NDArray[np.intp]) -> NDArray[np.intp]:
    """Count the ranks that are at most r, for r from 0 to `DRAWS` - 1, shape (DRAWS,)."""
    return np.cumsum(np.bincount(ranks, minlength=DRAWS + 1))[:DRAWS]


def ecdf_p(ranks: NDArray[np.intp]) -> float:
    """Compute the probability that uniform ranks leave a band that these ranks just touch.

    Args:
        ranks: Ranks from 0 to `DRAWS`, shape (n,), n at least 1.
    """
    found, n = cumulative(ranks), len(ranks)
    level = float(np.min(_two_sided(n)[np.arange(DRAWS), found]))
    # Just below, so that the band excludes counts as improbable as the most improbable of these.
    return max(0.0, 1 - _inside_probability(_band_of(n, level * (1 + 1e-9))))


def simultaneous_band(n: int, level: float) -> Band:
    """Return the band that the cumulative counts of n uniform ranks leave with a probability.

    Args:
        n: Number of ranks.
        level: Probability with which they leave it at least once, at most [-].
    """
    low, high = 0.0, 1.0  # pointwise levels: the band of the lower one is too wide
    for _ in range(_HALVINGS):
        middle = np.sqrt(max(low, 1e-12) * high)
        kept = 1 - _inside_probability(_band_of(n, middle)) <= level
        low, high = (middle, high) if kept else (low, middle)
    return _band_of(n, low)


def _two_sided(n: int) -> Array:
    """Return the two-sided binomial p-value of each count 0 to n up to each rank, (DRAWS, n+1)."""
    p = (np.arange(DRAWS)[:, None] + 1) / (DRAWS + 1)
    count = np.arange(n + 1)
    upper = np.where(count > 0, bdtrc(np.maximum(count - 1, 0), n, p), 1.0)
    return np.minimum(2 * np.minimum(bdtr(count, n, p), upper), 1.0)


def _band_of(n: int, level: float) -> Band:
    """Return the pointwise intervals of counts of a two-sided p-value of at least `level`."""
    inside = _two_sided(n) >= level
    inside[np.arange(DRAWS), np.round(n * (np.arange(DRAWS) + 1) / (DRAWS + 1)).astype(int)] = True
    low = np.argmax(inside, axis=1)
    high = n - np.argmax(inside[:, ::-1], axis=1)
    return Band(np.arange(DRAWS), low, high, n)


def _inside_probability(band: Band) -> float:
    """Compute the probability that cumulative counts of uniform ranks stay inside a band.

    The count is a Markov chain in r: of the ranks above r - 1 each equals r with the same
    probability.
    """
    chance = np.zeros(band.n + 1)
    chance[0] = 1.0  # before the first rank
    states = np.array([0])
    for step in range(len(band.ranks)):
        reached = np.arange(band.low[step], band.high[step] + 1)
        share = 1 / (DRAWS + 1 - step)
        chance = chance[: len(states)] @ _binomial(
            band.n - states, share, reached - states[:, None]
        )
        states = reached
    return float(chance.sum())


def _binomial(n: NDArray[np.intp], p: float, k: NDArray[np.intp]) -> Array:
    """Compute the binomial probabilities of counts k (s, t) in n (s,) trials, zero outside."""
    trials = n[:, None]
    possible = (k >= 0) & (k <= trials)
    kept = np.where(possible, k, 0)
    log = gammaln(trials + 1) - gammaln(kept + 1) - gammaln(trials - kept + 1)
    return np.where(possible, np.exp(log + kept * np.log(p) + (trials - kept) * np.log1p(-p)), 0.0)
