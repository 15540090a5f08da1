# SPDX-License-Identifier: MIT
"""Draws of a posterior with importance weights, from a mixture fitted to them where few count."""

from dataclasses import dataclass, replace

import numpy as np
from numpy.typing import NDArray

from model.arrays import Array
from model.bayes.drawing.adaptive import tempered
from model.bayes.drawing.batches import in_batches
from model.bayes.drawing.convergence import MAX_PARETO_K, MIN_ESS
from model.bayes.drawing.laplace import LaplaceMixture, LogDensity
from model.bayes.drawing.student_mixture import StudentMixture, fit_mixture

ENOUGH_PAIRS = 1000  # draws from and to which the acceptance of jumps is averaged
FURTHER_DRAWS = 2000  # of each further round, at least
MOST_FURTHER = 40_000  # of all further rounds
MOST_PARTS = 3  # of a fitted mixture
DRAWS_A_PART = 20.0  # effective draws that a part needs, a dimension
FEWEST = 4.0  # effective draws a dimension; weights of fewer are made more even before a fit
FREEDOM = 20.0  # degrees of freedom of the parts [-]
FREEDOM_OF_FEW = 5.0  # where fewer draws are effective than one part needs: a tail may be missing
LAPLACE_SHARE = 0.2  # of the Laplace mixture beside them, with its longer tails and its modes
OUTSIDE = -1e6  # log weight, less the largest one's, of a draw outside the support


@dataclass(frozen=True)
class WeightedDraws:
    """Draws with importance weights.

    Attributes:
        z: Coordinates, shape (n, d).
        weights: Pareto-smoothed weights, with sum one, shape (n,).
        pareto_k: Tail index of the raw weights; above 0.7 the weights are not reliable [-].
        log_density: Log posterior density up to a constant, shape (n,).
        jumps: Share of jumps to draws of the first distribution, from draws of the posterior, that
            a Metropolis-Hastings sampler accepts [-].
    """

    z: Array
    weights: Array
    pareto_k: float
    log_density: Array
    jumps: float = 0.0

    @property
    def reliable(self) -> bool:
        """Whether the weights can be relied on: a tail index below `MAX_PARETO_K`."""
        return self.pareto_k < MAX_PARETO_K

    @property
    def effective_size(self) -> float:
        """Kish's effective sample size, that of as many draws of equal weight [-]."""
        return float(1 / np.sum(self.weights**2))

    def part(self, chosen: slice) -> "WeightedDraws":
        """Return a part of the draws as if it were all, its weights with sum one.

        Args:
            chosen: Which draws, at least one.
        """
        weights = self.weights[chosen]
        return WeightedDraws(
            self.z[chosen], weights / weights.sum(), self.pareto_k, self.log_density[chosen],
            self.jumps,
        )  # fmt: skip

    def resampled(self, n: int, *, rng: np.random.Generator) -> NDArray[np.intp]:
        """Resample draws by their weights, with replacement; return their indices, shape (n,).

        Args:
            n: Number of draws.
            rng: Source of randomness.
        """
        return rng.choice(len(self.z), size=n, p=self.weights)

    def resample(self, n: int, *, rng: np.random.Generator) -> Array:
        """Resample draws by their importance weights, with replacement, to equally weighted ones.

        Args:
            n: Number of draws.
            rng: Source of randomness.

        Returns:
            Coordinates, shape (n, d).
        """
        return self.z[self.resampled(n, rng=rng)]


def weighted_draws(
    log_density: LogDensity,
    proposal: LaplaceMixture,
    *,
    n: int,
    wanted: float = MIN_ESS,
    rng: np.random.Generator,
    threads: int = 1,
) -> WeightedDraws:
    """Draw from a posterior with importance weights, by adaptation where these are not reliable.

    Draws from the mixture of Laplace approximations come first. If their tail index is
    `MAX_PARETO_K` or more or fewer than the wanted number are effective, as of posteriors that lean
    or follow a curved ridge, rounds of as many draws follow, and of `FURTHER_DRAWS` at least, each
    from a mixture fitted to all draws before it. The proposal of all draws is the mixture of the
    rounds' own (Cornuet et al. 2012, adaptive multiple importance sampling).

    Args:
        log_density: Log density of coordinates (w, d), -inf out of support.
        proposal: The mixture to start from.
        n: Number of first draws.
        wanted: Effective draws below which further rounds follow, up to `MOST_FURTHER` draws.
        rng: Source of randomness.
        threads: Number of batches of draws whose density is computed at once.

    Returns:
        The draws, in random order; their weights may be unreliable after `MOST_FURTHER` draws too.
    """
    spread = in_batches(log_density, threads)
    drawn = importance_draws(log_density, proposal, n=n, rng=rng, threads=threads)
    z, height, jumps = drawn.z, drawn.log_density, drawn.jumps
    rounds, further = [(n, proposal.distribution)], max(n, FURTHER_DRAWS)
    while len(z) - n < MOST_FURTHER and not (drawn.reliable and drawn.effective_size >= wanted):
        fitted = fitted_to(drawn, proposal, rng=rng)
        rounds.append((further, fitted))
        more = fitted.draw(further, rng=rng)
        z, height = np.concatenate([z, more]), np.concatenate([height, spread(more)])
        order = rng.permutation(len(z))
        z, height = z[order], height[order]
        shares = [np.log(size) + mixture.log_pdf(z) for size, mixture in rounds]
        log_proposal = np.logaddexp.reduce(shares)
        drawn = replace(_weighted(z, height, log_proposal), jumps=jumps)
    return drawn


