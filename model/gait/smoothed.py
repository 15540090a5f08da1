# SPDX-License-Identifier: MIT
"""Smoothing of noisy angles of a leg that turns unevenly, with the uncertainty that noise leaves.

The angles f at the times t_i are those that minimise

    sum (theta_i - f_i)^2 + stiffness * sum (change of slope at t_i)^2 / h_i,

where h_i is the mean of the two intervals beside t_i: a discrete smoothing spline. Its stiffness is
that of the least generalised cross-validation (Craven and Wahba 1979). The minimum is the mean of a
Gaussian process, whose slope is a random walk, given the angles (Wahba 1978); draws are of it.
"""

from dataclasses import dataclass
from functools import cached_property
from typing import NamedTuple

import numpy as np
from scipy.linalg import cho_solve_banded, cholesky_banded

from model.arrays import Array

STIFFNESS = np.logspace(-2, 9, 45)  # that are tried, with the mean interval as the unit of time
SHORTEST = 0.01  # mean intervals: samples that are closer would leave the matrix singular


class Fit(NamedTuple):
    """Smooth angles of a leg.

    Attributes:
        angle: The smooth angles at the samples' times, shape (n,) [rad].
        noise: Standard deviation of the samples about them [rad].
        stiffness: Ratio of the noise's variance to that of the slope's random walk.
        factor: Cholesky factor of the matrix that the angles solve, bands of shape (3, n).
    """

    angle: Array
    noise: float
    stiffness: float
    factor: Array


@dataclass(frozen=True)
class SmoothedLeg:
    """Noisy angles of one leg, smoothed.

    Attributes:
        t: Times of the samples, strictly increasing, at least three, shape (n,) [s].
        theta: Noisy angles, shape (n,) [rad].
    """

    t: Array
    theta: Array

    def corners(self, rng: np.random.Generator | None) -> tuple[Array, Array]:
        """Return the samples' times [s] and smooth angles [rad] there, shape (n,) each.

        Args:
            rng: Source of randomness, to draw one of the motions that the noise allows; None for
                their mean.
        """
        fit = self.fit
        if rng is None:
            return self.t, fit.angle
        # A motion of the process, less what is rebuilt of it from noisy samples, is an error as
        # large as that of the smooth angles (Matheron's rule).
        turns = rng.normal(0.0, fit.noise * np.sqrt(self._near / fit.stiffness))
        slopes = np.append(0.0, np.cumsum(turns))
        motion = np.append(0.0, np.cumsum(slopes * self._apart))
        seen = motion + rng.normal(0.0, fit.noise, len(motion))
        return self.t, fit.angle + motion - cho_solve_banded((fit.factor, False), seen)

    @cached_property
    def fit(self) -> Fit:
        """Smooth angles of the stiffness of least cross-validation error.

        The trace that it needs is estimated by a vector of random signs (Hutchinson 1989).
        """
        line = np.polynomial.Polynomial.fit(self.t, self.theta, 1)(self.t)  # smoothing keeps lines
        signs = np.random.default_rng(0).choice([-1.0, 1.0], len(self.t))
        both = np.column_stack([self.theta - line, signs])

        def fitted(stiffness: float) -> tuple[float, Fit]:
            """Return the error of generalised cross-validation (up to a factor), and the fit."""
            factor = self._factor(stiffness)
            smooth = cho_solve_banded((factor, False), both)
            squares = float(np.sum((both - smooth)[:, 0] ** 2))
            freedom = float(signs @ (signs - smooth[:, 1]))
            fit = Fit(line + smooth[:, 0], float(np.sqrt(squares / freedom)), stiffness, factor)
            return squares / freedom**2, fit

        return min(map(fitted, STIFFNESS.tolist()), key=lambda one: one[0])[1]

    @cached_property
    def _apart(self) -> Array:
        """Intervals between samples, of mean one and at least `SHORTEST`, shape (n - 1,)."""
        return np.maximum(np.diff(self.t) / np.diff(self.t).mean(), SHORTEST)

    @cached_property
    def _near(self) -> Array:
        """Mean of the two intervals beside each inner sample, shape (n - 2,)."""
        return 0.5 * (self._apart[1:] + self._apart[:-1])

    @cached_property
    def _penalty(self) -> Array:
        """Matrix of the penalty, sum (change of slope)^2 / h, in scipy's upper bands (3, n)."""
        before, after = 1 / self._apart[:-1], 1 / self._apart[1:]
        rows = np.array([before, -before - after, after]) / np.sqrt(self._near)
        bands = np.zeros((3, len(self.t)))
        for i in range(3):
            for j in range(i, 3):
                bands[2 - j + i, j : len(self.t) - 2 + j] += rows[i] * rows[j]
        return bands

    def _factor(self, stiffness: float) -> Array:
        """Return the upper Cholesky factor of I + stiffness * penalty, in bands (3, n)."""
        bands = stiffness * self._penalty
        bands[2] += 1.0
        return cholesky_banded(bands)
