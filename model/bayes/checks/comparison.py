# SPDX-License-Identifier: MIT
r"""Whether the plain fit and the posterior agree as well as they would on data of the model.

Both are compared by d, the differences of :math:`\ln K` and of :math:`\ln F` at the largest slip.
Data are simulated at the posterior's centre: the expected force at each row of the plain fit, slip
noise as the posterior understands it, and the errors of each run as its covariance has them. To
each the plain fit is made anew, and the posterior follows by one Newton step. Slip as measured is
the same in all of them, so that what the plain fit loses by noise of slip is expected.
"""

from dataclasses import dataclass, replace
from typing import Final

import numpy as np
from numpy.typing import NDArray
from scipy.special import fdtri

from model.arrays import Array
from model.bayes.checks.linear import Linearised, curve_features
from model.bayes.cross_validation import measured_force
from model.bayes.plain.fit import PlainFit
from model.bayes.posterior import SlipPosterior

SIMULATED: Final = 60
"""Simulated data sets, by linear response of both fits beyond the first."""
STEPS: Final = 15
"""Most evaluations of a plain fit to simulated data."""
SURE: Final = 0.99
"""Probability within the ellipse of simulated differences."""
LIMITS: Final = (0.05, 0.02)
"""Differences of slope and force that matter beyond chance [-]."""


@dataclass(frozen=True)
class Comparison:
    """Difference of the plain fit and the posterior.

    Attributes:
        slope: Relative difference of the slope at zero slip, less what is expected [-].
        force: The same of the force at the largest slip [-].
        distance: Their distance from what is expected over that of the ellipse `SURE` [-].
    """

    slope: float
    force: float
    distance: float

    @property
    def agree(self) -> bool:
        """Whether they lie within the ellipse, or the difference does not matter."""
        small = abs(self.slope) < LIMITS[0] and abs(self.force) < LIMITS[1]
        return self.distance <= 1 or small


def compare_plain(
    posterior: SlipPosterior, fit: Linearised, plain: PlainFit, rng: np.random.Generator
) -> Comparison | None:
    """Compare the plain fit with the posterior; None for one test, or where a curve has no value.

    Args:
        posterior: The posterior of the fit.
        fit: The fit, linearised.
        plain: The plain fit of the same data.
        rng: Source of randomness of the simulated data.
    """
    law, k = posterior.law, len(posterior.law.parameters)
    centre = curve_features(law, fit.values[None, :k], fit.blocks)[0]
    found = curve_features(law, plain.values[None], fit.blocks)[0] - centre
    if fit.blocks.n_runs < 2 or not np.isfinite(found).all():
        return None
    block = _block_of_rows(fit, plain)
    rows = plain.rows
    slip = _true_slips(fit, rows.slip, block)
    expected = measured_force(law, fit.values, slip, rows.load, rows.definition)
    differences = []
    for _ in range(SIMULATED):
        noise = np.concatenate([L @ rng.standard_normal(len(L)) for L in fit.factors])
        problem = replace(plain.problem, rows=replace(rows, force=expected + noise[block]))
        values = problem.values(problem.climb(plain.x, most=STEPS))
        moved = centre + fit.features @ fit.absorbed(noise)
        differences.append(curve_features(law, values[None], fit.blocks)[0] - moved)
    kept = np.array([each for each in differences if np.isfinite(each).all()])
    if len(kept) < SIMULATED // 2:
        return None
    mean, covariance = kept.mean(axis=0), np.cov(kept.T)
    away, n = found - mean, len(kept)
    square = float(away @ np.linalg.solve(covariance + 1e-12 * np.eye(2), away))
    limit = 2 * (n - 1) * (n + 1) / (n * (n - 2)) * float(fdtri(2, n - 2, SURE))
    return Comparison(float(away[0]), float(away[1]), float(np.sqrt(square / limit)))


def _block_of_rows(fit: Linearised, plain: PlainFit) -> NDArray[np.intp]:
    """Return the block about each row of the plain fit, by its place within its run, (rows,)."""
    starts, test = fit.blocks.run_starts(), plain.rows.test
    run = test if test[-1] + 1 == fit.blocks.n_runs else np.zeros_like(test)
    edges = np.searchsorted(run, np.arange(run[-1] + 2))
    place = (np.arange(len(run)) - edges[run] + 0.5) / np.diff(edges)[run]
    size = np.diff(starts)[run]
    return starts[run] + np.minimum((place * size).astype(int), size - 1)


def _true_slips(fit: Linearised, slip: Array, block: NDArray[np.intp]) -> Array:
    """Estimate the true slip of each row from its measured one and its block's, shape (rows,).

    Several rows of a block differ by wander and noise; the share of wander is that of the block.
    """
    count = np.bincount(block, minlength=len(fit.blocks))
    mean = np.bincount(block, slip, minlength=len(fit.blocks)) / np.maximum(count, 1)
    away = slip - mean[block]
    spread = np.bincount(block, away**2, minlength=len(fit.blocks)) / np.maximum(count, 1)
    share = np.clip(fit.blocks.slip_wander / np.maximum(spread, 1e-300), 0.0, 1.0)
    return slip - (1 - share[block]) * away
