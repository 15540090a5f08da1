# SPDX-License-Identifier: MIT
"""Planar poses over time: one path, or many draws of one."""

from dataclasses import dataclass, replace
from typing import Self

import numpy as np
from numpy.typing import ArrayLike, NDArray

from model.arrays import Array
from model.errors import DomainError, InsufficientData
from model.format_distinct import format_distinct
from model.joint_covariance import JointCovariance


@dataclass(frozen=True)
class Poses:
    """Planar poses over time: of one path, or of several draws of it at the same times.

    Attributes:
        t: Times, strictly increasing, not necessarily evenly spaced, shape (n,) [s].
        position: Positions x, y, shape (n, 2), or (draws, n, 2) for several draws [m].
        yaw: Unwrapped headings, shape (n,) or (draws, n) [rad]; NaN throughout where not
            measured.
        joint: Covariance of x, y and yaw of the n poses of one path with each other; None where it
            is not known.

    Raises:
        DomainError: Shapes do not match, times do not increase strictly, or a time or a position is
            not finite.
    """

    t: Array
    position: Array
    yaw: Array
    joint: JointCovariance | None = None

    def __post_init__(self) -> None:
        """Check that shapes match, that times increase and that times and positions are finite."""
        n = len(self.t)
        batch = self.yaw.shape[:-1]
        if (
            self.t.shape != (n,)
            or len(batch) > 1
            or self.position.shape != (*batch, n, 2)
            or self.yaw.shape != (*batch, n)
            or (self.joint is not None and len(self.joint) != n)
        ):
            poses = "no" if self.joint is None else len(self.joint)
            raise DomainError(
                f"times {self.t.shape}, positions {self.position.shape}, headings {self.yaw.shape} "
                f"or the covariance of {poses} poses do not match; expected (n,), (n, 2), (n,) and "
                "n poses or none; for m draws (n,), (m, n, 2) and (m, n)"
            )
        if not np.all(np.diff(self.t) > 0):
            worst = int(np.argmin(np.diff(self.t) > 0))
            before, after = format_distinct(*self.t[worst : worst + 2])
            raise DomainError(
                f"time goes from {before} to {after} s after pose "
                f"{worst + 1} (the first is 1); expected increasing times"
            )
        if not (np.isfinite(self.t).all() and np.isfinite(self.position).all()):
            raise DomainError("a time or position is not finite; leave such poses out")

    @classmethod
    def of_states(cls, t: Array, states: Array) -> Self:
        """Build poses without covariance from an array of x, y and yaw.

        Args:
            t: Times, shape (n,) [s].
            states: x, y and unwrapped yaw, shape (n, 3) or (draws, n, 3) [m, m, rad].

        Raises:
            DomainError: As for the class.
        """
        return cls(t, states[..., :2], states[..., 2])

    def __len__(self) -> int:
        """Return the number of times."""
        return len(self.t)

    @property
    def states(self) -> Array:
        """x, y and yaw in one array, shape (n, 3) or (draws, n, 3) [m, m, rad]."""
        return np.concatenate([self.position, self.yaw[..., None]], axis=-1)

    def draws(self, keep: int | slice = slice(None)) -> "Poses":
        """Select one draw as a single path, or several draws; a single path counts as one draw.

        Args:
            keep: Index of a draw for a path (n,), or a slice of draws for (draws, n).

        Returns:
            The poses, without covariance.
        """
        one = self.yaw.ndim == 1
        position, yaw = (self.position[None], self.yaw[None]) if one else (self.position, self.yaw)
        return Poses(self.t, position[keep], yaw[keep])

    @property
    def covariance(self) -> Array | None:
        """Covariance of x, y and yaw of each pose, in products of [m, m, rad], shape (n, 3, 3).

        None where it is not known.
        """
        return None if self.joint is None else self.joint.marginal

    @property
    def has_yaw(self) -> bool:
        """Whether every heading is finite."""
        return bool(np.isfinite(self.yaw).all())

    @property
    def length(self) -> float:
        """Length of the line through all poses of one path [m].

        That of a computed path. In a measured one noise adds to it: see `model.travel.path_length`.
        """
        return float(np.linalg.norm(np.diff(self.position, axis=0), axis=1).sum())

    def part(self, keep: slice | NDArray[np.bool_] | NDArray[np.intp]) -> "Poses":
        """Select poses by time, with their covariance.

        Args:
            keep: Slice, boolean mask (n,) or indices of the times.
        """
        joint = None if self.joint is None else self.joint.part(keep)
        return Poses(self.t[keep], self.position[..., keep, :], self.yaw[..., keep], joint)

    def delayed(self, offset: float) -> "Poses":
        """Return the same poses with an offset [s] added to all times."""
        return replace(self, t=self.t + offset)

    def at(self, t: ArrayLike) -> "Poses":
        """Interpolate one path linearly at times within it; yaw is interpolated unwrapped.

        Args:
            t: Times, shape (m,) [s].

        Returns:
            The poses at those times, without covariance.

        Raises:
            DomainError: A time lies outside the path's times (nothing is extrapolated), or the
                times do not increase strictly.
        """
        at = np.asarray(t, dtype=float)
        if len(at) and (at.min() < self.t[0] or at.max() > self.t[-1]):
            first, last, start, end = format_distinct(at.min(), at.max(), self.t[0], self.t[-1])
            raise DomainError(
                f"poses are asked for from {first} to {last} s, but the path runs from {start} to "
                f"{end} s"
            )
        x, y, yaw = (np.interp(at, self.t, a) for a in (*self.position.T, self.yaw))
        return Poses(at, np.column_stack([x, y]), yaw)

    def moved(self, *, rotation: float, translation: ArrayLike) -> "Poses":
        """Rotate one path about the origin, then translate it; covariance is dropped.

        Args:
            rotation: Angle, counter-clockwise, also added to yaw [rad].
            translation: Shift, shape (2,) [m].
        """
        c, s = np.cos(rotation), np.sin(rotation)
        turned = self.position @ np.array([[c, s], [-s, c]])
        return Poses(self.t, turned + np.asarray(translation), self.yaw + rotation)


