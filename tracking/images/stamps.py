# SPDX-License-Identifier: MIT
"""Reconstruct the times of a regular interval timer from time stamps in whole seconds.

A stamp says s <= t < s + 1. If the timer is regular, t_k = t_0 + n_k T, and every stamp bounds
(t_0, T) to a strip of their plane. The intersection of all strips is a small polygon. Its centroid
and spread give every time to 0.02 to 0.1 s where T is no whole number of seconds, where one stamp
leaves 0.29 s, or 29 mm for a robot that walks 0.1 m/s. With T a whole number nothing is gained.
"""

from dataclasses import dataclass

import numpy as np
from numpy.typing import ArrayLike, NDArray
from scipy.optimize import linprog
from scipy.spatial import HalfspaceIntersection

from model.arrays import Array

_JITTERS = (0.0, 0.01, 0.02, 0.05, 0.1, 0.2)  # tried in this order [s]


@dataclass(frozen=True)
class IntervalFit:
    """Times of a regular interval timer fitted to whole-second stamps.

    Attributes:
        t: Time of each stamp's photograph, by the clock of the stamps, shape (n,); where the timer
            is regular, within two thirds of the stamps' resolution of the true time [s].
        sd: Standard deviation of each time, shape (n,) [s].
        interval: The timer's interval [s].
        missing: Exposures of the timer without a photograph, counted from 0 for the first stamp.
        jitter: Smallest of 0, 0.01, 0.02, 0.05, 0.1, 0.2 s with which all stamps agree, if every
            exposure may deviate by that much from the regular timer [s].
    """

    t: Array
    sd: Array
    interval: float
    missing: tuple[int, ...]
    jitter: float


def fit_interval(stamps: ArrayLike, *, resolution: float = 1.0) -> IntervalFit | None:
    """Fit start and interval of a regular timer to time stamps that were rounded down.

    Args:
        stamps: Time stamps in order of the photographs, shape (n,), n at least 1 [s].
        resolution: Step to which the stamps are rounded down [s].

    Returns:
        The fit of least jitter, then of fewest missing exposures; None for fewer than 3 stamps, for
        a last one not after the first, or where no regular timer agrees with the stamps, with up to
        n missing exposures if its interval is at least two steps of the stamps, else with none.
    """
    s = np.asarray(stamps, dtype=float)
    if len(s) < 3 or s[-1] <= s[0]:
        return None
    span = s[-1] - s[0]
    for jitter in _JITTERS:
        # The longest interval first: shorter ones with more skipped exposures always fit too.
        for intervals in range(len(s) - 1, 2 * len(s)):
            # Below two steps of the stamp a skipped exposure equals a slower timer.
            if intervals >= len(s) and span / intervals < 2 * resolution:
                break
            numbers = np.round((s - s[0]) * intervals / span).astype(int)
            if (np.diff(numbers) < 1).any():
                continue
            polygon = _common_polygon(s - s[0], numbers, resolution, jitter)
            if polygon is not None:
                return _times(s[0], numbers, polygon, jitter)
    return None


def _common_polygon(
    s: Array, numbers: NDArray[np.int64], resolution: float, jitter: float
) -> Array | None:
    """Intersect the strips of stamps `s` of exposures `numbers` (module docstring).

    Returns:
        Vertices (t_0, T), shape (m, 2), in any order [s]; None if empty or thinner than 1e-9 s.
    """
    ones = np.ones(len(s))
    # -t_0 - n T + s - jitter <= 0   and   t_0 + n T - s - resolution - jitter <= 0
    above = np.column_stack((-ones, -numbers, s - jitter))
    below = np.column_stack((ones, numbers, -s - resolution - jitter))
    halves = np.concatenate((above, below))
    length = np.linalg.norm(halves[:, :2], axis=1)
    # Chebyshev centre: HalfspaceIntersection needs a point inside, best far from all sides.
    inner = linprog(
        [0, 0, -1],
        A_ub=np.column_stack((halves[:, :2], length)),
        b_ub=-halves[:, 2],
        bounds=[(None, None), (None, None), (0, resolution)],
    )
    if not inner.success or inner.x[2] < 1e-9:
        return None
    return np.asarray(HalfspaceIntersection(halves, inner.x[:2]).intersections, dtype=float)


def _times(start: float, numbers: NDArray[np.int64], polygon: Array, jitter: float) -> IntervalFit:
    """Compute times and standard deviations from the centroid and spread of the polygon.

    A jitter up to `jitter` either way adds the variance of a uniform distribution.
    """
    centre, spread = _centroid(polygon)
    design = np.column_stack((np.ones(len(numbers)), numbers))
    variance = np.einsum("ni,ij,nj->n", design, spread, design) + jitter**2 / 3
    missing = sorted(set(range(int(numbers[-1]))) - {int(number) for number in numbers})
    return IntervalFit(
        start + design @ centre, np.sqrt(variance), float(centre[1]), tuple(missing), jitter
    )


def _centroid(polygon: Array) -> tuple[Array, Array]:
    """Compute mean (2,) and covariance (2, 2) of the uniform density on a convex polygon.

    Vertices (m, 2) in any order; if they enclose no area, the moments of the vertices.
    """
    middle = polygon.mean(axis=0)
    order = np.argsort(
        np.arctan2(*(polygon - middle).T[::-1] / np.ptp(polygon, axis=0)[::-1, None])
    )
    a = polygon[order] - middle
    b = np.roll(a, -1, axis=0)
    area = 0.5 * np.abs(a[:, 0] * b[:, 1] - a[:, 1] * b[:, 0])
    if area.sum() <= 0:
        return middle, np.cov(polygon.T, bias=True)
    weight = area / area.sum()
    mean = weight @ ((a + b) / 3)
    # Second moments of a triangle with one corner at the origin.
    second = np.einsum("n,nij->ij", weight / 12, _outer(a, a) + _outer(b, b) + _outer(a + b, a + b))
    return middle + mean, second - np.outer(mean, mean)


def _outer(a: Array, b: Array) -> Array:
    """Compute the outer product of each pair of vectors, shapes (n, 2), as (n, 2, 2)."""
    return np.einsum("ni,nj->nij", a, b)
