# SPDX-License-Identifier: MIT
"""Smooth planar poses at irregular times (Gaussian-process smoother); gaps stay gaps.

Between photographs the robot is assumed to keep its twist (forward speed, sideways speed, turning
rate in its own frame), disturbed by white noise. A constant twist is an arc, so the corners of a
turning path are not cut. For neighbours k and k + 1, dt apart (Barfoot, State Estimation for
Robotics, 2017, section 11.3, written for the plane):

    e = [ log(T_k^-1 T_k+1) - dt w_k ;  w_k+1 - w_k ],   cov e = [ dt³/3 dt²/2 ; dt²/2 dt ] x Q_c

The least-squares problem is block tridiagonal and solved as such. The two noise densities of Q_c
are those with the greatest marginal likelihood (Laplace's approximation) unless they are given.

The second line leaves out the Jacobian of the logarithm, which differs from one by half the turn
between two photographs; the noise density absorbs the difference.
"""

from dataclasses import dataclass
from typing import NamedTuple

import numpy as np
from numpy.typing import ArrayLike, NDArray
from scipy.optimize import minimize

from tracking.camera.lens import Array
from tracking.errors import PathError

_LONGEST_SEARCH = 200


class Process(NamedTuple):
    """Noise densities of the process: white noise on the twist's derivative.

    Attributes:
        travel: Noise density of the forward and of the sideways speed [m²/s³].
        turn: Noise density of the turning rate [rad²/s³].
    """

    travel: float
    turn: float


@dataclass(frozen=True)
class SmoothPath:
    """A smoothed path at the times of the photographs.

    Attributes:
        poses: x, y [m] and yaw [rad], yaw continuous within a segment, shape (n, 3).
        covariance: Covariance of `poses`, shape (n, 3, 3).
        twist: Forward speed, speed to the left [m/s] and turning rate [rad/s], shape (n, 3).
        segment: Number, from 0, of the stretch without gap that each sample is in, shape (n,).
        suspect: True where the squared Mahalanobis distance of a measured pose from the path, by
            the covariance of the measurement, exceeds 25 (3 degrees of freedom), shape (n,).
        process: The noise densities used, given or estimated.
    """

    poses: Array
    covariance: Array
    twist: Array
    segment: NDArray[np.int64]
    suspect: NDArray[np.bool_]
    process: Process

    @property
    def gap_before(self) -> NDArray[np.bool_]:
        """True for the first sample of every segment but the first, shape (n,)."""
        return np.diff(self.segment, prepend=self.segment[:1]) > 0


def smooth(
    t: ArrayLike,
    poses: ArrayLike,
    *,
    covariance: ArrayLike,
    time_sd: ArrayLike = 0.0,
    gap: float | None = None,
    process: Process | None = None,
) -> SmoothPath:
    """Smooth measured poses by least squares with a constant-twist motion model.

    Args:
        t: Times, strictly increasing, shape (n,) [s].
        poses: Measured x, y [m] and yaw [rad], shape (n, 3); yaw may wrap.
        covariance: Covariance of each measured pose, independent of each other, shape (n, 3, 3).
        time_sd: Standard deviation of each time, shape () or (n,) [s]; multiplied by the measured
            rate of change of the pose and squared, it is added to `covariance`.
        gap: Interval longer than which the path is interrupted [s]; None means 3.5 times the
            median interval.
        process: Noise densities of the motion model; None estimates them, or takes 1e-3 m²/s³ and
            1e-2 rad²/s³ where no segment has three poses.

    Returns:
        The path, at the times `t` only.

    Raises:
        PathError: When there is no pose, times do not increase or shapes disagree.
    """
    times, measured, spread = _checked(t, poses, covariance)
    stamp_sd = np.broadcast_to(np.asarray(time_sd, dtype=float), times.shape)
    segment = _segments(times, gap)
    parts = [
        _Chain.of(times[part], measured[part], spread[part], stamp_sd[part])
        for part in (np.flatnonzero(segment == number) for number in np.unique(segment))
    ]
    found = process or _likeliest(parts)
    solved = [part.solve(found) for part in parts]
    state = np.concatenate([solution.state for solution in solved])
    cov = np.concatenate([solution.covariance for solution in solved])
    residual = np.concatenate(
        [s.state[:, :3] - p.measured for s, p in zip(solved, parts, strict=True)]
    )
    noise = np.concatenate([part.spread for part in parts])
    far = np.einsum("ni,nij,nj->n", residual, np.linalg.inv(noise), residual) > 25
    return SmoothPath(state[:, :3], cov[:, :3, :3], state[:, 3:], segment, far, found)


