# SPDX-License-Identifier: MIT
"""Where searches for a slip posterior's modes start, and its straightening along a curved ridge."""

from dataclasses import replace

import numpy as np

from model.bayes.drawing.importance import Effort, draws_at_modes
from model.bayes.drawing.laplace import Laplace, find_modes
from model.bayes.drawing.shear import find_shear
from model.bayes.plain.fit import PlainFit, plain_fit
from model.bayes.posterior import SlipPosterior
from model.slip.samples import SlipSamples

FEW_BLOCKS = 500  # up to this number of blocks prior draws are further starts
PRIOR_DRAWS = 400
TRIED_DRAWS = 1000  # from which it is told whether straightening helps
PRIOR_STARTS = 12  # further starts of the optimisation, from the best of the draws to the worst


def starting_points(
    posterior: SlipPosterior, plain: PlainFit, rng: np.random.Generator
) -> np.ndarray:
    """Choose starting points of the optimisation in coordinates z, shape (m, d).

    Two are at the plain fit's curve, with a low and a high noise. Up to `FEW_BLOCKS` blocks 12 to
    23 of 400 prior draws follow, evenly from the best to the worst within the support (fewer if it
    has fewer than 12): few data allow several shapes, and one start finds one mode.

    Args:
        posterior: The posterior density.
        plain: The plain fit of the same law and data.
        rng: Source of randomness.
    """
    blocks, law = posterior.blocks, posterior.law
    residual = plain.residual(blocks.slip, blocks.normal_force, blocks.traction_force)
    size = float(np.std(residual))
    names = [parameter.name for parameter in law.parameters]
    known = dict(zip(names, map(float, plain.values), strict=True), radius_error=plain.zero)
    near = [posterior.coordinates({**known, "noise_floor": size * share}) for share in (0.3, 1.0)]
    if len(blocks) > FEW_BLOCKS:
        return np.stack(near)
    drawn = rng.standard_normal((PRIOR_DRAWS, len(posterior.free)))
    heights = posterior.log_density(drawn)
    ranked = drawn[np.argsort(-heights)][: np.isfinite(heights).sum()]
    return np.vstack([*near, ranked[:: max(1, len(ranked) // PRIOR_STARTS)]])


def plain_starts(
    samples: SlipSamples, posterior: SlipPosterior, rng: np.random.Generator
) -> np.ndarray:
    """Choose starting points as `starting_points`, from a plain fit of the samples, shape (m, d).

    Args:
        samples: The samples.
        posterior: The posterior density of their block means.
        rng: Source of randomness.

    Raises:
        FitError: No curve of the law comes near the samples.
    """
    zero_sd = float(posterior.priors["radius_error"].value(1.0))
    plain = plain_fit(samples, posterior.law, priors=posterior.priors, zero_sd=zero_sd, rng=rng)
    return starting_points(posterior, plain, rng)


def straightened(
    posterior: SlipPosterior, modes: tuple[Laplace, ...], rng: np.random.Generator
) -> tuple[SlipPosterior, tuple[Laplace, ...]]:
    """Shear the coordinates of a posterior with one mode that lies along a curved ridge.

    Args:
        posterior: The posterior.
        modes: Its Laplace approximations.
        rng: Source of randomness of the points that the shear is fitted to.

    Returns:
        The same posterior in straightened coordinates, and its Laplace approximations there; both
        as given where the posterior is straight or has several modes, or where fewer of
        `TRIED_DRAWS` draws are effective in straightened coordinates.
    """
    mode, *others = modes
    shear = None if others else find_shear(posterior.log_density, mode, rng)
    if shear is None:
        return posterior, modes
    sheared = replace(posterior, shear=shear)
    tops = find_modes(sheared.log_density, mode.mode[None])
    once = Effort(TRIED_DRAWS, rounds=1)
    effective = [
        draws_at_modes(each_modes, each.log_density, effort=once, rng=rng).effective_size
        for each, each_modes in ((posterior, modes), (sheared, tops))
    ]
    return (sheared, tops) if effective[1] > effective[0] else (posterior, modes)
