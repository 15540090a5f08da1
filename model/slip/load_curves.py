# SPDX-License-Identifier: MIT
"""Points of slip, load and traction as curves, one for each load."""

from dataclasses import dataclass
from typing import Final

import numpy as np

from model.arrays import Array
from model.errors import DomainError

LOAD_GAP: Final = 1.1
"""Ratio of successive loads above which they are two loads that were set."""
_SAME_SLIP = 1e-3  # of the range of slip: points closer than this are one point


@dataclass(frozen=True)
class LoadCurve:
    """Sampled slip curve at one load.

    Attributes:
        load: Median normal force of the points [N].
        slip: Slip ratios, increasing, shape (n,) [-].
        force: Traction force at each, shape (n,) [N].
    """

    load: float
    slip: Array
    force: Array

    def driving(self) -> "LoadCurve":
        """Return the points at slip zero or above."""
        kept = self.slip >= 0
        return LoadCurve(self.load, self.slip[kept], self.force[kept])

    def braking(self) -> "LoadCurve":
        """Return the points at slip zero or below, mirrored to positive slip and force."""
        kept = self.slip <= 0
        return LoadCurve(self.load, -self.slip[kept][::-1], -self.force[kept][::-1])

    def force_at(self, slip: Array) -> Array:
        """Interpolate the force linearly between the points [N].

        A curve without points below zero slip is odd, one that starts above zero slip passes
        through the origin, and outside its range the result is NaN.

        Args:
            slip: Slip ratios, any shape [-].
        """
        slip = np.asarray(slip, dtype=float)
        x, y = self.slip, self.force
        if x[0] > 0:
            x, y = np.append(0.0, x), np.append(0.0, y)
        if x[0] >= 0:
            sign = np.where(slip < 0, -1.0, 1.0)
            return sign * np.interp(np.abs(slip), x, y, right=np.nan)
        return np.interp(slip, x, y, left=np.nan, right=np.nan)


def curves_by_load(
    slip: Array, load: Array, force: Array, *, levels: Array | None = None
) -> tuple[LoadCurve, ...]:
    """Separate points into curves by load, and sort each by slip.

    Forces are scaled to the median load of their curve, as if proportional to load. Points whose
    slip differs by less than a thousandth of the range of slip are averaged.

    Args:
        slip: Slip ratio of each point, shape (n,) [-].
        load: Normal force of each point, positive, shape (n,) [N].
        force: Traction force of each point, shape (n,) [N].
        levels: Loads that were set, shape (m,) [N]: each point belongs to the nearest by ratio.
            None: a load whose ratio to the next lower one is above `LOAD_GAP` begins a new curve.

    Returns:
        The curves, by rising load.

    Raises:
        DomainError: There are no points, or a load is not positive.
    """
    if not len(slip) or not np.all(load > 0):
        raise DomainError("a slip curve needs points at positive loads; check the loads")
    if levels is None:
        order = np.argsort(load)
        edges = np.flatnonzero(load[order][1:] > LOAD_GAP * load[order][:-1]) + 1
        groups = np.split(order, edges)
    else:
        nearest = np.argmin(np.abs(np.log(load[:, None] / np.sort(levels))), axis=1)
        groups = [np.flatnonzero(nearest == index) for index in range(len(levels))]
    return tuple(_curve(slip[rows], load[rows], force[rows]) for rows in groups if len(rows))


def _curve(slip: Array, load: Array, force: Array) -> LoadCurve:
    """Return the points of one curve, their forces scaled in proportion to the median load."""
    level = float(np.median(load))
    return LoadCurve(level, *_merged(slip, force * level / load))


def _merged(slip: Array, force: Array) -> tuple[Array, Array]:
    """Sort points by slip and average those of nearly equal slip; return slip and force, (m,) each.

    A point is averaged with the one before it if its slip is larger by at most `_SAME_SLIP` of the
    range of slip.
    """
    order = np.argsort(slip)
    x, y = slip[order], force[order]
    begins = np.append(True, np.diff(x) > _SAME_SLIP * np.ptp(x)) if np.ptp(x) > 0 else x == x[0]
    starts = np.flatnonzero(begins) if np.ptp(x) > 0 else np.array([0])
    sizes = np.diff(np.append(starts, len(x)))
    return np.add.reduceat(x, starts) / sizes, np.add.reduceat(y, starts) / sizes
