# SPDX-License-Identifier: MIT
"""Search for the curve of least squares in coordinates of the priors, from many starts."""

from dataclasses import dataclass, replace
from typing import Final

import numpy as np
from numpy.typing import NDArray
from scipy.optimize import least_squares

from model.arrays import Array
from model.bayes.plain.rows import PlainRows
from model.bayes.priors import Prior
from model.errors import FitError
from model.slip.definition import slip_per_radius_error
from model.slip.law import SlipLaw

N_TRIALS: Final = 400
"""Number of prior draws that are tried as starts."""
N_CLIMBS: Final = 5
"""Number of the best of them that are optimised."""
OFFSET_SD: Final = 0.1
"""Spread of the offset that is thought possible, over the largest force."""


@dataclass(frozen=True)
class Search:
    """Search for the least-squares curve.

    Coordinates x are the law's by its priors, then offset and zero of slip.

    Attributes:
        law: The slip law.
        priors: Prior of each of its parameters.
        zero_sd: Standard deviation of the relative error of the ratio of radii [-].
        rows: The rows.
        noise: Scale of the residuals [N]; None for a twentieth of the spread of the force.
    """

    law: SlipLaw
    priors: list[Prior]
    zero_sd: float
    rows: PlainRows
    noise: float | None = None

    def values(self, x: Array) -> Array:
        """Return the law's parameters at coordinates x (k + 2,), shape (k,)."""
        return np.array([prior.value(z) for prior, z in zip(self.priors, x, strict=False)])

    def residual(self, x: Array) -> Array:
        """Compute measured minus predicted traction of each row at x, shape (n,) [N]."""
        rows = self.rows
        shift = x[-1] * self.zero_sd * slip_per_radius_error(rows.slip, rows.definition)
        with np.errstate(all="ignore"):  # a trial may be beyond all numbers
            force = self.law.force(rows.slip - shift, rows.load, self.values(x))
            if rows.spread is not None:  # three points of a Gaussian
                away = np.sqrt(3) * rows.spread
                ends = [
                    self.law.force(rows.slip - shift + side, rows.load, self.values(x))
                    for side in (away, -away)
                ]
                force = (4 * force + ends[0] + ends[1]) / 6
        left = rows.force - np.nan_to_num(force)
        if rows.offset_a_run:
            return left - self._means(left)[rows.test]
        return left - x[-2] * self._offset_sd

    def offset(self, x: Array) -> float:
        """Return the offset of traction at x, the mean one where each run has its own [N]."""
        if not self.rows.offset_a_run:
            return float(x[-2] * self._offset_sd)
        free = replace(self, rows=replace(self.rows, offset_a_run=False))
        return float(np.mean(free.residual(np.append(x[:-2], [0.0, x[-1]]))))

    def valid(self, x: Array) -> bool:
        """Return whether the law is valid at x at quantiles of the loads."""
        loads = np.quantile(self.rows.load, [0.0, 0.25, 0.5, 0.75, 1.0])
        with np.errstate(all="ignore"):
            return bool(np.all(self.law.valid(loads, self.values(x))))

    def misfit(self, x: Array) -> Array:
        """Return the scaled residuals and the coordinates, shape (n + k + 2,)."""
        scale = self.noise or max(float(np.std(self.rows.force)) / 20, 1e-300)
        return np.append(self.residual(x) / scale, x)

    def climb(self, x: Array, most: int = 100, loss: str = "soft_l1") -> Array:
        """Optimise from x, by at most some evaluations; an end that is not valid is x again."""
        found = np.asarray(least_squares(self.misfit, x, loss=loss, max_nfev=most).x)
        return found if self.valid(found) else x

    def best_of_starts(self, rng: np.random.Generator) -> Array:
        """Optimise from the best of prior draws; return the result with the least misfit.

        Raises `FitError` where no draw is valid, or where residuals overflow.
        """
        trials = np.zeros((N_TRIALS, len(self.priors) + 2))  # the first at the prior's median
        trials[1:, :-2] = rng.standard_normal((N_TRIALS - 1, len(self.priors)))

        def height(x: Array) -> float:
            return float(np.abs(self.misfit(x)).sum())

        ranked = sorted(filter(self.valid, trials), key=height)
        if not ranked:
            low, high = self.rows.load.min(), self.rows.load.max()
            raise FitError(
                f"no parameters within the priors of the law '{self.law.name}' are valid at loads "
                f"of {low:g} to {high:g} N; check the unit of the load"
            )
        try:
            return min(map(self.climb, ranked[:N_CLIMBS]), key=height)
        except ValueError as error:  # raised by scipy where a residual overflows
            raise FitError(
                f"no curve of '{self.law.name}' comes near a traction force of up to "
                f"{np.abs(self.rows.force).max():.3g} N at loads of {self.rows.load.min():.3g} to "
                f"{self.rows.load.max():.3g} N ({error}); check their units"
            ) from error

    def refined(self, x: Array) -> "tuple[Search, Array]":
        """Optimise from x with the scale of the residuals that are found there, twice."""
        problem = self
        for _ in range(2):
            away = np.abs(problem.residual(x))
            noise = max(1.4826 * float(np.median(away)), 1e-3 * float(np.max(away)), 1e-300)
            problem = replace(self, noise=noise)
            x = problem.climb(x)
        return problem, x

    def resampled(self, chosen: NDArray[np.intp]) -> "Search":
        """Return the problem of some tests, shape (m,), which may be repeated."""
        return replace(self, rows=self.rows.of_tests(chosen))

    def slip_scale(self, x: Array) -> float:
        """Compute the slip at which a line of the initial slope reaches the largest force [-]."""
        load, slip = float(np.median(self.rows.load)), np.geomspace(1e-4, 1.0, 200)
        largest = np.max(self.law.force(slip, load, self.values(x)))
        return float(largest / self.law.slip_derivative(0.0, load, self.values(x)))

    @property
    def _offset_sd(self) -> float:
        return OFFSET_SD * float(np.abs(self.rows.force).max())

    def _means(self, values: Array) -> Array:
        """Average values (n,) over each test, shape (tests,)."""
        return np.bincount(self.rows.test, values) / np.bincount(self.rows.test)
