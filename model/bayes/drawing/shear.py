# SPDX-License-Identifier: MIT
r"""Shear of coordinates along which a posterior that lies along a curved ridge becomes straight.

Where two parameters nearly make up for each other, the posterior is long in some directions, narrow
in others and curved: a rig that measures one side of zero slip tells friction from rolling
resistance only by the shape of the curve. Neither draws from a Gaussian nor steps of a sampler
along straight lines stay on such a ridge. In the eigenvectors of the covariance at the mode the
coordinates v of wide directions therefore shift those of narrow ones by a polynomial q,

.. math::
    z = x + S\, q(v), \qquad v = L^T (x - x_0),

whose Jacobian determinant is 1, as q changes no v. It follows the narrow coordinates' places of
highest density: the shear is that of a conditional mode, and any polynomial leaves the posterior
itself as it is.
"""

from dataclasses import dataclass
from functools import cached_property
from itertools import combinations_with_replacement

import numpy as np
from numpy.typing import NDArray

from model.arrays import Array
from model.bayes.drawing.laplace import Laplace, LogDensity

WIDE = 0.1  # standard deviation of a direction that shifts others; 1 before the data
MOST_WIDE = 8  # directions that shift others
LOOK = 1.5  # distance from the mode at which shifts are looked for [sd]
BENT = 1.0  # shift there, over the narrow direction's sd, from which a posterior counts as curved
CUBIC = 0.3  # the same, from which a direction has terms of third degree
MOST_CUBIC = 4  # directions with such terms, those that shift most
SPREAD = 1.2  # of the points that the polynomial is fitted to [sd]
POINTS = 2.5  # of these for each term
LIKELY = 15.0  # fall of log density up to which a point is used [nat]
FAR = 4.0  # distance from the mode beyond which the shift is constant [sd]
STEPS = 8  # towards the highest density in the narrow directions, at most
SETTLED = 0.05  # gain of log density at which these end [nat]
SHARES = np.array([0.0, 1.0, 0.5, 0.25, 0.1, 0.03])  # of a Newton step that are tried


@dataclass(frozen=True)
class Shear:
    """Polynomial shear between coordinates x and z, each (..., d).

    Attributes:
        centre: Fixed point of the shear, shape (d,).
        wide: Matrix L, from coordinates to v, the wide directions in standard deviations, (d, m).
        terms: Indices of v that are multiplied in each term of the polynomial.
        shift: Coefficients of the terms, shape (terms, d).
    """

    centre: Array
    wide: Array
    terms: tuple[tuple[int, ...], ...]
    shift: Array

    @cached_property
    def _factors(self) -> list[tuple[NDArray[np.intp], NDArray[np.intp]]]:
        """Indices of the terms of each degree, and of v in their factors, (terms, degree)."""
        return [
            (
                np.array([i for i, term in enumerate(self.terms) if len(term) == degree]),
                np.array([term for term in self.terms if len(term) == degree], dtype=np.intp),
            )
            for degree in sorted({len(term) for term in self.terms})
        ]

    def sheared(self, x: Array) -> Array:
        """Map straightened coordinates x to z, shape (..., d)."""
        return x + self._shifted(x)

    def straightened(self, z: Array) -> Array:
        """Map coordinates z to straightened ones x, the inverse of `sheared`."""
        return z - self._shifted(z)

    def _shifted(self, x: Array) -> Array:
        """Compute S q(v), which is the same at x and z, since the shift changes no v."""
        v = np.clip((x - self.centre) @ self.wide, -FAR, FAR)
        shift = np.zeros_like(x)
        for index, factors in self._factors:
            product = v[..., factors[:, 0]]
            for factor in factors.T[1:]:
                product = product * v[..., factor]
            shift += product @ self.shift[index]
        return shift


