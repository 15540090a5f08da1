# SPDX-License-Identifier: MIT
"""Laplace approximation: modes of a density, and the covariances there."""

from collections.abc import Callable
from dataclasses import dataclass

import numpy as np
from scipy.optimize import minimize

from model.arrays import Array
from model.errors import FitError

LogDensity = Callable[[Array], Array]
SAME_TOP = 0.05  # maxima closer than this in coordinates are the same mode
NEGLIGIBLE = 10.0  # nats of evidence below the best mode's, beyond which a mode is left out
ITERATIONS = 15  # of a search for a mode in one scaling
ROUNDS = 20  # scalings of a search
STEP = 1e-4  # coordinates are of unit scale a priori; central differences err by about its square


@dataclass(frozen=True)
class Laplace:
    """Laplace approximation: a Gaussian at a mode of the posterior.

    Attributes:
        mode: Coordinates of the mode, shape (d,).
        covariance: Inverse of the negative Hessian of the log density at the mode, with
            eigenvalues of at most 1, shape (d, d).
        log_density: Log density at the mode, up to the constant of the density that was given.
    """

    mode: Array
    covariance: Array
    log_density: float

    def log_evidence(self) -> float:
        """Compute the log of the density's integral over all coordinates, by the Gaussian."""
        d = len(self.mode)
        return self.log_density + 0.5 * (
            d * np.log(2 * np.pi) + np.linalg.slogdet(self.covariance)[1]
        )

    def distance(self, z: Array) -> float:
        """Compute the Mahalanobis distance of coordinates z, shape (d,), from the mode [-]."""
        away = z - self.mode
        return float(np.sqrt(away @ np.linalg.solve(self.covariance, away)))


def gradient(log_density: LogDensity, z: Array) -> Array:
    """Compute the gradient of a log density by central differences, in one batched call.

    Args:
        log_density: Log density of points, shape (m, d) to (m,).
        z: Coordinates of the point, shape (d,).

    Returns:
        Gradient, shape (d,); not finite where a step leaves the support.
    """
    return _value_and_gradient(log_density, z)[1]


def _value_and_gradient(log_density: LogDensity, z: Array) -> tuple[float, Array]:
    """Compute a log density and its gradient (d,) by central differences at one point (d,).

    Entries of the gradient are not finite where a step leaves the support.
    """
    steps = STEP * np.eye(len(z))
    value, *both = log_density(np.concatenate([z[None], z + steps, z - steps]))
    ahead, behind = np.reshape(both, (2, len(z)))
    with np.errstate(invalid="ignore"):  # infinities across the edge of the support
        return float(value), (ahead - behind) / (2 * STEP)


def hessian(log_density: LogDensity, z: Array, *, step: float = 1e-3) -> Array:
    """Compute the Hessian of a log density by central differences, in one batched call.

    Args:
        log_density: Log density of points, shape (m, d) to (m,).
        z: Coordinates of the point, shape (d,).
        step: Step of the differences, in coordinates.

    Returns:
        Hessian, shape (d, d); not finite where a step leaves the support.
    """
    d = len(z)
    rows, columns = np.triu_indices(d)
    e = step * np.eye(d)
    corners = [z + a * e[rows] + b * e[columns] for a in (1, -1) for b in (1, -1)]
    pp, pm, mp, mm = np.split(log_density(np.concatenate(corners)), 4)
    matrix = np.zeros((d, d))
    with np.errstate(invalid="ignore"):  # infinities across the edge of the support
        matrix[rows, columns] = (pp - pm - mp + mm) / (4 * step**2)
    return matrix + np.triu(matrix, 1).T


def find_mode(log_density: LogDensity, starts: Array) -> Laplace:
    """Maximise the log density from several starting points; approximate it at the highest mode.

    Args:
        log_density: Log density of coordinates (w, d), -inf out of support.
        starts: Starting points, shape (m, d).

    Returns:
        The Laplace approximation at the best mode found.

    Raises:
        FitError: No start lies inside the support.
    """
    return _laplace(log_density, climb(log_density, starts))


def find_modes(log_density: LogDensity, starts: Array) -> tuple[Laplace, ...]:
    """Maximise the log density from several starting points; approximate it at every mode found.

    Args:
        log_density: Log density of coordinates (w, d), -inf out of support.
        starts: Starting points, shape (m, d).

    Returns:
        The modes whose log evidence is within `NEGLIGIBLE` of the largest and which are over one
        standard deviation (Mahalanobis) apart, by log density, the highest first.

    Raises:
        FitError: No start lies inside the support.
    """
    tops: list[Array] = []
    for top in _tops(log_density, starts):
        if all(np.linalg.norm(top - known) > SAME_TOP for known in tops):
            tops.append(top)
    distinct: list[Laplace] = []
    for laplace in (_laplace(log_density, top) for top in tops):
        if all(known.distance(laplace.mode) > 1 for known in distinct):
            distinct.append(laplace)
    least = max(laplace.log_evidence() for laplace in distinct) - NEGLIGIBLE
    worthy = [laplace for laplace in distinct if laplace.log_evidence() > least]
    return tuple(sorted(worthy, key=lambda laplace: -laplace.log_density))


