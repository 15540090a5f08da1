# SPDX-License-Identifier: MIT
"""First answer of a fit: weighted draws of the Laplace approximation, before any sampling."""

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np

from model.bayes.drawing.convergence import MAX_PARETO_K, Convergence, assess_weighted
from model.bayes.drawing.importance import WeightedDraws
from model.bayes.estimate import Draws, Estimate, estimate
from model.bayes.posterior import SlipPosterior

DRAWS = 4000  # that the estimates of a preview are computed from


@dataclass(frozen=True)
class Preview:
    """Posterior of a law's parameters by weighted draws, without any check of the fit.

    Attributes:
        law: Name of the law.
        estimates: Posterior of each parameter of the law.
        pareto_k: Tail index of the weights [-].
        effective_size: Number of draws of equal weight that are worth as much [-].
    """

    law: str
    estimates: Sequence[Estimate]
    pareto_k: float
    effective_size: float

    @property
    def reliable(self) -> bool:
        """Whether the weights can be relied on: `pareto_k` is below `MAX_PARETO_K`."""
        return self.pareto_k < MAX_PARETO_K


def preview(
    posterior: SlipPosterior, weighted: WeightedDraws, *, rng: np.random.Generator
) -> Preview:
    """Estimate the law's parameters from weighted draws.

    Args:
        posterior: The posterior.
        weighted: Weighted draws of it.
        rng: Source of randomness.
    """
    values = posterior.values(weighted.resample(DRAWS, rng=rng))
    parameters = posterior.law.parameters
    estimates = [estimate(p, values[:, i]) for i, p in enumerate(parameters)]
    return Preview(posterior.law.name, estimates, weighted.pareto_k, weighted.effective_size)


def weighted_posterior(
    posterior: SlipPosterior,
    weighted: WeightedDraws,
    *,
    parts: int,
    n: int,
    rng: np.random.Generator,
) -> tuple[Draws, Convergence]:
    """Make draws of equal weight in place of a sampler's, with their diagnostics.

    The weighted draws are dealt to equal parts in turn, and each part is resampled by its weights
    on its own, so that the parts are as independent as ensembles of a sampler are.

    Args:
        posterior: The posterior.
        weighted: Weighted draws of it.
        parts: Number of parts, which stand for ensembles.
        n: Draws of each part.
        rng: Source of randomness.
    """
    dealt = [np.arange(first, len(weighted.z), parts) for first in range(parts)]
    shares = [weighted.weights[rows] for rows in dealt]
    index = np.stack(
        [rng.choice(rows, size=n, p=p / p.sum()) for rows, p in zip(dealt, shares, strict=True)]
    )
    z = weighted.z[index]
    values = posterior.values(z.reshape(-1, z.shape[-1])).reshape(parts, n, -1)
    convergence = assess_weighted(
        posterior.own_coordinates(z), posterior.own_coordinates(weighted.z), weighted.weights,
        weighted.pareto_k,
    )  # fmt: skip
    return Draws(z, values, weighted.log_density[index]), convergence