def overlap(first: Poses, second: Poses) -> NDArray[np.bool_]:
    """Find the poses of `first` that lie within the time range of `second`, ends included.

    Args:
        first: Poses to choose from.
        second: Poses whose time range is used, by the same clock.

    Returns:
        Whether each pose of `first` lies inside, shape (len(first),).

    Raises:
        InsufficientData: Fewer than two poses lie inside, so that there is no path to compare.
    """
    inside = (first.t >= second.t[0]) & (first.t <= second.t[-1])
    if inside.sum() < 2:
        begin, end, low, high = format_distinct(*first.t[[0, -1]], *second.t[[0, -1]])
        raise InsufficientData(
            f"{inside.sum()} of {len(first)} poses from {begin} to {end} s lie within the other "
            f"path's {low} to {high} s; two are needed: do both keep the same clock?"
        )
    return inside


def compose(pose: Array, moves: Array) -> Array:
    """Move from a pose by displacements in the pose's frame: composition in SE(2).

    Args:
        pose: x, y and yaw, shape (3,) [m, m, rad].
        moves: Displacements forward and to the left, and turns, shape (n, 3) [m, m, rad].

    Returns:
        Poses in the frame that `pose` is given in, shape (n, 3) [m, m, rad].
    """
    c, s = np.cos(pose[2]), np.sin(pose[2])
    x, y, yaw = moves.T
    return np.column_stack([pose[0] + c * x - s * y, pose[1] + s * x + c * y, pose[2] + yaw])


def relative(states: Array, first: Array) -> Array:
    """Express poses in the frame of another pose, the inverse of `compose`.

    Args:
        states: x, y and yaw, shape (..., 3) [m, m, rad].
        first: x, y and yaw of the other pose, shape (3,), or one for each of `states`, (..., 3).

    Returns:
        Displacements forward and to the left, and turns (not wrapped), shape (..., 3) [m, m, rad].
    """
    c, s = np.cos(first[..., 2]), np.sin(first[..., 2])
    x, y, yaw = np.moveaxis(states - first, -1, 0)
    return np.stack([c * x + s * y, c * y - s * x, yaw], axis=-1)


def moved_onto(states: Array, own: Array, wanted: Array) -> Array:
    """Move paths rigidly, each such that one given pose of the path becomes a wanted pose.

    Args:
        states: x, y and yaw of m paths at n times, shape (m, n, 3) [m, m, rad].
        own: Pose of each path before the move, shape (m, 3).
        wanted: That pose after the move, shape (3,), or (m, 3) for one of each path.

    Returns:
        x, y and yaw of the moved paths, shape (m, n, 3) [m, m, rad].
    """
    to = np.broadcast_to(wanted, own.shape)[:, None]
    turn = to[..., 2] - own[:, None, 2]
    c, s = np.cos(turn), np.sin(turn)
    x, y = np.moveaxis(states[..., :2] - own[:, None, :2], -1, 0)
    moved = to[..., 0] + c * x - s * y, to[..., 1] + s * x + c * y, states[..., 2] + turn
    return np.stack(moved, axis=-1)


def wrap(angle: ArrayLike) -> Array:
    """Wrap angles into [-pi, pi), the range of heading errors [rad].

    >>> float(wrap(3 * np.pi / 2).round(4))
    -1.5708
    """
    return (np.asarray(angle, dtype=float) + np.pi) % (2 * np.pi) - np.pi
