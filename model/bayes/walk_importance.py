# SPDX-License-Identifier: MIT
r"""Draws of what walks say, by adaptive importance sampling from the Gaussians at its modes.

A gait whose legs take over from each other at equal heights sits on a kink: a common offset or a
longer arc lengthens the steps to one side and does nothing to the other. So no Gaussian is the
posterior. Draws from Student's t around each mode, then around the weighted draws themselves, round
after round, are weighted by the density they have over that which they were drawn from,

.. math::
    w_i \propto p(x_i) / \sum_k q_k(x_i) .
"""

from collections.abc import Callable, Sequence
from dataclasses import dataclass, replace

import numpy as np
from numpy.typing import NDArray
from scipy.stats import multivariate_t

from model.bayes.walk_prior import Case
from model.slip.law import Array

DRAWS = 200  # a round
MOST_ROUNDS = 8
WANTED = 120.0  # effective draws
TAIL = 5  # degrees of freedom of what is drawn from
ENOUGH = 60.0  # effective draws that a round's Gaussians are taken from
FEW = 15.0  # effective draws of a case, below which it keeps the Gaussian it had
_LEAST = 1e-3  # of probability that every case is drawn with


@dataclass(frozen=True)
class Mode:
    """The posterior in one case as a Gaussian, in standard normal coordinates.

    Attributes:
        case: Which leg is mounted wrong; None for no leg.
        z: Its mode or mean, shape (d,).
        covariance: Its covariance, shape (d, d).
        log_evidence: Log of the case's probability times its evidence.
    """

    case: Case
    z: Array
    covariance: Array
    log_evidence: float

    def within(self, dimensions: Sequence[int]) -> "Mode":
        """Return its marginal in some dimensions."""
        keep = list(dimensions)
        return replace(self, z=self.z[keep], covariance=self.covariance[np.ix_(keep, keep)])


@dataclass(frozen=True)
class WeightedDraws:
    """Draws with weights.

    Attributes:
        z: Draws in standard normal coordinates, shape (n, d).
        case: Index of each one's case, shape (n,).
        weight: Their weights, together one, shape (n,).
        log_proposal: Log density that each was drawn with, but for a constant, shape (n,).
    """

    z: Array
    case: NDArray[np.intp]
    weight: Array
    log_proposal: Array


def weighted_draws(
    modes: Sequence[Mode],
    log_density: Callable[[Array, NDArray[np.intp]], Array],
    *,
    rng: np.random.Generator,
    tell: Callable[[float], None],
) -> WeightedDraws:
    """Draw from Gaussians at modes, then from those of the weighted draws, till they suffice.

    Args:
        modes: One a case, in the order that cases are counted.
        log_density: Log posterior density at points of given cases.
        rng: Source of randomness.
        tell: Told the fraction done.
    """
    rounds, z, case = [list(modes)], np.empty((0, len(modes[0].z))), np.empty(0, dtype=np.intp)
    log_p = np.empty(0)
    while True:
        more, of_case = _draw(rounds[-1], rng)
        z, case = np.concatenate([z, more]), np.concatenate([case, of_case])
        log_p = np.concatenate([log_p, log_density(more, of_case)])
        log_q = np.logaddexp.reduce([_log_proposal(each, z, case) for each in rounds], axis=0)
        weight = _weights(log_p - log_q)
        tell(len(rounds) / MOST_ROUNDS)
        if 1 / (weight @ weight) >= WANTED or len(rounds) == MOST_ROUNDS:
            return WeightedDraws(z, case, weight, log_q)
        rounds.append(_adapted(modes, z, case, _tempered(log_p - log_q)))


def _draw(modes: Sequence[Mode], rng: np.random.Generator) -> tuple[Array, NDArray[np.intp]]:
    counts = rng.multinomial(DRAWS, _shares(modes))
    parts = [_students_t(mode, count, rng) for mode, count in zip(modes, counts, strict=True)]
    return np.concatenate(parts), np.repeat(np.arange(len(modes)), counts)


def _students_t(mode: Mode, n: int, rng: np.random.Generator) -> Array:
    """Draw from Student's t: a Gaussian over the root of a chi-square, shape (n, d)."""
    normal = rng.standard_normal((n, len(mode.z))) @ np.linalg.cholesky(mode.covariance).T
    return mode.z + normal * np.sqrt(TAIL / rng.chisquare(TAIL, (n, 1)))


def _log_proposal(modes: Sequence[Mode], z: Array, case: NDArray[np.intp]) -> Array:
    log, shares = np.empty(len(z)), _shares(modes)
    for i in np.unique(case):
        rows = case == i
        log[rows] = np.log(shares[i]) + multivariate_t.logpdf(
            z[rows], modes[i].z, modes[i].covariance, df=TAIL
        )
    return log


def _shares(modes: Sequence[Mode]) -> Array:
    """Return how often each case is drawn: by evidence, but all now and then."""
    log = np.array([mode.log_evidence for mode in modes])
    shares = np.exp(log - log.max())
    shares = shares / shares.sum() + _LEAST
    return shares / shares.sum()


def _adapted(modes: Sequence[Mode], z: Array, case: NDArray[np.intp], weight: Array) -> list[Mode]:
    """Take each case's share, mean and covariance from its weighted draws, where they suffice."""
    adapted = []
    for i, mode in enumerate(modes):
        w = np.where(case == i, weight, 0.0)
        share = float(w.sum())
        if share > 0 and share**2 / (w @ w) >= FEW:
            mean = w @ z / share
            away = z - mean
            covariance = away.T @ (away * w[:, None]) / share + 1e-4 * np.eye(z.shape[1])
            mode = replace(mode, z=mean, covariance=covariance)
        adapted.append(replace(mode, log_evidence=float(np.log(max(share, 1e-12)))))
    return adapted


def _tempered(log: Array) -> Array:
    """Flatten weights until they leave enough draws to take a Gaussian from."""
    low, high = 0.0, 1.0
    for _ in range(20):
        power = 0.5 * (low + high)
        weight = _weights(power * log)
        low, high = (power, high) if 1 / (weight @ weight) > ENOUGH else (low, power)
    return _weights(low * log)


def _weights(log: Array) -> Array:
    weight = np.exp(log - log.max())
    return weight / weight.sum()