def _laplace(log_density: LogDensity, top: Array) -> Laplace:
    """Refine a maximum `top` by Newton steps and approximate the density there by a Gaussian."""
    mode, covariance = _newton(log_density, top)
    return Laplace(mode, covariance, float(log_density(mode[None])[0]))


def climb(log_density: LogDensity, starts: Array, covariance: Array | None = None) -> Array:
    """Maximise the log density from several starting points; return the coordinates of the best.

    Args:
        log_density: Log density of coordinates (w, d), -inf out of support.
        starts: Starting points, shape (m, d).
        covariance: About the covariance at the mode, (d, d), which scales the search; None for
            that at each start.

    Returns:
        Coordinates, shape (d,).

    Raises:
        FitError: No start lies inside the support.
    """
    return _tops(log_density, starts, covariance)[0]


def _tops(log_density: LogDensity, starts: Array, covariance: Array | None = None) -> list[Array]:
    """Maximise from every start inside the support; return the maxima, highest first.

    Raises `FitError` if no start is inside.
    """
    inside = starts[np.isfinite(log_density(starts))]
    if len(inside) == 0:
        raise FitError(
            f"the posterior density is zero at all {len(starts)} starting points: no curve within "
            "the law's priors fits these forces; check units and signs of slip and forces"
        )
    tops = [_climb(log_density, start, covariance) for start in inside]
    return sorted(tops, key=lambda z: -float(log_density(z[None])[0]))


def _climb(log_density: LogDensity, start: Array, covariance: Array | None = None) -> Array:
    """Maximise the log density from one start (d,); return where the search ended.

    L-BFGS-B in coordinates in which the density is about as wide in every direction: scaled by the
    covariance (d, d) first, where one is given, and by that at the place reached after each
    `ITERATIONS`. Ends after `ROUNDS` of these at the latest.
    """
    z = start
    for _ in range(ROUNDS):
        scaling = covariance_at(log_density, z) if covariance is None else covariance
        z, ended = _climb_scaled(log_density, z, scaling)
        if ended:
            break
        covariance = None
    return z


def _climb_scaled(log_density: LogDensity, start: Array, covariance: Array) -> tuple[Array, bool]:
    """Climb from a start for up to `ITERATIONS`; return the place, and whether the search ended.

    The coordinates u of the search are z = start + S u, with S the root of the covariance.
    """
    eigenvalues, vectors = np.linalg.eigh(covariance)
    root = vectors * np.sqrt(eigenvalues)

    def negative(u: Array) -> tuple[float, Array]:
        """Return minus the log density and its gradient by u; outside the support 1e12 and 0."""
        value, slope = _value_and_gradient(log_density, start + root @ u)
        if not np.isfinite(value):
            return 1e12, np.zeros_like(u)
        return -value, -root.T @ np.where(np.isfinite(slope), slope, 0.0)

    found = minimize(
        negative, np.zeros(len(start)), jac=True, method="L-BFGS-B",
        options={"maxiter": ITERATIONS},
    )  # fmt: skip
    return start + root @ found.x, found.nit < ITERATIONS


def _newton(log_density: LogDensity, z: Array, *, steps: int = 4) -> tuple[Array, Array]:
    """Refine a mode by at most `steps` damped Newton steps; return it and the covariance there.

    It ends when neither a whole step nor 0.5, 0.25 or 0.1 of one raises the log density.
    """
    covariance = covariance_at(log_density, z)
    for _ in range(steps):
        slope = gradient(log_density, z)
        move = covariance @ np.where(np.isfinite(slope), slope, 0.0)
        trials = z + move * np.array([1.0, 0.5, 0.25, 0.1])[:, None]
        heights = log_density(np.vstack([z, trials]))
        if heights[1:].max() <= heights[0]:
            break
        z = trials[np.argmax(heights[1:])]
        covariance = covariance_at(log_density, z)
    return z, covariance


def covariance_at(log_density: LogDensity, z: Array) -> Array:
    """Invert the negative Hessian at z, (d,), with the covariance's eigenvalues within (0, 1].

    Coordinates are standard normal a priori and data only narrow them. An eigenvalue of the
    precision below 1 is therefore a non-convexity of the density or a difference across the edge of
    the support; it is raised to 1. Entries of the Hessian that are not finite count as 0.
    """
    precision = -hessian(log_density, z)
    precision = np.where(np.isfinite(precision), precision, 0.0)
    eigenvalues, vectors = np.linalg.eigh(precision)
    return (vectors / np.maximum(eigenvalues, 1.0)) @ vectors.T
