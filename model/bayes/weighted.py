# SPDX-License-Identifier: MIT
"""Draws of a posterior with importance weights, adapted where the first approximation is poor."""

from dataclasses import dataclass, replace

import numpy as np
from numpy.typing import NDArray

from model.bayes.adaptive import EarlierDraws, Effort, Mode, adaptive_draws
from model.bayes.arviz_import import import_arviz
from model.bayes.batches import in_batches
from model.bayes.convergence import MAX_PARETO_K, MIN_ESS
from model.bayes.laplace import LaplaceMixture, LogDensity
from model.bayes.student_mixture import StudentMixture
from model.slip.law import Array

MOST_MORE = 2.0  # draws of the first distribution that are added, over the first ones
ENOUGH_MORE = 1.1  # effective draws that are aimed at, over the wanted ones
ENOUGH_PAIRS = 1000  # draws from and to which the acceptance of jumps is averaged
FURTHER_DRAWS = 2000  # of each round of adapted draws
FURTHER_ROUNDS = 15  # at most
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
    """Draw from a posterior with importance weights that are reliable, if need be by adaptation.

    Draws from the mixture of Laplace approximations come first, and up to `MOST_MORE` times as many
    again if so many are wanted. If their tail index is `MAX_PARETO_K` or more or still fewer than
    the wanted number are effective, as of posteriors along a curved ridge, rounds of draws follow
    from Student-t distributions that adapt to those before; the first draws stay among them.

    Args:
        log_density: Log density of coordinates (w, d), -inf out of support.
        proposal: The mixture to start from.
        n: Number of first draws.
        wanted: Effective draws below which the draws are adapted.
        rng: Source of randomness.
        threads: Number of batches of draws whose density is computed at once.

    Returns:
        The first draws, or these with the adapted ones if their tail index is smaller or, both
        being reliable, more of them are effective; in random order.
    """
    first = importance_draws(log_density, proposal, n=n, rng=rng, threads=threads)
    missing = ENOUGH_MORE * wanted / first.effective_size - 1
    if first.reliable and 0 < missing <= MOST_MORE:
        first = importance_draws(
            log_density, proposal, n=int(missing * n), rng=rng, threads=threads, earlier=first
        )
    if first.reliable and first.effective_size >= wanted:
        return first
    spread = in_batches(log_density, threads)
    adapted = adaptive_draws(
        [_spanning(proposal)],
        lambda z, _: spread(z),
        rng=rng,
        progress=lambda _: None,
        effort=Effort(FURTHER_DRAWS, wanted, FURTHER_ROUNDS),
        earlier=EarlierDraws(first.z, first.log_density, proposal.log_pdf),
    )
    order = rng.permutation(len(adapted.z))
    further = replace(
        _weighted(adapted.z[order], adapted.log_density[order], adapted.log_proposal[order]),
        jumps=first.jumps,
    )
    if first.reliable and further.reliable:
        return max(first, further, key=lambda draws: draws.effective_size)
    return min(first, further, key=lambda draws: draws.pareto_k)


def importance_draws(
    log_density: LogDensity,
    proposal: LaplaceMixture | StudentMixture,
    *,
    n: int,
    rng: np.random.Generator,
    threads: int = 1,
    earlier: WeightedDraws | None = None,
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
        earlier: Earlier draws of the same mixture, which are kept.
    """
    z = proposal.draw(n, rng=rng)
    height = in_batches(log_density, threads)(z)
    if earlier is not None:
        z = np.concatenate([earlier.z, z])
        height = np.concatenate([earlier.log_density, height])
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
    """Estimate the share of accepted jumps from some draws with their log ratios and weights.

    A jump from i to j is accepted with the probability min(1, r_j / r_i).
    """
    ratio, weight = log_ratio[:ENOUGH_PAIRS], weights[:ENOUGH_PAIRS]
    from_, to = np.where(weight > 0, ratio, np.inf)[:, None], ratio[None, :]
    chance = np.exp(np.minimum(to - from_, 0.0)).mean(axis=1)
    return float(weight @ chance / weight.sum())


def _spanning(mixture: LaplaceMixture) -> Mode:
    """Return one Gaussian with the mean and covariance of a mixture of Laplace approximations."""
    means = np.stack([each.mode for each in mixture.parts])
    mean = mixture.weights @ means
    covariance = sum(
        weight * (each.covariance + np.outer(each.mode - mean, each.mode - mean))
        for weight, each in zip(mixture.weights, mixture.parts, strict=True)
    )
    return Mode(mean, np.asarray(covariance), 0.0)


def pareto_smoothed(log_ratio: Array) -> tuple[Array, float]:
    """Smooth the largest importance ratios by a generalised Pareto tail (Vehtari et al. 2024).

    Args:
        log_ratio: Logarithms of the raw ratios, shape (n,).

    Returns:
        Logarithms of the weights, whose sum is one, shape (n,), and the tail index of the ratios.
    """
    az = import_arviz()

    smoothed, pareto_k = az.psislw(log_ratio)
    return np.asarray(smoothed, dtype=float), float(pareto_k)
