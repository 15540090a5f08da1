# SPDX-License-Identifier: MIT
"""Fit of one simulated experiment by weighted draws: from its modes, adapted where need be."""

from dataclasses import dataclass

import numpy as np

from model.bayes.blocks import SlipBlocks
from model.bayes.convergence import MAX_PARETO_K
from model.bayes.fit import starting_points
from model.bayes.laplace import (
    LaplaceMixture,
    WeightedDraws,
    find_modes,
    importance_draws,
    pareto_smoothed,
)
from model.bayes.posterior import SlipPosterior
from model.bayes.walks.importance import Effort, Mode, weighted_draws
from model.slip.law import Array
from model.study.design import StudyDesign

DRAWS = 4000  # of the Laplace approximations
ENOUGH = 2000.0  # effective draws; of 800, tails of posteriors on a ridge are seen too thin
LEAST = 400.0  # effective draws, for a rank among 99
FURTHER = Effort(draws=2000, wanted=ENOUGH, rounds=15)
STARTS = 5  # of searches for modes: two at the least-squares curve, then the best prior draws
RESAMPLED = 8000  # draws that intervals are read from


@dataclass(frozen=True)
class WeightedFit:
    """Posterior of one simulated experiment, as weighted draws.

    Attributes:
        posterior: The posterior density.
        draws: Draws with importance weights.
    """

    posterior: SlipPosterior
    draws: WeightedDraws

    @property
    def effective(self) -> float:
        """Number of draws that the weighted ones are worth."""
        return self.draws.effective_size

    @property
    def reliable(self) -> bool:
        """Whether the weights can be trusted: Pareto k below 0.7, and at least `LEAST` draws."""
        return self.draws.pareto_k < MAX_PARETO_K and self.effective >= LEAST

    def values(self, n: int, rng: np.random.Generator) -> Array:
        """Resample n equally weighted draws of the free parameters' values, shape (n, d)."""
        values = self.posterior.values(self.draws.resample(n, rng=rng))
        return values[:, [p.name not in self.posterior.fixed for p in self.posterior.parameters]]


def fit_blocks(design: StudyDesign, blocks: SlipBlocks, rng: np.random.Generator) -> WeightedFit:
    """Fit simulated blocks: find the modes, draw from them, and adapt until the weights are good.

    Args:
        design: Law and priors of the fit.
        blocks: The blocks, with their traction.
        rng: Source of randomness.

    Raises:
        FitError: No curve comes near the forces, or no start lies within the priors' support.
    """
    posterior = design.posterior(blocks)
    starts = starting_points(posterior, rng)[:STARTS]
    modes = LaplaceMixture(find_modes(posterior.log_density, starts))
    return weigh(posterior, modes, rng)


def weigh(posterior: SlipPosterior, modes: LaplaceMixture, rng: np.random.Generator) -> WeightedFit:
    """Draw from Laplace approximations, and from adapted ones where their weights are not good.

    Args:
        posterior: The posterior density.
        modes: Laplace approximations at its modes.
        rng: Source of randomness.
    """
    first = WeightedFit(posterior, importance_draws(posterior.log_density, modes, n=DRAWS, rng=rng))
    if first.reliable and first.effective >= ENOUGH:
        return first
    adapted = weighted_draws(
        [_spanning(modes)],
        lambda z, _: posterior.log_density(z),
        rng=rng,
        progress=lambda _: None,
        effort=FURTHER,
    )
    return WeightedFit(posterior, _smoothed(posterior, adapted.z, adapted.weight))


def _spanning(modes: LaplaceMixture) -> Mode:
    """Return one Gaussian with mean and covariance of a mixture of Laplace approximations."""
    means = np.stack([each.mode for each in modes.modes])
    mean = modes.weights @ means
    covariance = sum(
        weight * (each.covariance + np.outer(each.mode - mean, each.mode - mean))
        for weight, each in zip(modes.weights, modes.modes, strict=True)
    )
    return Mode(None, mean, np.asarray(covariance), 0.0)


def _smoothed(posterior: SlipPosterior, z: Array, weights: Array) -> WeightedDraws:
    """Return draws whose importance weights (n,) are smoothed as `importance_draws` does."""
    with np.errstate(divide="ignore"):
        log = np.maximum(np.log(weights), -1e6)
    log_weights, pareto_k = pareto_smoothed(log)
    kept = np.exp(log_weights)
    return WeightedDraws(z, kept / kept.sum(), pareto_k, posterior.log_density(z))
