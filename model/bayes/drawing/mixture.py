# SPDX-License-Identifier: MIT
"""Mixtures of multivariate Student-t distributions over points and cases, and their fit to draws.

A case is the index of one of several densities in the same coordinates, such as that of walks with
a certain leg mounted wrongly. Where there is one density all parts have the case 0.
"""

from dataclasses import dataclass
from functools import cached_property

import numpy as np
from numpy.typing import NDArray
from scipy.special import gammaln

from model.arrays import Array

ROUNDS = 30  # of expectation and maximisation
MOST_PARTS = 3  # of a case
DRAWS_A_PART = 20.0  # effective draws that a part needs, a dimension
BEFORE = 2.0  # draws a dimension that a former covariance counts as in a new one
START_FREEDOM = 8.0  # degrees of freedom at modes [-]
FREEDOM = 20.0  # of fitted parts [-]
FREEDOM_OF_FEW = 5.0  # where fewer draws are effective than one part needs: a tail may be missing


@dataclass(frozen=True)
class StudentMixture:
    """A mixture of Student-t distributions in d coordinates, of one or several cases.

    Attributes:
        weights: Weight of each of k parts, with sum one, shape (k,) [-].
        centres: Their centres, shape (k, d).
        scales: Their scale matrices, shape (k, d, d).
        freedom: Their degrees of freedom, above 2, shape (k,) [-].
        case: Their cases, shape (k,).
    """

    weights: Array
    centres: Array
    scales: Array
    freedom: Array
    case: NDArray[np.intp]

    @cached_property
    def _roots(self) -> Array:
        """Lower Cholesky factors of the scale matrices, shape (k, d, d)."""
        return np.asarray(np.linalg.cholesky(self.scales), dtype=float)

    @cached_property
    def _whitening(self) -> Array:
        """Inverses of the Cholesky factors, transposed, shape (k, d, d)."""
        return np.swapaxes(np.linalg.inv(self._roots), 1, 2)

    @cached_property
    def _log_peaks(self) -> Array:
        """Log density of each part at its centre, times its weight, shape (k,)."""
        d, nu = self.centres.shape[1], self.freedom
        log_det = np.log(np.diagonal(self._roots, axis1=1, axis2=2)).sum(axis=1)
        constant = gammaln(0.5 * (nu + d)) - gammaln(0.5 * nu) - 0.5 * d * np.log(nu * np.pi)
        with np.errstate(divide="ignore"):  # a part may have lost all its weight
            return np.log(self.weights) + constant - log_det

    def draw(self, n: int, *, rng: np.random.Generator) -> tuple[Array, NDArray[np.intp]]:
        """Draw n points and their cases, in random order, shapes (n, d) and (n,)."""
        part = rng.choice(len(self.weights), size=n, p=self.weights)
        away = rng.standard_normal((n, self.centres.shape[1]))
        away *= np.sqrt(self.freedom[part] / rng.chisquare(self.freedom[part]))[:, None]
        return self.centres[part] + (self._roots[part] @ away[..., None])[..., 0], self.case[part]

    def log_parts(self, z: Array, case: NDArray[np.intp] | int = 0) -> Array:
        """Compute each part's log density times its weight, -inf at points of another case.

        Args:
            z: Points, shape (n, d).
            case: Case of each point, shape (n,), or of all.

        Returns:
            Log densities, shape (k, n).
        """
        away = [(z - c) @ w for c, w in zip(self.centres, self._whitening, strict=True)]
        square = np.stack([np.einsum("ni,ni->n", each, each) for each in away])
        nu = self.freedom[:, None]
        log = self._log_peaks[:, None] - 0.5 * (nu + z.shape[1]) * np.log1p(square / nu)
        return np.where(self.case[:, None] == case, log, -np.inf)

    def log_pdf(self, z: Array, case: NDArray[np.intp] | int = 0) -> Array:
        """Compute the log density at points (n, d) of cases (n,), or of one case, shape (n,)."""
        return np.asarray(np.logaddexp.reduce(self.log_parts(z, case), axis=0))

    def covariance(self, case: int) -> Array:
        """Compute the covariance of the points of one case, which has parts, shape (d, d)."""
        weights = np.where(self.case == case, self.weights, 0.0)
        weights = weights / weights.sum()
        away = self.centres - weights @ self.centres
        own = weights * self.freedom / (self.freedom - 2)
        return np.tensordot(own, self.scales, axes=1) + (away.T * weights) @ away

    def beside(self, other: "StudentMixture", share: float) -> "StudentMixture":
        """Return the mixture of this one and another, which has the given share of the weight."""
        return StudentMixture(
            np.concatenate([(1 - share) * self.weights, share * other.weights]),
            np.concatenate([self.centres, other.centres]),
            np.concatenate([self.scales, other.scales]),
            np.concatenate([self.freedom, other.freedom]),
            np.concatenate([self.case, other.case]),
        )