def fitted_to(
    weighted: WeightedDraws, approximation: LaplaceMixture, *, rng: np.random.Generator
) -> StudentMixture:
    """Fit a mixture to weighted draws, with the Laplace approximations beside it.

    Args:
        weighted: The draws. If fewer than `FEWEST` a dimension are effective, their weights are
            raised to a power below 1 for the fit.
        approximation: The Laplace approximations.
        rng: Source of randomness.
    """
    d = weighted.z.shape[1]
    parts = int(min(weighted.effective_size / (DRAWS_A_PART * d), MOST_PARTS))
    freedom = FREEDOM if parts else FREEDOM_OF_FEW
    weights = tempered(np.log(np.maximum(weighted.weights, 1e-300)), FEWEST * d)
    fitted = fit_mixture(weighted.z, weights, parts=max(parts, 1), freedom=freedom, rng=rng)
    return fitted.beside(approximation.distribution, LAPLACE_SHARE)


def importance_draws(
    log_density: LogDensity,
    proposal: LaplaceMixture | StudentMixture,
    *,
    n: int,
    rng: np.random.Generator,
    threads: int = 1,
) -> WeightedDraws:
    """Draw from a mixture near the posterior and weight the draws by the posterior.

    Pareto-smoothed importance sampling (Vehtari et al. 2024). Draws outside the support have
    practically no weight; at least one has to lie inside.

    Args:
        log_density: Log density of coordinates (w, d), -inf out of support.
        proposal: The mixture to draw from.
        n: Number of draws.
        rng: Source of randomness.
        threads: Number of batches of draws whose density is computed at once.
    """
    z = proposal.draw(n, rng=rng)
    height = in_batches(log_density, threads)(z)
    log_proposal = proposal.log_pdf(z)
    drawn = _weighted(z, height, log_proposal)
    return replace(drawn, jumps=_accepted(height - log_proposal, drawn.weights))


def _weighted(z: Array, log_density: Array, log_proposal: Array) -> WeightedDraws:
    """Weight draws z, (n, d), by the ratio of their densities, smoothed, each (n,)."""
    ratio = log_density - log_proposal
    inside = np.isfinite(ratio)
    ratio = np.where(inside, ratio, OUTSIDE + ratio[inside].max())
    log_weights, pareto_k = pareto_smoothed(ratio)
    weights = np.exp(log_weights)
    return WeightedDraws(z, weights / weights.sum(), pareto_k, log_density)


def _accepted(log_ratio: Array, weights: Array) -> float:
    """Estimate the share of accepted Metropolis-Hastings jumps to draws of the proposal [-].

    A jump from i to j is accepted with the probability min(1, r_j / r_i), r being the ratio of
    posterior and proposal density. It is averaged over pairs of the first `ENOUGH_PAIRS` draws: i
    by weight, as draws of the posterior, j evenly.
    """
    ratio, weight = log_ratio[:ENOUGH_PAIRS], weights[:ENOUGH_PAIRS]
    from_, to = np.where(weight > 0, ratio, np.inf)[:, None], ratio[None, :]
    chance = np.exp(np.minimum(to - from_, 0.0)).mean(axis=1)
    return float(weight @ chance / weight.sum())


def pareto_smoothed(log_ratio: Array) -> tuple[Array, float]:
    """Smooth the largest importance ratios by a generalised Pareto tail (Vehtari et al. 2024).

    Args:
        log_ratio: Logarithms of the raw ratios, shape (n,).

    Returns:
        Logarithms of the weights, whose sum is one, shape (n,), and the tail index of the ratios:
        infinite, and the weights not smoothed, where the tail has fewer than five ratios, or ratios
        all alike.
    """
    from arviz_stats.base import array_stats  # takes a second

    try:
        with np.errstate(all="ignore"):  # of ratios many orders of magnitude apart
            smoothed, pareto_k = array_stats.psislw(-log_ratio)
    except (ValueError, IndexError):  # no tail
        smoothed, pareto_k = log_ratio, np.inf
    if not np.isfinite(pareto_k) or np.isnan(smoothed).any():
        smoothed, pareto_k = log_ratio, np.inf
    return smoothed - np.logaddexp.reduce(smoothed), float(pareto_k)
