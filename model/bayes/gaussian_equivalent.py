# SPDX-License-Identifier: MIT
"""Block means as Gaussian noise would have them, for checks of a fit with Student-t noise."""

import math
from dataclasses import replace

import numpy as np

from model.arrays import Array
from model.bayes.likelihood import PredictedForces, predict_blocks
from model.bayes.posterior import SlipPosterior
from model.bayes.residuals import covariance_factors
from model.bayes.student import normal_scores


def gaussian_equivalent(posterior: SlipPosterior, values: Array) -> SlipPosterior:
    """Return a posterior whose blocks leave residuals that are Gaussian if the model holds.

    Each block's innovation is replaced by the quantile of a normal distribution that has the same
    probability, and the residuals are put together from these again, by the covariance of the
    checks: far blocks come as near as Gaussian noise would have left them. Blocks of a posterior
    with Gaussian noise stay as they are.

    Args:
        posterior: The posterior.
        values: Posterior draws of law and measurement parameters, shape (w, k + 12).

    Raises:
        LinAlgError: The covariance of a run's blocks is singular.
    """
    if math.isinf(posterior.tail):
        return posterior
    blocks = posterior.blocks
    every = predict_blocks(blocks, posterior.law, values)
    parts = (each.mean(axis=0) for each in (every.force, every.slope, every.noise))
    force, slope, noise = parts
    centre = values.mean(axis=0)
    mean = PredictedForces(force[None], slope[None], noise[None])
    scores = normal_scores(blocks, mean, centre[None], posterior.tail)[0]
    factors = covariance_factors(blocks, slope, noise, centre)
    own = np.split(scores, blocks.run_starts()[1:-1])
    residual = np.concatenate([L @ part for L, part in zip(factors, own, strict=True)])
    return replace(posterior, blocks=replace(blocks, traction_force=force + residual))
