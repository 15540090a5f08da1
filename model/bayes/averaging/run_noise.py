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
    variance = _shrunk(np.bincount(blocks.run, x**2) / np.maximum(size - 1, 1), size)
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
    shrunk towards the median run's. Runs of fewer than `FEWEST` blocks have the size 1.

    Args:
        blocks: The block means, n of them.
        residual: Measured less predicted traction, shape (n,) [N].
        slip_slope: Slope of the curve in slip, shape (n,) [N].
    """
    size = np.bincount(blocks.run)
    rest = residual - blocks.run_mean(residual)[blocks.run]
    total = np.bincount(blocks.run, rest**2) / np.maximum(size - 1, 1)
    by_slip = np.bincount(blocks.run, slip_slope**2 * blocks.slip_error) / size
    own = _shrunk(np.maximum(total - by_slip, 0.1 * total), size)
    enough = size >= FEWEST
    typical = float(np.median(own[enough])) if enough.any() else 0.0
    sizes = np.where(enough & (typical > 0), own / max(typical, 1e-300), 1.0)
    return np.sqrt(sizes)[blocks.run]


def _shrunk(variance: Array, size: NDArray[np.intp]) -> Array:
    """Shrink variances within runs towards that of the median run, (n_runs,) each.

    Logarithms are shrunk by their sampling error, `MEMORY` times that of white noise, where runs of
    at least `FEWEST` blocks scatter by more; variances of zero and of shorter runs stay.

    Args:
        variance: Variance within each run, shape (n_runs,).
        size: Number of its blocks, shape (n_runs,).
    """
    freedom = np.maximum(size - 1.0, 1.0)
    enough = (size >= FEWEST) & (variance > 0)
    if enough.sum() < 2:
        return variance
    typical = median_variance(variance[enough], freedom[enough])
    away = np.log(np.where(enough, variance, typical) / typical)
    scatter = (1.4826 * np.median(np.abs(away[enough]))) ** 2
    by_chance = MEMORY * polygamma(1, freedom / 2)
    share = np.maximum(0.0, 1.0 - by_chance / max(scatter, 1e-300))
    return np.where(enough, typical * np.exp(share * away), variance)
