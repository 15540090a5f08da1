# SPDX-License-Identifier: MIT
"""Consistency of a track with an ensemble of paths.

Errors of one walk are correlated in time, so the chi-square bands of independent errors reject
perfect models. Here every statistic is compared with its distribution over the ensemble's own draws
with the tracker's noise added, which is right for any correlation.
"""

from dataclasses import dataclass

import numpy as np

from model.arrays import Array
from model.errors import InsufficientData
from model.metrics.scores import centred
from model.poses import Poses
from model.travel import travel_direction

STATISTICS = ("nees", "along", "cross", "yaw")
FEWEST_DRAWS = 50
LEVEL = 0.95  # of the central intervals


@dataclass(frozen=True)
class Consistency:
    """One statistic of a track, with the interval of that statistic over the ensemble's draws.

    Attributes:
        name: One of `STATISTICS`; nees: normalised error squared over its dimension; along, cross
            (to the left of the direction of travel), yaw: error, ensemble mean minus track.
        value: The statistic of the track [-] for nees, [m] for along and cross, [rad] for yaw.
        low: Lower end of the draws' central 95 % interval, in the same unit.
        high: Upper end of the draws' central 95 % interval, in the same unit.
        p_value: Two-sided p-value: twice the share of draws, the track counted among them, at
            least as far out as the track, on the side with fewer of them, at most 1 [-].
    """

    name: str
    value: float
    low: float
    high: float
    p_value: float

    @property
    def consistent(self) -> bool:
        """Whether the track's value lies from `low` to `high`, ends included."""
        return self.low <= self.value <= self.high


def consistency(draws: Array, observed: Array) -> tuple[Consistency, ...]:
    r"""Compare statistics of a track with the same statistics of draws with tracker noise.

    Statistics: the mean over time of the normalised error squared
    :math:`e_i^T P_i^{-1} e_i / k`, with e_i the track minus the ensemble's mean and P_i the
    covariance of the draws with noise, which is about 1, larger where the ensemble is too narrow
    and smaller where it is too wide; and the signed mean over time of the error (ensemble mean
    minus track) along and to the left of the mean's direction of travel, and of yaw, which
    distinguish a wrong speed from a wrong heading.

    Args:
        draws: x, y, yaw of every draw at the track's times, tracker noise included, shape (m, n, 3)
            [m, m, rad].
        observed: Tracked x, y, yaw, shape (n, 3) [m, m, rad]; k is 3, or 2 (x and y) with any NaN
            yaw.

    Returns:
        One result a statistic, in the order of `STATISTICS`; without yaw if k is 2.

    Raises:
        InsufficientData: There are fewer than 50 draws.
    """
    if len(draws) < FEWEST_DRAWS:
        raise InsufficientData(
            f"{len(draws)} draws are too few for an interval; draw {FEWEST_DRAWS} or more"
        )
    k = 3 if np.isfinite(observed[:, 2]).all() else 2
    seen = draws[..., :k]
    track = centred(draws, observed)[:, :k]
    own = _statistics(seen, seen)
    its = _statistics(track[None], seen)
    return tuple(
        _compared(name, float(its[i, 0]), own[i]) for i, name in enumerate(STATISTICS) if i <= k
    )


def nees(points: Array, draws: Array) -> Array:
    r"""Compute the normalised estimation error squared (NEES) of points, over its dimension k.

    Args:
        points: Points (x, y and, if k = 3, yaw) of p paths at n times, shape (p, n, k).
        draws: The ensemble's m draws of the points at the same times, shape (m, n, k).

    Returns:
        :math:`e^T P^{-1} e / k`, with e the point minus the ensemble's mean and P the ensemble's
        covariance at that time, shape (p, n) [-].
    """
    mean = draws.mean(axis=0)
    away = draws - mean
    P = np.einsum("mni,mnj->nij", away, away) / (len(draws) - 1)
    # Where every draw starts from one pose the spread is nil; a nanometre keeps it invertible.
    P = P + 1e-18 * np.eye(P.shape[-1])
    e = points - mean
    return np.einsum("pni,nij,pnj->pn", e, np.linalg.inv(P), e) / points.shape[-1]


def _statistics(points: Array, draws: Array) -> Array:
    """Compute the statistics of p paths (p, n, k) against an ensemble (m, n, k).

    Rows of the result, shape (k + 1, p): mean over time of NEES / k [-]; mean over time of the
    ensemble's mean minus the path along the mean's direction of travel and to the left of it [m];
    mean over time of the ensemble's mean yaw minus the path's [rad], only if k = 3.
    """
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
    """Compute interval and p-value of a track's statistic from the draws' statistics `own`."""
    low, high = np.quantile(own, [(1 - LEVEL) / 2, (1 + LEVEL) / 2])
    below = (1 + np.sum(own <= value)) / (len(own) + 1)
    above = (1 + np.sum(own >= value)) / (len(own) + 1)
    return Consistency(name, value, float(low), float(high), float(min(1.0, 2 * min(below, above))))
