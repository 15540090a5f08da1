# SPDX-License-Identifier: MIT
"""The Laplace approximation: a mode, the curvature there, and draws weighted to the posterior."""

from collections.abc import Callable
from dataclasses import dataclass
from typing import Any

import numpy as np
from scipy.optimize import minimize
from scipy.stats import multivariate_t

from model.errors import FitError
from model.slip.law import Array

LogDensity = Callable[[Array], Array]
STEP = 1e-4  # coordinates are of unit scale a priori; central differences err by about its square


@dataclass(frozen=True)
class Laplace:
    """A Gaussian at the posterior's mode.

    Attributes:
        mode: Coordinates of the mode, shape (d,).
        covariance: Inverse of the negative Hessian of the log density, shape (d, d).
        log_density: Log density at the mode.
    """

    mode: Array
    covariance: Array
    log_density: float

    def log_evidence(self) -> float:
        """Compute the log of the integral of the density, in the Gaussian approximation."""
        d = len(self.mode)
        return self.log_density + 0.5 * (
            d * np.log(2 * np.pi) + np.linalg.slogdet(self.covariance)[1]
        )


def gradient(log_density: LogDensity, z: Array) -> Array:
    """Compute the gradient by central differences, in one batched call, shape (d,)."""
    steps = STEP * np.eye(len(z))
    both = log_density(np.concatenate([z + steps, z - steps]))
    return (both[: len(z)] - both[len(z) :]) / (2 * STEP)


def hessian(log_density: LogDensity, z: Array, *, step: float = 1e-3) -> Array:
    """Compute the Hessian by central differences, in one batched call, shape (d, d)."""
    d = len(z)
    rows, columns = np.triu_indices(d)
    e = step * np.eye(d)
    corners = [z + a * e[rows] + b * e[columns] for a in (1, -1) for b in (1, -1)]
    pp, pm, mp, mm = np.split(log_density(np.concatenate(corners)), 4)
    matrix = np.zeros((d, d))
    matrix[rows, columns] = (pp - pm - mp + mm) / (4 * step**2)
    return matrix + np.triu(matrix, 1).T


def find_mode(log_density: LogDensity, starts: Array) -> Laplace:
    """Climb from several starting points and approximate the posterior at the highest mode.

    Args:
        log_density: Log density of coordinates (w, d), -inf out of support.
        starts: Starting points, shape (m, d).

    Returns:
        The Laplace approximation at the best mode found.

    Raises:
        FitError: No start lies inside the support.
    """
    best, covariance = _newton(log_density, climb(log_density, starts))
    return Laplace(best, covariance, float(log_density(best[None])[0]))


def climb(log_density: LogDensity, starts: Array) -> Array:
    """Climb from several starting points and return the coordinates of the highest top.

    Args:
        log_density: Log density of coordinates (w, d), -inf out of support.
        starts: Starting points, shape (m, d).

    Returns:
        Coordinates, shape (d,).

    Raises:
        FitError: No start lies inside the support.
    """
    inside = starts[np.isfinite(log_density(starts))]
    if len(inside) == 0:
        raise FitError(
            f"the posterior is zero at all {len(starts)} starting points; the law cannot take a "
            "shape its priors allow on these loads"
        )
    tops = [_climb(log_density, start) for start in inside]
    return max(tops, key=lambda z: float(log_density(z[None])[0]))


def _climb(log_density: LogDensity, start: Array) -> Array:
    def negative(z: Array) -> tuple[float, Array]:
        value = float(log_density(z[None])[0])
        if not np.isfinite(value):
            return 1e12, np.zeros_like(z)
        slope = gradient(log_density, z)
        return -value, -np.where(np.isfinite(slope), slope, 0.0)

    return minimize(negative, start, jac=True, method="L-BFGS-B", options={"maxiter": 300}).x


def _newton(log_density: LogDensity, z: Array, *, steps: int = 4) -> tuple[Array, Array]:
    """Polish a mode by damped Newton steps; return it with the covariance there."""
    covariance = _covariance(log_density, z)
    for _ in range(steps):
        slope = gradient(log_density, z)
        move = covariance @ np.where(np.isfinite(slope), slope, 0.0)
        trials = z + move * np.array([1.0, 0.5, 0.25, 0.1])[:, None]
        heights = log_density(np.vstack([z, trials]))
        if heights[1:].max() <= heights[0]:
            break
        z = trials[np.argmax(heights[1:])]
        covariance = _covariance(log_density, z)
    return z, covariance


def _covariance(log_density: LogDensity, z: Array) -> Array:
    """Invert the negative Hessian, with every variance within (0, 1].

    Coordinates are standard normal a priori and data only narrow them, so an eigenvalue of the
    precision below 1 is a fold of the density or a difference across the edge of the support.
    """
    precision = -hessian(log_density, z)
    precision = np.where(np.isfinite(precision), precision, 0.0)
    eigenvalues, vectors = np.linalg.eigh(precision)
    return (vectors / np.maximum(eigenvalues, 1.0)) @ vectors.T


@dataclass(frozen=True)
class WeightedDraws:
    """Draws with importance weights.

    Attributes:
        z: Coordinates, shape (n, d).
        weights: Normalised weights, shape (n,).
        pareto_k: Tail index of the raw weights; above 0.7 the weights are not to be trusted.
    """

    z: Array
    weights: Array
    pareto_k: float

    def resample(self, n: int, *, rng: np.random.Generator) -> Array:
        """Draw n equally weighted coordinates, shape (n, d)."""
        return self.z[rng.choice(len(self.z), size=n, p=self.weights)]


def importance_draws(
    log_density: LogDensity, laplace: Laplace, *, n: int, rng: np.random.Generator
) -> WeightedDraws:
    """Draw from a heavy-tailed Laplace approximation and weight by the posterior.

    Pareto-smoothed importance sampling (Vehtari et al. 2024): the second engine, which shares
    nothing with the sampler but the density.

    Args:
        log_density: Log density of coordinates (w, d).
        laplace: The approximation to draw from, widened to a Student-t with 8 degrees of freedom.
        n: Number of draws.
        rng: Source of randomness.
    """
    import arviz as az

    frozen: Any = multivariate_t  # scipy's stub has the covariance as an int
    proposal = frozen(laplace.mode, laplace.covariance, df=8, seed=rng)
    z: Array = np.asarray(proposal.rvs(size=n), dtype=float).reshape(n, -1)
    batches = np.array_split(z, n // 64 + 1)
    ratio = np.concatenate([log_density(batch) for batch in batches]) - proposal.logpdf(z)
    ratio = np.where(np.isfinite(ratio), ratio, -1e6 + ratio[np.isfinite(ratio)].max())
    smoothed, pareto_k = az.psislw(ratio)
    weights = np.exp(np.asarray(smoothed))
    return WeightedDraws(z, weights / weights.sum(), float(pareto_k))