def find_shear(log_density: LogDensity, mode: Laplace, rng: np.random.Generator) -> Shear | None:
    """Find the shear that straightens a density; None where it counts as straight.

    That is where no direction is wider than `WIDE` or all are, or where a step of `LOOK` in a wide
    direction shifts no narrow one by `BENT` standard deviations.

    Args:
        log_density: Log density of coordinates (w, d), standard normal a priori, -inf out of
            support.
        mode: The Laplace approximation at its highest mode.
        rng: Source of randomness of the points that the polynomial is fitted to.
    """
    variance, vectors = np.linalg.eigh(mode.covariance)
    variance, vectors = variance[::-1], vectors[:, ::-1]
    m = min(int(np.sum(variance > WIDE**2)), MOST_WIDE)
    if not 0 < m < len(variance):
        return None
    ridge = _Ridge(log_density, mode, vectors, np.sqrt(variance), m)
    axes = LOOK * np.concatenate([np.eye(m), -np.eye(m)])
    shifts, _ = ridge.settle(axes, np.zeros((2 * m, len(variance) - m)))
    largest = np.abs(shifts).max(axis=1).reshape(2, m).max(axis=0)
    if largest.max() < BENT:
        return None
    most = np.argsort(-largest)[:MOST_CUBIC]
    cubic = sorted(most[largest[most] > CUBIC].tolist())
    terms = (
        *combinations_with_replacement(range(m), 2),
        *combinations_with_replacement(cubic, 3),
    )
    even = 0.5 * (shifts[:m] + shifts[m:]) / LOOK**2
    points = SPREAD * rng.standard_normal((int(POINTS * len(terms)), m))
    found, height = ridge.settle(points, points**2 @ even)
    used = height > mode.log_density - LIKELY
    v, s = np.concatenate([axes, points[used]]), np.concatenate([shifts, found[used]])
    features = np.stack([np.prod(v[:, term], axis=1) for term in terms], axis=1)
    coefficients = np.linalg.lstsq(features, s, rcond=None)[0]
    wide = vectors[:, :m] / np.sqrt(variance[:m])
    return Shear(mode.mode, wide, terms, coefficients * ridge.sd[m:] @ vectors[:, m:].T)


@dataclass(frozen=True)
class _Ridge:
    """A density in the eigenvectors of the covariance at its mode, in standard deviations.

    Attributes:
        log_density: Log density of coordinates (w, d).
        mode: The Laplace approximation.
        vectors: Eigenvectors, the widest first, in columns, shape (d, d).
        sd: Standard deviations along them, shape (d,).
        m: Number of wide directions; the others are narrow.
    """

    log_density: LogDensity
    mode: Laplace
    vectors: Array
    sd: Array
    m: int

    def density(self, v: Array, s: Array) -> Array:
        """Compute the log density at wide (k, m) and narrow coordinates (k, l, n), shape (k, l)."""
        wide = np.broadcast_to(v[:, None], (*s.shape[:2], self.m))
        u = np.concatenate([wide, s], axis=2) * self.sd
        z = self.mode.mode + u @ self.vectors.T
        return self.log_density(z.reshape(-1, z.shape[-1])).reshape(s.shape[:2])

    def settle(self, v: Array, s: Array) -> tuple[Array, Array]:
        """Climb in the narrow directions by Newton steps with the covariance at the mode.

        Args:
            v: Wide coordinates, which stay, shape (k, m).
            s: Narrow coordinates to start from, shape (k, n).

        Returns:
            Narrow coordinates and log densities, shapes (k, n) and (k,).
        """
        s, height = s.copy(), self.density(v, s[:, None])[:, 0]
        moving = np.arange(len(v))
        for _ in range(STEPS):
            found, top = self._step(v[moving], s[moving])
            with np.errstate(invalid="ignore"):  # infinite outside the support
                gain = top - height[moving]
            s[moving], height[moving] = found, top
            moving = moving[gain > SETTLED]
            if len(moving) == 0:
                break
        return s, height

    def _step(self, v: Array, s: Array) -> tuple[Array, Array]:
        """Make one damped Newton step of each point's narrow coordinates; results as of `settle`.

        These are in standard deviations at the mode, so that the gradient is the Newton step.
        """
        rows, n, step = np.arange(len(v)), s.shape[1], 1e-3
        differences = step * np.concatenate([np.eye(n), -np.eye(n)])
        ahead, behind = np.split(self.density(v, s[:, None] + differences), 2, axis=1)
        with np.errstate(invalid="ignore"):  # infinities across the edge of the support
            slope = (ahead - behind) / (2 * step)
        moves = np.where(np.isfinite(slope), slope, 0.0)
        trials = s[:, None] + moves[:, None] * SHARES[:, None]
        heights = self.density(v, trials)
        best = np.argmax(heights, axis=1)
        return trials[rows, best], heights[rows, best]
