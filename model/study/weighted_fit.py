# SPDX-License-Identifier: MIT
"""Fit of one simulated experiment by weighted draws: from its modes, adapted where need be."""

from dataclasses import dataclass

import numpy as np

from model.arrays import Array
from model.bayes.approximation import starting_points, straightened
from model.bayes.blocks import SlipBlocks
from model.bayes.laplace import LaplaceMixture
from model.bayes.posterior import SlipPosterior
from model.bayes.tails import approximate
from model.bayes.weighted import WeightedDraws, weighted_draws
from model.study.design import StudyDesign

DRAWS = 4000  # of the Laplace approximations
ENOUGH = 2000.0  # effective draws; of 800, tails of posteriors on a ridge are seen too thin
LEAST = 400.0  # effective draws, for a rank among 99
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
        return self.draws.reliable and self.effective >= LEAST

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
    modes = approximate(posterior.log_density, starts)
    return weigh(*straightened(posterior, modes, rng), rng)


def weigh(posterior: SlipPosterior, modes: LaplaceMixture, rng: np.random.Generator) -> WeightedFit:
    """Draw from Laplace approximations, and from adapted ones where their weights are not good.

    Args:
        posterior: The posterior density.
        modes: Laplace approximations at its modes.
        rng: Source of randomness.
    """
    draws = weighted_draws(posterior.log_density, modes, n=DRAWS, wanted=ENOUGH, rng=rng)
    return WeightedFit(posterior, draws)
