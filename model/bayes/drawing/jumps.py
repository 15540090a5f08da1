# SPDX-License-Identifier: MIT
"""The distribution whose draws the sampler's jumps propose, fitted to weighted draws.

A jump goes to a draw of one fixed distribution, wherever the walker is. It is accepted the more
often, the closer that distribution is to the posterior, and the chain forgets its past with every
jump that is. The Laplace approximation is a Gaussian at each mode; weighted draws also know how the
posterior leans, so that a mixture fitted to them comes closer. It is fixed before sampling begins,
and the acceptance ratio corrects for what it lacks: whatever it is, the sampler's target is the
posterior.
"""

import numpy as np

from model.bayes.drawing.laplace import LaplaceMixture, LogDensity
from model.bayes.drawing.sampler import Jumps
from model.bayes.drawing.weighted import DRAWS_A_PART, WeightedDraws, fitted_to, importance_draws

TRIED = 1000  # draws by which the acceptance of jumps is estimated
LIKELY = 0.15  # share of accepted jumps, from which most moves are jumps
FEW, MANY = 0.3, 0.6  # share of moves that are jumps, below and from that on


def choose_jumps(
    log_density: LogDensity,
    approximation: LaplaceMixture,
    weighted: WeightedDraws,
    *,
    rng: np.random.Generator,
    threads: int = 1,
) -> Jumps:
    """Choose what jumps propose: a mixture fitted to weighted draws, or the Laplace approximations.

    The Laplace approximations are kept where the weights are not reliable, where too few draws are
    effective for one part of a mixture, and where jumps to that are accepted no more often. The
    share of moves that jump is `MANY` where more than `LIKELY` are accepted, else `FEW`.

    Args:
        log_density: Log density of coordinates (w, d), -inf out of support.
        approximation: The Laplace approximations.
        weighted: Weighted draws of the density, and how often jumps to `approximation` are
            accepted.
        rng: Source of randomness.
        threads: Number of batches of draws whose density is computed at once.
    """
    proposal, accepted = approximation.distribution, weighted.jumps
    enough = weighted.effective_size >= DRAWS_A_PART * weighted.z.shape[1]
    if enough and weighted.reliable:
        fitted = fitted_to(weighted, approximation, rng=rng)
        tried = importance_draws(log_density, fitted, n=TRIED, rng=rng, threads=threads)
        if tried.jumps > accepted:
            proposal, accepted = fitted, tried.jumps
    return Jumps(proposal, MANY if accepted > LIKELY else FEW)
