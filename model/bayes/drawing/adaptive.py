# SPDX-License-Identifier: MIT
r"""Adaptive importance sampling of a posterior that is not Gaussian, from Gaussians at its modes.

Such is the posterior of walks. It has a kink: where legs take over from each other at equal
heights, a common offset or a longer arc lengthens the steps in one direction and has no effect in
the opposite one. It is also a mixture of cases, one for each leg that may be mounted wrongly. That
of a slip law has no cases, and is drawn from by `model.bayes.drawing.weighted`.

In the first round draws are made from Student's t around each mode, in later rounds around the mean
of the weighted draws of each case and around some of the draws. All draws are weighted by the
posterior density over the proposal density of all rounds,

.. math::
    w_i \propto p(x_i) / \sum_k q_k(x_i) .
"""

from collections.abc import Callable, Sequence
from dataclasses import dataclass, replace

import numpy as np
from numpy.typing import NDArray
from scipy.linalg import solve_triangular
from scipy.spatial.distance import cdist
from scipy.special import gammaln

from model.arrays import Array

TAIL = 5  # degrees of freedom of the proposals
ENOUGH = 60.0  # effective draws from which a round's Gaussians are estimated
BEFORE = 2.0  # draws a dimension that a case's former covariance counts as in its new one
PATIENCE = 3  # rounds of proposals around modes alone, more efficient where they suffice
CENTRES = 50  # draws that are centres of a round's narrower proposals
WIDTHS = (0.6, 0.3)  # of the narrower proposals, in turn, in standard deviations of their case
_LEAST = 1e-3  # added to each case's probability of being drawn


@dataclass(frozen=True)
class Effort:
    """Size and number of the rounds of adaptive importance sampling.

    Attributes:
        draws: Draws in a round.
        wanted: Effective draws at which sampling ends.
        rounds: Largest number of rounds.
    """

    draws: int
    wanted: float
    rounds: int


@dataclass(frozen=True)
class Mode:
    """The posterior in one case as a Gaussian, in standard normal coordinates.

    Attributes:
        z: Mode or mean of the posterior in this case, shape (d,).
        covariance: Covariance of the posterior in this case, shape (d, d).
        log_evidence: Log of the case's prior probability times its evidence, up to a constant.
    """

    z: Array
    covariance: Array
    log_evidence: float

    def within(self, dimensions: Sequence[int]) -> "Mode":
        """Return the marginal Gaussian of the coordinates with the given indices."""
        keep = list(dimensions)
        return replace(self, z=self.z[keep], covariance=self.covariance[np.ix_(keep, keep)])


@dataclass(frozen=True)
class WeightedCaseDraws:
    """Draws of points and cases with importance weights.

    Attributes:
        z: Draws in standard normal coordinates, shape (n, d).
        case: Index of each draw's case among those that were sampled, shape (n,).
        weight: Weight of each draw, with sum one, shape (n,) [-].
        log_density: Log posterior density at each draw up to a constant, shape (n,).
        log_proposal: Log proposal density at each draw up to a constant, shape (n,).
    """

    z: Array
    case: NDArray[np.intp]
    weight: Array
    log_density: Array
    log_proposal: Array


