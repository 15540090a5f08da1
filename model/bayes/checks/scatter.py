# SPDX-License-Identifier: MIT
"""Whether runs differ in friction rather than in their zero: two materials, or one that changes."""

from dataclasses import dataclass

import numpy as np
from scipy.special import chdtrc

from model.arrays import Array
from model.bayes.checks.linear import Linearised
from model.bayes.likelihood import slip_errors

FEWEST_RUNS = 6
MEMORY = 2.0  # of block noise: the variance of a run's mean over that of white blocks
GRID = np.geomspace(1e-3, 0.5, 60)  # standard deviations of friction between runs that are tried


@dataclass(frozen=True)
class FrictionScatter:
    """Scatter of friction between runs.

    Attributes:
        sd: Standard deviation of friction between runs, over friction [-].
        gain: Twice the log likelihood with this scatter less that with a scatter of the zero alone;
            below 0 only by the coarser grid of both [-].
        runs: Relative difference of each run's friction from the curve's; 0 where the run's mean
            force is up to a tenth of the largest, shape (n_runs,) [-].
    """

    sd: float
    gain: float
    runs: Array

    @property
    def p(self) -> float:
        """Probability of such a gain where runs have one friction [-]."""
        return 0.5 * float(chdtrc(1, max(self.gain, 0.0))) if self.gain > 0 else 1.0


def friction_scatter(fit: Linearised, explained: Array) -> FrictionScatter | None:
    """Compare friction and zero that scatter between runs with a zero alone that does.

    A run's mean residual has the variance v + x², or v + x² + y² f² if friction scatters too, with
    v that of noise and slip errors, x the scatter of the zero, y that of friction and f the run's
    mean force. The likelihood of both is maximised over a grid of x and y. Noise is taken from the
    scatter within runs: the fitted noise, where it grows with force and hardly changes in time,
    would be that of friction.

    Args:
        fit: The linearised fit.
        explained: Force of what has been found already, shape (n,) [N].

    Returns:
        The scatter; None for fewer than `FEWEST_RUNS` runs, or runs of one block.
    """
    blocks = fit.blocks
    sizes = np.diff(blocks.run_starts())
    if blocks.n_runs < FEWEST_RUNS or len(blocks) <= blocks.n_runs:
        return None
    residual = fit.residual - explained
    mean, force = blocks.run_mean(residual), blocks.run_mean(fit.predicted.force)
    own, shared = slip_errors(blocks, fit.values)
    unit = fit.predicted.noise + np.abs(fit.predicted.slope) * np.sqrt(own)
    deviation = (residual - mean[blocks.run]) / unit
    within = float(np.sum(deviation**2)) / (len(blocks) - blocks.n_runs)
    noise = MEMORY * within * blocks.run_mean(unit**2) / sizes
    noise = noise + blocks.run_mean(fit.predicted.slope) ** 2 * shared
    largest = float(np.abs(force).max())
    zero, _ = _best(mean, noise, np.ones_like(force), np.append(0.0, GRID * largest))
    both, size = max(
        (
            _best(mean, noise + (x * largest) ** 2, force**2, np.append(0.0, GRID))
            for x in np.append(0.0, GRID[::3])
        ),
        key=lambda found: found[0],
    )
    safe = np.where(np.abs(force) > 0.1 * largest, force, np.inf)
    return FrictionScatter(size, 2 * (both - zero), mean / safe)


def _best(mean: Array, noise: Array, shape: Array, sizes: Array) -> tuple[float, float]:
    """Maximise the log likelihood of run means with variance noise + x² shape over sizes x.

    Returns the largest log likelihood, but for a constant, and its size.
    """
    variance = noise + sizes[:, None] ** 2 * shape
    values = -0.5 * np.sum(mean**2 / variance + np.log(variance), axis=1)
    best = int(np.argmax(values))
    return float(values[best]), float(sizes[best])
