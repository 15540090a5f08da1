# SPDX-License-Identifier: MIT
r"""Adaptive multiple importance sampling of posteriors, from Gaussians at their modes.

Draws of a mixture of Student-t distributions at the modes come first. Posteriors that lean, follow
a curved ridge or have a kink (where legs of a walk take over from each other at equal heights, a
longer arc lengthens steps to one side and has no effect on the other) give few of these a weight;
then rounds of further draws follow, each from a mixture fitted to all draws before it. All draws
are weighted by the posterior density over the mixture of all rounds' proposals (Cornuet et al.
2012),

.. math::
    w_i \propto p(x_i) / \sum_k q_k(x_i) .
"""

from collections.abc import Callable, Sequence
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from model.arrays import Array
from model.bayes.drawing.batches import in_batches
from model.bayes.drawing.convergence import MAX_PARETO_K, MIN_ESS
from model.bayes.drawing.laplace import Laplace, LogDensity
from model.bayes.drawing.mixture import (
    FREEDOM_OF_FEW,
    StudentMixture,
    fit_mixture,
    start_mixture,
)

CaseDensity = Callable[[Array, NDArray[np.intp]], Array]
START_SHARE = 0.2  # of the first mixture in all later ones, with its longer tails and its modes
FEWEST = 4.0  # effective draws a dimension; weights of fewer are made more even before a fit
PATIENCE = 3  # rounds without proposals around draws, more efficient where they suffice
CENTRES = 50  # draws that are centres of a round's narrower proposals
WIDTHS = (0.6, 0.3)  # of these proposals, in turn, in standard deviations of their case
OUTSIDE = -1e6  # log weight, less the largest one's, of a draw outside the support


@dataclass(frozen=True)
class Effort:
    """Size and number of the rounds of importance sampling.

    Attributes:
        draws: Draws in a round.
        wanted: Effective draws at which sampling ends, if the weights are reliable.
        rounds: Largest number of rounds.
    """

    draws: int
    wanted: float = MIN_ESS
    rounds: int = 10


@dataclass(frozen=True)
class WeightedDraws:
    """Draws of points and cases with importance weights.

    Attributes:
        z: Coordinates, round after round, those of a round in random order, shape (n, d).
        case: Case of each draw, shape (n,).
        weights: Pareto-smoothed weights, with sum one, shape (n,) [-].
        pareto_k: Tail index of the raw weights; above 0.7 the weights are not reliable [-].
        log_density: Log posterior density up to a constant, shape (n,).
        log_proposal: Log density of the mixture of all rounds' proposals, shape (n,).
        mixture: Mixture fitted to all these draws.
    """

    z: Array
    case: NDArray[np.intp]
    weights: Array
    pareto_k: float
    log_density: Array
    log_proposal: Array
    mixture: StudentMixture

    @property
    def reliable(self) -> bool:
        """Whether the weights can be relied on: a tail index below `MAX_PARETO_K`."""
        return self.pareto_k < MAX_PARETO_K

    @property
    def effective_size(self) -> float:
        """Kish's effective sample size, that of as many draws of equal weight [-]."""
        return float(1 / np.sum(self.weights**2))

    def resample(self, n: int, *, rng: np.random.Generator) -> Array:
        """Resample draws by their weights, with replacement; return coordinates, shape (n, d)."""
        return self.z[rng.choice(len(self.z), size=n, p=self.weights)]


def draws_at_modes(
    modes: Sequence[Laplace],
    log_density: LogDensity,
    *,
    effort: Effort,
    rng: np.random.Generator,
    threads: int = 1,
) -> WeightedDraws:
    """Draw weighted samples of a density without cases from the Gaussians at its modes.

    Args:
        modes: Laplace approximations at the modes.
        log_density: Log density of coordinates (w, d), -inf out of support.
        effort: Size and number of the rounds.
        rng: Source of randomness.
        threads: Number of batches of draws whose density is computed at once.
    """
    start = start_mixture(
        np.stack([each.mode for each in modes]),
        np.stack([each.covariance for each in modes]),
        np.array([each.log_evidence() for each in modes]),
    )
    spread = in_batches(log_density, threads)
    return importance_draws(start, lambda z, _: spread(z), effort=effort, rng=rng)