def adaptive_draws(
    modes: Sequence[Mode],
    log_density: Callable[[Array, NDArray[np.intp]], Array],
    *,
    rng: np.random.Generator,
    progress: Callable[[float], None],
    effort: Effort,
) -> WeightedCaseDraws:
    """Draw weighted samples of the posterior by adaptive importance sampling.

    Rounds of draws are added until enough draws are effective, up to a number of rounds. After
    `PATIENCE` rounds, while fewer than `ENOUGH` are effective, narrower proposals around some of
    the draws are added to a round.

    Args:
        modes: Gaussian of each case, in the order of the cases' indices.
        log_density: Log posterior density at points (m, d) of cases (m,), shape (m,), up to a
            constant; called once a round.
        rng: Source of randomness.
        progress: Called with the fraction of the largest number of rounds done.
        effort: Size and number of the rounds.
    """
    rounds = [_around_modes(modes)]
    z, case = np.empty((0, len(modes[0].z))), np.empty(0, dtype=np.intp)
    log_p, log_q = np.empty(0), np.empty(0)
    while True:
        more, of_case = _draw(rounds[-1], effort.draws, rng)
        log_q = np.logaddexp(log_q, _log_proposal(rounds[-1], z, case))
        before = [_log_proposal(each, more, of_case) for each in rounds]
        log_q = np.concatenate([log_q, np.logaddexp.reduce(before, axis=0)])
        z, case = np.concatenate([z, more]), np.concatenate([case, of_case])
        log_p = np.concatenate([log_p, log_density(more, of_case)])
        weight = _weights(log_p - log_q)
        progress(len(rounds) / effort.rounds)
        if 1 / (weight @ weight) >= effort.wanted or len(rounds) == effort.rounds:
            return WeightedCaseDraws(z, case, weight, log_p, log_q)
        flat = tempered(log_p - log_q, ENOUGH)
        modes = _adapted(modes, z, case, flat)
        bumps = _around_modes(modes)
        if len(rounds) >= PATIENCE and 1 / (weight @ weight) < ENOUGH:
            width = WIDTHS[len(rounds) % len(WIDTHS)]
            bumps += _around_draws(modes, z, case, flat, width, rng)
        rounds.append(bumps)


@dataclass(frozen=True)
class _Bumps:
    """Proposal: Student's t distributions of equal shape around some points of one case.

    Attributes:
        case: Index of the case.
        means: Centres of the distributions, shape (k, d).
        root: Lower Cholesky factor of the distributions' common scale matrix, shape (d, d).
        shares: Probability of each distribution, up to a factor that all proposals of a round
            share, shape (k,) [-].
    """

    case: int
    means: Array
    root: Array
    shares: Array


def _around_modes(modes: Sequence[Mode]) -> list[_Bumps]:
    """Return one proposal around each case's mode or mean, with probabilities by `_shares`."""
    return [
        _Bumps(i, mode.z[None], _root(mode.covariance), np.array([share]))
        for i, (mode, share) in enumerate(zip(modes, _shares(modes), strict=True))
    ]


def _around_draws(
    modes: Sequence[Mode],
    z: Array,
    case: NDArray[np.intp],
    weight: Array,
    width: float,
    rng: np.random.Generator,
) -> list[_Bumps]:
    """Return narrower proposals around up to `CENTRES` draws, chosen by weight, to follow a kink.

    Args:
        modes: Gaussian of each case, which gives the shape of its proposals.
        z: Draws, shape (n, d).
        case: Index of each draw's case, shape (n,).
        weight: Weight of each draw, with sum one, shape (n,).
        width: Width of the proposals over the width of the case's Gaussian [-].
        rng: Source of randomness.
    """
    chosen = np.unique(rng.choice(len(z), size=CENTRES, p=weight))
    bumps = []
    for i in np.unique(case[chosen]):
        centres = chosen[case[chosen] == i]
        root = width * _root(modes[i].covariance)
        bumps.append(_Bumps(int(i), z[centres], root, np.full(len(centres), 1 / len(chosen))))
    return bumps


def _root(covariance: Array) -> Array:
    """Return the lower Cholesky factor of a covariance, shape (d, d)."""
    return np.asarray(np.linalg.cholesky(covariance), dtype=float)