def _checked(t: ArrayLike, poses: ArrayLike, covariance: ArrayLike) -> tuple[Array, Array, Array]:
    times, measured = np.asarray(t, dtype=float), np.asarray(poses, dtype=float)
    spread = np.asarray(covariance, dtype=float)
    n = len(times)
    if n == 0 or measured.shape != (n, 3) or spread.shape != (n, 3, 3):
        raise PathError(
            f"{n} times, poses of shape {measured.shape} and covariances of shape {spread.shape} "
            f"do not belong together; expected (n,), (n, 3) and (n, 3, 3), n at least 1"
        )
    late = np.flatnonzero(np.diff(times) <= 0)
    if late.size:
        k = int(late[0])
        raise PathError(
            f"pose {k + 2} is at {times[k + 1]:g} s and the one before it at {times[k]:g} s; times "
            f"must increase: correct them (--times), or delete one (`zebro-lab annotate --delete`)"
        )
    return times, measured, spread


def _segments(times: Array, gap: float | None) -> NDArray[np.int64]:
    intervals = np.diff(times)
    if intervals.size == 0:
        return np.zeros(len(times), dtype=np.int64)
    longest = 3.5 * float(np.median(intervals)) if gap is None else gap
    return np.concatenate(([0], np.cumsum(intervals > longest))).astype(np.int64)


def _likeliest(parts: list["_Chain"]) -> Process:
    """Estimate the noise densities by maximum marginal likelihood, with a wide prior.

    Of each segment the first 200 poses are used, segments of one or two poses are not. Without a
    segment of three poses the densities are 1e-3 m²/s³ and 1e-2 rad²/s³.
    """
    used = [part.head(_LONGEST_SEARCH) for part in parts if len(part.times) > 2]
    if not used:
        return Process(1e-3, 1e-2)

    def minus_log_likelihood(logs: Array) -> float:
        # A wide prior around a walking robot's densities keeps a path that shows no disturbance
        # at all (all its scatter is measurement noise) from sending them to zero.
        prior = 0.5 * float(np.sum(((logs - np.log([1e-4, 1e-3])) / 4.0) ** 2))
        process = Process(*(float(q) for q in np.exp(logs)))
        return prior - sum(part.solve(process).log_likelihood for part in used)

    start = np.log([1e-4, 1e-3])
    simplex = start + 2 * np.array([[0, 0], [1, 0], [0, 1]])
    options = {"xatol": 0.05, "fatol": 0.05, "maxfev": 80, "initial_simplex": simplex}
    fit = minimize(minus_log_likelihood, start, method="Nelder-Mead", options=options)
    return Process(*(float(q) for q in np.exp(fit.x)))


@dataclass(frozen=True)
class _Solution:
    """State x, y, yaw, twist, shape (n, 6); covariance (n, 6, 6); log marginal likelihood."""

    state: Array
    covariance: Array
    log_likelihood: float