def importance_draws(
    start: StudentMixture,
    log_density: CaseDensity,
    *,
    effort: Effort,
    rng: np.random.Generator,
    progress: Callable[[float], None] = lambda _: None,
) -> WeightedDraws:
    """Draw weighted samples of a posterior by adaptive multiple importance sampling.

    Rounds of draws are added until the weights are reliable and enough draws effective, up to a
    number of rounds. A round's proposal is a mixture fitted to the draws so far beside the first
    one; while few draws are effective after `PATIENCE` rounds, half of it are narrower
    distributions around some of the draws, which follow a kink.

    Args:
        start: Proposal of the first round, with parts in every case; its centres are modes.
        log_density: Log posterior density at points (m, d) of cases (m,), up to a constant, -inf
            out of support, shape (m,); called once a round. At least one draw has to lie inside.
        effort: Size and number of the rounds.
        rng: Source of randomness.
        progress: Called with the fraction of the largest number of rounds done.
    """
    mixtures: list[StudentMixture] = []
    z, case = np.empty((0, start.centres.shape[1])), np.empty(0, dtype=np.intp)
    log_p, log_q, mixture = np.empty(0), np.empty(0), start
    while True:
        mixtures.append(mixture)
        more, of_case = mixture.draw(effort.draws, rng=rng)
        log_q = np.logaddexp(log_q, mixture.log_pdf(z, case))
        of_all = np.logaddexp.reduce([each.log_pdf(more, of_case) for each in mixtures])
        log_q = np.concatenate([log_q, of_all])
        z, case = np.concatenate([z, more]), np.concatenate([case, of_case])
        log_p = np.concatenate([log_p, log_density(more, of_case)])
        log_weights, pareto_k = pareto_smoothed(log_p - log_q)
        mixture = _next_mixture(z, case, log_weights, mixtures, rng)
        drawn = WeightedDraws(
            z, case, np.exp(log_weights), pareto_k, log_p, log_q - np.log(len(mixtures)), mixture
        )
        progress(len(mixtures) / effort.rounds)
        enough = drawn.reliable and drawn.effective_size >= effort.wanted
        if enough or len(mixtures) == effort.rounds:
            return drawn


def _next_mixture(
    z: Array,
    case: NDArray[np.intp],
    log_weights: Array,
    mixtures: Sequence[StudentMixture],
    rng: np.random.Generator,
) -> StudentMixture:
    """Fit a proposal to weighted draws, as `importance_draws` says.

    Args:
        z: Draws, shape (n, d).
        case: Case of each draw, shape (n,).
        log_weights: Log of each draw's weight, whose sum is one, shape (n,).
        mixtures: Proposals of the rounds so far.
        rng: Source of randomness.
    """
    few = FEWEST * z.shape[1]
    weights = tempered(log_weights, few)
    fitted = fit_mixture(z, case, weights, former=mixtures[-1], rng=rng)
    if len(mixtures) >= PATIENCE and 1 / np.sum(np.exp(2 * log_weights)) < few:
        width = WIDTHS[len(mixtures) % len(WIDTHS)]
        chosen = np.unique(rng.choice(len(z), size=CENTRES, p=weights))
        around = StudentMixture(
            np.full(len(chosen), 1 / len(chosen)),
            z[chosen],
            np.stack([width**2 * fitted.covariance(index) for index in case[chosen]]),
            np.full(len(chosen), FREEDOM_OF_FEW),
            case[chosen],
        )
        fitted = fitted.beside(around, 0.5)
    return fitted.beside(mixtures[0], START_SHARE)


def tempered(log_weights: Array, enough: float) -> Array:
    """Raise weights to the largest power up to 1 with over `enough` effective draws.

    The weights returned have sum one, shape (n,); they are all equal where there is no such power.
    """
    low, high = 0.0, 1.0
    for _ in range(20):
        power = 0.5 * (low + high)
        weights = _normalised(power * log_weights)
        low, high = (power, high) if 1 / (weights @ weights) > enough else (low, power)
    return _normalised(low * log_weights)


def _normalised(log_weights: Array) -> Array:
    """Return exp(log_weights) scaled to sum one, shape (n,)."""
    weights = np.exp(log_weights - log_weights.max())
    return weights / weights.sum()


def pareto_smoothed(log_ratio: Array) -> tuple[Array, float]:
    """Smooth the largest importance ratios by a generalised Pareto tail (Vehtari et al. 2024).

    Args:
        log_ratio: Logarithms of the raw ratios, -inf for draws outside the support, which get
            practically no weight; at least one is finite, shape (n,).

    Returns:
        Logarithms of the weights, whose sum is one, shape (n,), and the tail index of the ratios:
        infinite, and the weights not smoothed, where the tail has fewer than five ratios, or ratios
        all alike.
    """
    from arviz_stats.base import array_stats  # takes a second

    inside = np.isfinite(log_ratio)
    log_ratio = np.where(inside, log_ratio, OUTSIDE + log_ratio[inside].max())
    try:
        with np.errstate(all="ignore"):  # of ratios many orders of magnitude apart
            smoothed, pareto_k = array_stats.psislw(-log_ratio)
    except (ValueError, IndexError):  # no tail
        smoothed, pareto_k = log_ratio, np.inf
    if not np.isfinite(pareto_k) or np.isnan(smoothed).any():
        smoothed, pareto_k = log_ratio, np.inf
    return smoothed - np.logaddexp.reduce(smoothed), float(pareto_k)
