# SPDX-License-Identifier: MIT
"""Mixtures of multivariate Student-t distributions: draws, density, and a fit to weighted draws."""

from dataclasses import dataclass
from functools import cached_property
from typing import Any

import numpy as np
from scipy.linalg import solve_triangular
from scipy.special import logsumexp

from model.arrays import Array

ROUNDS = 30  # of expectation and maximisation
BEFORE = 2.0  # draws a dimension that the covariance of all draws counts as in each part's own


@dataclass(frozen=True)
class StudentMixture:
    """A mixture of Student-t distributions in d coordinates.

    Attributes:
        weights: Weight of each of k parts, with sum one, shape (k,) [-].
        centres: Their centres, shape (k, d).
        scales: Their scale matrices, shape (k, d, d).
        freedom: Their degrees of freedom, shape (k,) [-].
    """

    weights: Array
    centres: Array
    scales: Array
    freedom: Array

    @cached_property
    def _distributions(self) -> list[Any]:
        """Each part as scipy's `multivariate_t`."""
        from scipy.stats import multivariate_t  # late: takes longest of all to import

        frozen: Any = multivariate_t  # scipy's stub has the covariance as an int
        parts = zip(self.centres, self.scales, self.freedom, strict=True)
        return [frozen(centre, scale, df=freedom) for centre, scale, freedom in parts]

    def draw(self, n: int, *, rng: np.random.Generator) -> Array:
        """Draw coordinates from the mixture.

        Args:
            n: Number of draws.
            rng: Source of randomness.

        Returns:
            Coordinates in random order, shape (n, d).
        """
        counts = rng.multinomial(n, self.weights)
        parts = [
            np.reshape(part.rvs(size=count, random_state=rng), (count, -1))
            for part, count in zip(self._distributions, counts, strict=True)
            if count
        ]
        return rng.permutation(np.concatenate(parts))

    def log_pdf(self, z: Array) -> Array:
        """Compute the mixture's log density at coordinates z of shape (w, d), shape (w,)."""
        each = [np.reshape(part.logpdf(z), len(z)) for part in self._distributions]
        return np.asarray(logsumexp(np.stack(each, axis=1) + np.log(self.weights), axis=1))

    def beside(self, other: "StudentMixture", share: float) -> "StudentMixture":
        """Return the mixture of this one and another, which has the given share of the weight."""
        return StudentMixture(
            np.concatenate([(1 - share) * self.weights, share * other.weights]),
            np.concatenate([self.centres, other.centres]),
            np.concatenate([self.scales, other.scales]),
            np.concatenate([self.freedom, other.freedom]),
        )


def fit_mixture(
    z: Array, weights: Array, *, parts: int, freedom: float, rng: np.random.Generator
) -> StudentMixture:
    """Fit a mixture to weighted draws by expectation maximisation of Gaussians.

    Each part's covariance is shrunk towards that of all draws, which counts as `BEFORE` further
    draws a dimension: a covariance of few draws is too narrow where none happened to lie. The
    Student-t distributions have the means and covariances of these Gaussians.

    Args:
        z: Coordinates of the draws, shape (n, d).
        weights: Their weights, with sum one, shape (n,).
        parts: Number of parts.
        freedom: Degrees of freedom of the distributions, above 2 [-].
        rng: Source of randomness of the first centres, which are draws.
    """
    mean = weights @ z
    whole = (z - mean).T @ ((z - mean) * weights[:, None])
    centres = mean[None] if parts == 1 else z[rng.choice(len(z), parts, p=weights)]
    covariances, shares = np.tile(whole, (parts, 1, 1)), np.full(parts, 1 / parts)
    for _ in range(ROUNDS):
        log = np.stack(
            [
                np.log(share) + _log_gaussian(z - centre, covariance)
                for share, centre, covariance in zip(shares, centres, covariances, strict=True)
            ]
        )
        belongs = weights * np.exp(log - logsumexp(log, axis=0))  # (parts, n)
        total = np.maximum(belongs.sum(axis=1), 1e-12)
        shares, centres = total / total.sum(), belongs @ z / total[:, None]
        covariances = np.stack(
            [
                _shrunk_covariance(z - centre, own, whole)
                for centre, own in zip(centres, belongs, strict=True)
            ]
        )
    scales = covariances * (freedom - 2) / freedom
    return StudentMixture(shares, centres, scales, np.full(parts, float(freedom)))


def _shrunk_covariance(away: Array, weights: Array, whole: Array) -> Array:
    """Compute a part's covariance from draws less its centre, shrunk to that of all draws.

    It is that of all draws where the squares of all weights are zero.

    Args:
        away: Draws less the centre, shape (n, d).
        weights: Weight of each draw in the part, shape (n,).
        whole: Covariance of all draws, shape (d, d).
    """
    total, square = weights.sum(), weights @ weights
    if square == 0:
        return whole
    effective = total**2 / square
    own = effective / (effective + BEFORE * away.shape[1])
    return own * (away.T @ (away * weights[:, None])) / total + (1 - own) * whole


def _log_gaussian(away: Array, covariance: Array) -> Array:
    """Compute the log density of a Gaussian, but for a constant, at points (n, d) less its mean."""
    root = np.linalg.cholesky(covariance)
    # A product takes a third of the time of solving for as many points.
    scaled = away @ solve_triangular(root, np.eye(len(root)), lower=True).T
    return -0.5 * np.einsum("ni,ni->n", scaled, scaled) - np.log(np.diag(root)).sum()