def _draw(
    bumps: Sequence[_Bumps], n: int, rng: np.random.Generator
) -> tuple[Array, NDArray[np.intp]]:
    """Draw n points and the indices of their cases from the proposals of a round.

    Student's t is a Gaussian over the root of a scaled chi-square.
    """
    shares = np.concatenate([each.shares for each in bumps])
    means = np.concatenate([each.means for each in bumps])
    group = np.repeat(np.arange(len(bumps)), [len(each.means) for each in bumps])
    chosen = rng.choice(len(shares), size=n, p=shares / shares.sum())
    normal = rng.standard_normal((n, means.shape[1]))
    normal *= np.sqrt(TAIL / rng.chisquare(TAIL, (n, 1)))
    roots = np.stack([each.root for each in bumps])[group[chosen]]
    case = np.array([each.case for each in bumps], dtype=np.intp)[group[chosen]]
    return means[chosen] + (roots @ normal[..., None])[..., 0], case


def _log_proposal(bumps: Sequence[_Bumps], z: Array, case: NDArray[np.intp]) -> Array:
    """Compute a round's log proposal density at points (n, d) of cases (n,), shape (n,).

    -inf at points of a case without proposals in the round.
    """
    log = np.full(len(z), -np.inf)
    total = sum(each.shares.sum() for each in bumps)
    d = z.shape[1]
    constant = gammaln(0.5 * (TAIL + d)) - gammaln(0.5 * TAIL) - 0.5 * d * np.log(TAIL * np.pi)
    for each in bumps:
        rows = np.flatnonzero(case == each.case)
        if len(rows) == 0:
            continue
        points = solve_triangular(each.root, z[rows].T, lower=True).T
        centres = solve_triangular(each.root, each.means.T, lower=True).T
        square = cdist(points, centres, "sqeuclidean")
        t = constant - 0.5 * (TAIL + d) * np.log1p(square / TAIL)
        t -= np.log(np.diag(each.root)).sum()
        here = np.logaddexp.reduce(t + np.log(each.shares / total), axis=1)
        log[rows] = np.logaddexp(log[rows], here)
    return log


def _shares(modes: Sequence[Mode]) -> Array:
    """Return each case's share of the draws, by evidence plus a small constant, sum one."""
    log = np.array([mode.log_evidence for mode in modes])
    shares = np.exp(log - log.max())
    shares = shares / shares.sum() + _LEAST
    return shares / shares.sum()


def _adapted(modes: Sequence[Mode], z: Array, case: NDArray[np.intp], weight: Array) -> list[Mode]:
    """Compute each case's Gaussian from its weighted draws, the covariance shrunk to the former.

    A covariance from few draws is too narrow where no draw happened to lie, so that one later draw
    there outweighs all others. The covariance of the round before therefore counts as a number of
    further draws. The log evidence becomes the log of the case's total weight, at least 1e-12; a
    case without weight keeps mean and covariance.
    """
    adapted = []
    for i, mode in enumerate(modes):
        w = np.where(case == i, weight, 0.0)
        share = float(w.sum())
        if w @ w > 0:  # the squares of the least weights are zero
            effective = share**2 / (w @ w)
            mean = w @ z / share
            away = z - mean
            part = effective / (effective + BEFORE * z.shape[1])
            covariance = part * (away.T @ (away * w[:, None])) / share
            covariance += (1 - part) * mode.covariance + 1e-4 * np.eye(z.shape[1])
            mode = replace(mode, z=mean, covariance=covariance)
        adapted.append(replace(mode, log_evidence=float(np.log(max(share, 1e-12)))))
    return adapted


def tempered(log: Array, enough: float) -> Array:
    """Raise weights exp(log) to the largest power up to 1 with over `enough` effective draws.

    The weights returned have sum one, shape (n,); they are all equal where there is no such power.
    """
    low, high = 0.0, 1.0
    for _ in range(20):
        power = 0.5 * (low + high)
        weight = _weights(power * log)
        low, high = (power, high) if 1 / (weight @ weight) > enough else (low, power)
    return _weights(low * log)


def _weights(log: Array) -> Array:
    """Return exp(log) scaled to sum one, shape (n,)."""
    weight = np.exp(log - log.max())
    return weight / weight.sum()
