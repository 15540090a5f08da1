# SPDX-License-Identifier: MIT
"""Planar poses at irregular times: what a track is, and what a path becomes to be compared."""

from dataclasses import dataclass

import numpy as np
from numpy.typing import ArrayLike, NDArray

from model.errors import DomainError, InsufficientData
from model.slip.law import Array

STANDING = 1e-6  # m: between poses closer than this there is no direction of travel


@dataclass(frozen=True)
class Poses:
    """Planar poses over time.

    Attributes:
        t: Times, strictly increasing, not necessarily evenly spaced, shape (n,) [s].
        position: Positions, shape (n, 2) [m].
        yaw: Unwrapped headings, shape (n,) [rad]; NaN throughout where nobody measured them.

    Raises:
        DomainError: Shapes do not match, times do not increase or a position is not finite.
    """

    t: Array
    position: Array
    yaw: Array

    def __post_init__(self) -> None:
        """Refuse what is no path."""
        n = len(self.t)
        if self.t.shape != (n,) or self.position.shape != (n, 2) or self.yaw.shape != (n,):
            raise DomainError(
                f"times {self.t.shape}, positions {self.position.shape} and headings "
                f"{self.yaw.shape} do not match; expected (n,), (n, 2), (n,)"
            )
        if not np.all(np.diff(self.t) > 0):
            worst = int(np.argmin(np.diff(self.t) > 0))
            raise DomainError(
                f"time goes from {self.t[worst]:g} to {self.t[worst + 1]:g} s at pose {worst + 1}; "
                "expected increasing times"
            )
        if not (np.isfinite(self.t).all() and np.isfinite(self.position).all()):
            raise DomainError("a time or position is not finite; leave such poses out")

    def __len__(self) -> int:
        """Count the poses."""
        return len(self.t)

    @property
    def has_yaw(self) -> bool:
        """Tell whether every heading is known."""
        return bool(np.isfinite(self.yaw).all())

    @property
    def travelled(self) -> Array:
        """Distance travelled up to each pose, along straight lines between them, shape (n,) [m]."""
        steps = np.linalg.norm(np.diff(self.position, axis=0), axis=1)
        return np.concatenate([[0.0], np.cumsum(steps)])

    @property
    def length(self) -> float:
        """Length of the line through all poses [m]."""
        return float(self.travelled[-1]) if len(self) else 0.0

    def part(self, keep: slice | NDArray[np.bool_] | NDArray[np.intp]) -> "Poses":
        """Return some of the poses."""
        return Poses(self.t[keep], self.position[keep], self.yaw[keep])

    def at(self, t: ArrayLike) -> "Poses":
        """Interpolate linearly at times within the path; yaw takes the unwrapped way.

        Args:
            t: Times, shape (m,) [s].

        Raises:
            DomainError: A time lies outside the path: nothing is extrapolated.
        """
        at = np.asarray(t, dtype=float)
        if len(at) and (at.min() < self.t[0] or at.max() > self.t[-1]):
            raise DomainError(
                f"poses are asked for from {at.min():g} to {at.max():g} s, but the path runs from "
                f"{self.t[0]:g} to {self.t[-1]:g} s"
            )
        x, y, yaw = (np.interp(at, self.t, a) for a in (*self.position.T, self.yaw))
        return Poses(at, np.column_stack([x, y]), yaw)

    def moved(self, *, rotation: float, translation: ArrayLike) -> "Poses":
        """Turn the whole path about the origin, then shift it.

        Args:
            rotation: Angle [rad].
            translation: Shift, shape (2,) [m].
        """
        c, s = np.cos(rotation), np.sin(rotation)
        turned = self.position @ np.array([[c, s], [-s, c]])
        return Poses(self.t, turned + np.asarray(translation), self.yaw + rotation)


def overlap(first: Poses, second: Poses) -> NDArray[np.bool_]:
    """Tell which poses of `first` lie within the time of `second`, shape (len(first),).

    Raises:
        InsufficientData: Fewer than two do, so that there is no path to compare.
    """
    inside = (first.t >= second.t[0]) & (first.t <= second.t[-1])
    if inside.sum() < 2:
        raise InsufficientData(
            f"{inside.sum()} of {len(first)} poses from {first.t[0]:g} to {first.t[-1]:g} s lie "
            f"within the other path's {second.t[0]:g} to {second.t[-1]:g} s; two are needed: do "
            "both keep the same clock?"
        )
    return inside


def travel_direction(poses: Poses) -> Array:
    """Compute the direction of travel at each pose from its neighbours, shape (n,) [rad].

    Where a robot stands, the direction is that of the last move before, or of the first after;
    zero for one that never moves.
    """
    before = np.maximum(np.arange(len(poses)) - 1, 0)
    after = np.minimum(np.arange(len(poses)) + 1, len(poses) - 1)
    chord = poses.position[after] - poses.position[before]
    moving = np.flatnonzero(np.linalg.norm(chord, axis=1) > STANDING)
    if len(moving) == 0:
        return np.zeros(len(poses))
    last = moving[np.maximum(np.searchsorted(moving, np.arange(len(poses)), side="right") - 1, 0)]
    return np.arctan2(chord[last, 1], chord[last, 0])


def wrap(angle: ArrayLike) -> Array:
    """Return angles in [-pi, pi), the way errors of headings are compared [rad].

    >>> float(wrap(3 * np.pi / 2).round(4))
    -1.5708
    """
    return (np.asarray(angle, dtype=float) + np.pi) % (2 * np.pi) - np.pi