@dataclass(frozen=True)
class _Chain:
    """Times (n,) [s], measured poses (n, 3), yaw unwrapped, and covariances (n, 3, 3) of a segment.

    The covariances include the errors of the times.
    """

    times: Array
    measured: Array
    spread: Array

    @classmethod
    def of(cls, times: Array, measured: Array, spread: Array, stamp_sd: Array) -> "_Chain":
        """Unwrap yaw; add (rate of the pose x `stamp_sd`)² to the covariance `spread`.

        A segment of one pose has no rate, and keeps its covariance.
        """
        unwrapped = measured.copy()
        unwrapped[:, 2] = np.unwrap(measured[:, 2])
        if len(times) > 1:
            rate = np.gradient(unwrapped, times, axis=0)
            along = rate * stamp_sd[:, None]
            spread = spread + np.einsum("ni,nj->nij", along, along)
        return cls(times, unwrapped, spread)

    def head(self, n: int) -> "_Chain":
        """Return the segment's first n poses, or all if it has fewer, as a segment."""
        return _Chain(self.times[:n], self.measured[:n], self.spread[:n])

    def start(self) -> Array:
        """Compute the initial state (n, 6): measured poses, and twists from each to the next.

        The last twist repeats the one before it; that of a single pose is 0.
        """
        state = np.concatenate((self.measured, np.zeros_like(self.measured)), axis=1)
        if len(self.times) > 1:
            dt = np.diff(self.times)[:, None]
            twist = _log_between(self.measured[:-1], self.measured[1:]) / dt
            state[:, 3:] = np.concatenate((twist, twist[-1:]))
        return state

    def solve(self, process: Process) -> _Solution:
        """Fit the states by Gauss-Newton (at most 8 steps), for given noise densities.

        Returns:
            State, its covariance, and log marginal likelihood (Laplace) up to a constant.
        """
        weights = np.linalg.inv(self.spread)
        links, log_links = _link_weights(np.diff(self.times), process)
        state, cost = self.start(), np.inf
        for _ in range(8):
            diagonal, upper, gradient, now = _normal_blocks(self, state, weights, links)
            if abs(cost - now) < 1e-4 * max(1.0, now):
                break
            cost = now
            state = state + _solve_blocks(diagonal, upper, gradient)[0]
        diagonal, upper, gradient, cost = _normal_blocks(self, state, weights, links)
        _, covariance, log_det = _solve_blocks(diagonal, upper, gradient)
        return _Solution(state, covariance, -0.5 * (cost + log_det - log_links))


_TWIST_SD = np.array([1.0, 1.0, 3.0])
"""Prior standard deviation of a segment's first twist, about 0, far above any walking robot's
[m/s, m/s, rad/s]."""


def _link_weights(dt: Array, process: Process) -> tuple[Array, float]:
    """Compute the inverse of cov e (module docstring) for every interval `dt`, shape (n-1,) [s].

    Returns:
        Inverses, shape (n-1, 6, 6), and the sum of the logarithms of their determinants.
    """
    q = np.array([process.travel, process.travel, process.turn])
    time_part = np.linalg.inv(
        np.array([[dt**3 / 3, dt**2 / 2], [dt**2 / 2, dt]]).transpose(2, 0, 1)
    )
    weights = np.einsum("nab,cd->nacbd", time_part, np.diag(1 / q)).reshape(-1, 6, 6)
    return weights, float(np.linalg.slogdet(weights)[1].sum())


def _log_between(a: Array, b: Array) -> Array:
    """Compute log(A^-1 B) of planar poses a, b: the constant twists that lead from a to b in 1 s.

    All of shape (n, 3): x, y, yaw, and forward, left, turn.
    """
    turn = b[:, 2] - a[:, 2]
    c, s = np.cos(a[:, 2]), np.sin(a[:, 2])
    dx, dy = b[:, 0] - a[:, 0], b[:, 1] - a[:, 1]
    forward, left = c * dx + s * dy, -s * dx + c * dy
    half = turn / 2
    # (turn/2) / tan(turn/2), whose limit for no turn is 1 - turn²/12.
    small = np.abs(half) < 1e-4
    cot = np.where(small, 1 - half**2 / 3, half / np.tan(np.where(small, 1.0, half)))
    return np.column_stack((cot * forward + half * left, cot * left - half * forward, turn))


