# SPDX-License-Identifier: MIT
r"""What a preliminary curve tells of the noise of block means: of load, and of traction by run.

Within a run the true load varies by :math:`u` and the cell adds noise :math:`w`; traction follows
the true load alone. With e the residual of the traction and g the slope of the curve in load, both
less their means over the run, and x = u + w the measured load less its mean,

.. math::
    E[g x e] = g^2 E[u^2], \qquad E[g^2 x^2] = g^2 (E[u^2] + \sigma^2),

so that the variance :math:`\sigma^2` of the noise follows from both. It needs no nugget: noise with
memory looks like the load's own variation. Taken as exact, the measured load would attenuate the
slope of the curve in load, the more the lighter the load.
"""

from dataclasses import replace
from typing import Final

import numpy as np
from numpy.typing import NDArray
from scipy.special import polygamma
from scipy.stats import kendalltau

from model.arrays import Array
from model.bayes.averaging.blocks import SlipBlocks
from model.bayes.averaging.slip_noise import median_variance

KNOWN: Final = 0.1
"""Relative standard error of a run's share of true variation in load, up to which it is used: the
slope of the curve in load would be wrong by as much [-]."""
FEWEST: Final = 3
"""Least number of blocks in a run that tell the size of its noise."""
MEMORY: Final = 2.5
"""Scatter over sampling variance of runs that are alike: noise has a memory, and runs are few."""
FEWEST_GROWING: Final = 10
"""Least number of runs that tell whether noise grows with the force."""
BY_CHANCE: Final = 0.01
"""P-value below which noise is said to grow with the force."""
MOST_GROWTH: Final = 2.0
"""Largest power of the force with which a variance grows: noise in proportion to it."""


def with_true_loads(blocks: SlipBlocks, residual: Array, slope: Array) -> SlipBlocks:
    r"""Replace each block's load by what is expected of the true one, given those of its run.

    It is the run's mean :math:`m` plus :math:`\lambda(N - m)`, with the share
    :math:`\lambda = 1 - \sigma^2/\mathrm{var}(N)` of true variation; 0 where its relative error is
    above `KNOWN`, as without a slope in load. Its error has the variance :math:`\lambda\sigma^2`.

    Args:
        blocks: The block means, with measured loads, n of them.
        residual: Measured traction less that by a curve at the mean load of its run, (n,) [N].
        slope: Slope of that curve in load, shape (n,) [-].
    """
    mean = blocks.run_mean(blocks.normal_force)[blocks.run]
    x = blocks.normal_force - mean
    e = residual - blocks.run_mean(residual)[blocks.run]
    size = np.bincount(blocks.run)
    # Shrunk: of a variance that is large by chance, too much would pass for the load's own.
    variance = np.bincount(blocks.run, x**2) / np.maximum(size - 1, 1)
    variance = _shrunk(variance, size, np.ones(len(size)))  # how far it varies is the rig's choice
    told = np.bincount(blocks.run, slope**2) * (1 - 1 / size)
    followed = np.bincount(blocks.run, slope * x * e)
    weight = told / np.maximum(variance, 1e-300)  # noise counts where the load itself is steady
    if not weight.any():
        return blocks
    of_run = variance - np.divide(followed, told, where=told > 0, out=np.zeros_like(told))
    weight /= weight.sum()
    noise = float(weight @ of_run)
    spare = max(1 - float(weight @ weight), 1e-9)
    error = float(np.sqrt(np.sum((weight * (of_run - noise)) ** 2) / spare))
    noise = max(noise, 0.0)
    share = np.clip(1 - noise / np.maximum(variance, 1e-300), 0.0, 1.0)
    known = (error < KNOWN * share * variance) & (size > 1)
    share = np.where(known, share, np.where(size > 1, 0.0, 1.0))[blocks.run]
    return replace(
        blocks, normal_force=mean + share * x,
        load_error=np.where(known[blocks.run], share * noise, 0.0),
        load_variance=share * blocks.load_variance,
    )  # fmt: skip