def start_mixture(
    centres: Array, covariances: Array, log_evidence: Array, case: NDArray[np.intp] | None = None
) -> StudentMixture:
    """Build a mixture from Gaussians at the modes of a density.

    Weights are by evidence, but at least about a tenth of an equal share.

    Args:
        centres: Modes, shape (k, d).
        covariances: Covariances there, the scale matrices of the parts, shape (k, d, d).
        log_evidence: Log of each Gaussian's integral, up to a constant, shape (k,).
        case: Case of each mode, shape (k,); all 0 when None.
    """
    share = np.exp(log_evidence - log_evidence.max())
    share = np.maximum(share / share.sum(), 0.1 / len(share))
    cases = np.zeros(len(share), dtype=np.intp) if case is None else case
    freedom = np.full(len(share), START_FREEDOM)
    return StudentMixture(share / share.sum(), centres, covariances, freedom, cases)


def fit_mixture(
    z: Array,
    case: NDArray[np.intp],
    weights: Array,
    *,
    former: StudentMixture,
    rng: np.random.Generator,
) -> StudentMixture:
    """Fit a mixture to weighted draws, in each case by expectation and maximisation.

    A case has a part for each `DRAWS_A_PART` effective draws a dimension, one at least and
    `MOST_PARTS` at most; a case whose squared weights are all zero has none.

    Args:
        z: Draws, shape (n, d).
        case: Case of each draw, shape (n,).
        weights: Weight of each draw, with sum one, shape (n,).
        former: Mixture with parts in every case, towards whose covariance in each case the new
            ones are shrunk.
        rng: Source of randomness of the first centres, which are draws.
    """
    fits = []
    for index in np.unique(case):
        own = weights[case == index]
        if own @ own > 0:
            fit = _fit_case(z[case == index], own / own.sum(), former.covariance(index), rng)
            fits.append((own.sum(), int(index), fit))
    return StudentMixture(
        np.concatenate([share * fit.weights for share, _, fit in fits]),
        np.concatenate([fit.centres for *_, fit in fits]),
        np.concatenate([fit.scales for *_, fit in fits]),
        np.concatenate([fit.freedom for *_, fit in fits]),
        np.concatenate([np.full(len(fit.weights), index) for _, index, fit in fits]),
    )


def _fit_case(
    z: Array, weights: Array, former: Array, rng: np.random.Generator
) -> StudentMixture:
    """Fit a mixture to weighted draws (n, d) of one case; arguments are those of `fit_mixture`.

    `former` is a covariance, (d, d). Each part's covariance is shrunk to that of all draws, and
    that to the former: a covariance of few draws is too narrow where none happened to lie, so that
    one later draw there outweighs all others.
    """
    parts = 1 / (weights @ weights) / (DRAWS_A_PART * z.shape[1])
    freedom = FREEDOM if parts >= 1 else FREEDOM_OF_FEW
    k = int(np.clip(parts, 1, MOST_PARTS))
    mean = weights @ z
    whole = _shrunk_covariance(z - mean, weights, former)
    centres = mean[None] if k == 1 else z[rng.choice(len(z), k, p=weights)]
    part = (freedom - 2) / freedom  # of a covariance: the scale matrix
    mixture = StudentMixture(
        np.full(k, 1 / k), centres, np.tile(part * whole, (k, 1, 1)), np.full(k, freedom),
        np.zeros(k, dtype=np.intp),
    )  # fmt: skip
    for _ in range(ROUNDS if k > 1 else 0):
        log = mixture.log_parts(z)
        belongs = weights * np.exp(log - np.logaddexp.reduce(log, axis=0))  # (k, n)
        total = np.maximum(belongs.sum(axis=1), 1e-12)
        centres = belongs @ z / total[:, None]
        covariances = [
            _shrunk_covariance(z - centre, own, whole)
            for centre, own in zip(centres, belongs, strict=True)
        ]
        mixture = StudentMixture(
            total / total.sum(), centres, part * np.stack(covariances), mixture.freedom,
            mixture.case,
        )  # fmt: skip
    return mixture


def _shrunk_covariance(away: Array, weights: Array, former: Array) -> Array:
    """Compute a covariance from weighted draws less their mean, shrunk towards a former one.

    The former, (d, d), counts as `BEFORE` further draws a dimension; it is returned where the
    squares of all weights are zero.

    Args:
        away: Draws less their mean, shape (n, d).
        weights: Weight of each draw, shape (n,).
        former: The covariance before.
    """
    total, square = weights.sum(), weights @ weights
    if square == 0:
        return former
    effective = total**2 / square
    own = effective / (effective + BEFORE * away.shape[1])
    return own * (away.T @ (away * weights[:, None])) / total + (1 - own) * former
