# SPDX-License-Identifier: MIT
"""Consistency of a track with an ensemble of paths.

Errors of one walk are correlated in time, so the chi-square bands of independent errors reject
perfect models. Here every statistic is compared with its distribution over the ensemble's own draws
with the tracker's noise added, which is right for any correlation.
"""

from dataclasses import dataclass

import numpy as np

from model.errors import InsufficientData
from model.metrics.scores import centred, with_tracker_noise
from model.poses import Poses, travel_direction
from model.slip.law import Array

STATISTICS = ("nees", "along", "cross", "yaw")
FEWEST_DRAWS = 50
LEVEL = 0.95  # of the intervals


@dataclass(frozen=True)
class Consistency:
    """One statistic of a track against the same of the ensemble's own draws.

    Attributes:
        name: One of `STATISTICS`.
        value: The track's.
        low: Lower end of the ensemble's central interval.
        high: Upper end of it.
        p_value: Two-sided share of draws at least as far out as the track [-].
    """

    name: str
    value: float
    low: float
    high: float
    p_value: float

    @property
    def consistent(self) -> bool:
        """Whether the track's value lies within the ensemble's interval."""
        return self.low <= self.value <= self.high


def consistency(
    draws: Array,
    observed: Array,
    covariance: Array,
    *,
    rng: np.random.Generator,
) -> tuple[Consistency, ...]:
    r"""Compare statistics of a track with those of the ensemble's draws with tracker noise.

    Statistics: the mean over time of the normalised error squared
    :math:`e_i^T P_i^{-1} e_i / k`, which is about 1, larger where the ensemble is too narrow and
    smaller where it is too wide; and the signed mean over time of the error along, across and of
    yaw, which distinguish a wrong speed from a wrong heading.

    Args:
        draws: x, y, yaw of every draw at the track's times, shape (m, n, 3) [m, m, rad].
        observed: Tracked x, y, yaw; yaw NaN throughout where unknown, shape (n, 3).
        covariance: The tracker's covariance at each time, shape (n, 3, 3).
        rng: Source of randomness.

    Returns:
        One result a statistic; yaw is left out where it is not known.

    Raises:
        InsufficientData: There are too few draws for an interval.
    """
    if len(draws) < FEWEST_DRAWS:
        raise InsufficientData(
            f"{len(draws)} draws are too few for an interval; draw {FEWEST_DRAWS} or more"
        )
    k = 3 if np.isfinite(observed[:, 2]).all() else 2
    seen = with_tracker_noise(draws, covariance, rng=rng)[..., :k]
    track = centred(draws, observed)[:, :k]
    own = _statistics(seen, seen)
    its = _statistics(track[None], seen)
    return tuple(
        _compared(name, float(its[i, 0]), own[i]) for i, name in enumerate(STATISTICS) if i <= k
    )


def nees(points: Array, draws: Array) -> Array:
    r"""Compute the normalised error squared of points against an ensemble, over its dimension.

    Args:
        points: Points of p paths at n times, shape (p, n, k).
        draws: The ensemble at the same times, shape (m, n, k).

    Returns:
        :math:`e^T P^{-1} e / k`, with mean and covariance P of the ensemble, shape (p, n) [-].
    """
    mean = draws.mean(axis=0)
    away = draws - mean
    P = np.einsum("mni,mnj->nij", away, away) / (len(draws) - 1)
    # Where every draw starts from one pose the spread is nil; a nanometre keeps it invertible.
    P = P + 1e-18 * np.eye(P.shape[-1])
    e = points - mean
    return np.einsum("pni,nij,pnj->pn", e, np.linalg.inv(P), e) / points.shape[-1]


def _statistics(points: Array, draws: Array) -> Array:
    """Return the statistics of each path, shape (statistics, p)."""
    mean = draws.mean(axis=0)
    n = len(mean)
    centre = Poses(np.arange(n, dtype=float), mean[:, :2], np.full(n, np.nan))
    direction = travel_direction(centre)
    c, s = np.cos(direction), np.sin(direction)
    e = mean - points
    along = (c * e[..., 0] + s * e[..., 1]).mean(axis=1)
    cross = (c * e[..., 1] - s * e[..., 0]).mean(axis=1)
    rows = [nees(points, draws).mean(axis=1), along, cross]
    if points.shape[-1] == 3:
        rows.append(e[..., 2].mean(axis=1))
    return np.stack(rows)


def _compared(name: str, value: float, own: Array) -> Consistency:
    low, high = np.quantile(own, [(1 - LEVEL) / 2, (1 + LEVEL) / 2])
    below = (1 + np.sum(own <= value)) / (len(own) + 1)
    above = (1 + np.sum(own >= value)) / (len(own) + 1)
    return Consistency(name, value, float(low), float(high), float(min(1.0, 2 * min(below, above))))