def noise_sizes(blocks: SlipBlocks, residual: Array, slip_slope: Array) -> Array:
    """Estimate the size of each run's noise of traction over that of the usual run, (n,) [-].

    It is the scatter of the residual within the run, without what the error of slip makes of it,
    shrunk towards what runs of such a traction have: a power of its root mean square, where that
    is clear, or the median run's. Runs of fewer than `FEWEST` blocks have the size 1.

    Args:
        blocks: The block means, n of them.
        residual: Measured less predicted traction, shape (n,) [N].
        slip_slope: Slope of the curve in slip, shape (n,) [N].
    """
    size = np.bincount(blocks.run)
    rest = residual - blocks.run_mean(residual)[blocks.run]
    total = np.bincount(blocks.run, rest**2) / np.maximum(size - 1, 1)
    by_slip = np.bincount(blocks.run, slip_slope**2 * blocks.slip_error) / size
    mean_square = blocks.run_mean(blocks.traction_force**2)
    own = _shrunk(np.maximum(total - by_slip, 0.1 * total), size, np.sqrt(mean_square))
    enough = size >= FEWEST
    typical = float(np.median(own[enough])) if enough.any() else 0.0
    sizes = np.where(enough & (typical > 0), own / max(typical, 1e-300), 1.0)
    return np.sqrt(sizes)[blocks.run]


def _shrunk(variance: Array, size: NDArray[np.intp], force: Array) -> Array:
    """Shrink variances within runs towards what runs at such a force usually have, (n_runs,) each.

    That is a power of the force, as far as the data tell one, but no less than at the middle of the
    lightest third of the runs; or the median run's. Logarithms are
    shrunk by their sampling error, `MEMORY` times that of white noise, where runs of at least
    `FEWEST` blocks scatter by more; variances of zero and of shorter runs stay.

    Args:
        variance: Variance within each run, shape (n_runs,).
        size: Number of its blocks, shape (n_runs,).
        force: Root mean square of a measured force in each run, shape (n_runs,) [N].
    """
    freedom = np.maximum(size - 1.0, 1.0)
    enough = (size >= FEWEST) & (variance > 0)
    if enough.sum() < 2:
        return variance
    # Noise that a cell has without force keeps that of the lightest runs from falling on.
    lightest = max(float(np.quantile(force[enough], 1 / 6)), 1e-300)
    growth = _growth(variance[enough], force[enough]) * np.log(np.maximum(force, lightest))
    level = np.where(enough, variance, 1.0) * np.exp(-growth)
    typical = median_variance(level[enough], freedom[enough])
    away = np.log(np.where(enough, level / typical, 1.0))
    scatter = (1.4826 * np.median(np.abs(away[enough]))) ** 2
    by_chance = MEMORY * polygamma(1, freedom / 2)
    share = np.maximum(0.0, 1.0 - by_chance / max(scatter, 1e-300))
    return np.where(enough, typical * np.exp(share * away + growth), variance)


def _growth(variance: Array, force: Array) -> float:
    """Estimate the power of the force with which variances grow, 0 if that is not clear.

    It is clear where Kendall's rank correlation is. The power is that of Tukey's resistant line,
    through the medians of the outer thirds of the runs.

    Args:
        variance: Positive variance within each run, shape (n,).
        force: Typical size of a measured force in it, shape (n,) [N].
    """
    if len(force) < FEWEST_GROWING or not force.min() > 0:
        return 0.0
    order, third = np.argsort(force), len(force) // 3
    x, y = np.log(force[order]), np.log(variance[order])
    wide, rise = (float(np.median(v[-third:]) - np.median(v[:third])) for v in (x, y))
    if not wide > 0 or not np.asarray(kendalltau(x, y))[1] < BY_CHANCE:
        return 0.0
    return float(np.clip(rise / wide, 0.0, MOST_GROWTH))