def _link_error(a: Array, b: Array, dt: Array) -> Array:
    travelled = _log_between(a[:, :3], b[:, :3]) - dt[:, None] * a[:, 3:]
    return np.concatenate((travelled, b[:, 3:] - a[:, 3:]), axis=1)


def _normal_blocks(
    chain: _Chain, state: Array, weights: Array, links: Array
) -> tuple[Array, Array, Array, float]:
    """Assemble diagonal blocks (n, 6, 6), blocks above them (n-1, 6, 6), gradient, and cost.

    The gradient (n, 6) is the right-hand side of the step; both hold the first twist's prior.
    """
    n = len(state)
    diagonal, gradient = np.zeros((n, 6, 6)), np.zeros((n, 6))
    missed = chain.measured - state[:, :3]
    diagonal[:, :3, :3] += weights
    gradient[:, :3] += np.einsum("nij,nj->ni", weights, missed)
    cost = float(np.einsum("ni,nij,nj->", missed, weights, missed))
    diagonal[0, 3:, 3:] += np.diag(_TWIST_SD**-2)
    gradient[0, 3:] -= state[0, 3:] / _TWIST_SD**2
    cost += float(np.sum((state[0, 3:] / _TWIST_SD) ** 2))
    a, b, dt = state[:-1], state[1:], np.diff(chain.times)
    error = _link_error(a, b, dt)
    A, B = (_derivative(a, b, dt, side) for side in (0, 1))
    diagonal[:-1] += A.transpose(0, 2, 1) @ links @ A
    diagonal[1:] += B.transpose(0, 2, 1) @ links @ B
    gradient[:-1] -= np.einsum("nji,njk,nk->ni", A, links, error)
    gradient[1:] -= np.einsum("nji,njk,nk->ni", B, links, error)
    cost += float(np.einsum("ni,nij,nj->", error, links, error))
    return diagonal, A.transpose(0, 2, 1) @ links @ B, gradient, cost


def _derivative(a: Array, b: Array, dt: Array, side: int) -> Array:
    """Differentiate `_link_error` numerically by a (side 0) or b (side 1), shape (n, 6, 6)."""
    step, columns = 1e-6, []
    for axis in range(6):
        shift = step * np.eye(6)[axis]
        ends = [(a + s * shift, b) if side == 0 else (a, b + s * shift) for s in (1, -1)]
        columns.append((_link_error(*ends[0], dt) - _link_error(*ends[1], dt)) / (2 * step))
    return np.stack(columns, axis=2)


def _solve_blocks(diagonal: Array, upper: Array, gradient: Array) -> tuple[Array, Array, float]:
    """Solve a symmetric block-tridiagonal system of `diagonal` blocks and those above them.

    Returns solution (n, 6), diagonal blocks of the inverse (n, 6, 6), log det of the matrix.
    """
    n = len(diagonal)
    inverse, carried = np.empty_like(diagonal), gradient.copy()
    log_det = 0.0
    for k in range(n):
        pivot = diagonal[k].copy()
        if k:
            back = upper[k - 1].T @ inverse[k - 1]
            pivot -= back @ upper[k - 1]
            carried[k] -= back @ carried[k - 1]
        inverse[k] = np.linalg.inv(pivot)
        log_det += float(np.linalg.slogdet(pivot)[1])
    solution, covariance = np.empty_like(gradient), np.empty_like(diagonal)
    for k in reversed(range(n)):
        solution[k] = inverse[k] @ carried[k]
        covariance[k] = inverse[k]
        if k < n - 1:
            gain = inverse[k] @ upper[k]
            solution[k] -= gain @ solution[k + 1]
            covariance[k] += gain @ covariance[k + 1] @ gain.T
    return solution, covariance, log_det
