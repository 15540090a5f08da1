# SPDX-License-Identifier: MIT
"""Least squares of the states of a walk's segments and of the errors that its poses share.

Errors that the measurements share (camera, lens, height) are unknowns as well. With u these errors,
independent and of variance 1, a measured pose m is the true pose minus F u plus noise of its own.
The normal equations of all are an arrow: block tridiagonal for the poses and twists, with a border
for u, which is eliminated last.
"""

from dataclasses import dataclass
from typing import NamedTuple

import numpy as np

from model.arrays import Array
from tracking.block_tridiagonal import Factors, factorised, inverse_blocks, solve_blocks
from tracking.constant_twist import (
    Process,
    link_derivatives,
    link_error,
    link_weights,
    log_between,
)

_TWIST_SD = np.array([1.0, 1.0, 3.0])
"""Prior standard deviation of a segment's first twist, about 0, far above any walking robot's
[m/s, m/s, rad/s]."""


@dataclass(frozen=True)
class SharedInput:
    """Errors that measured poses share, as independent unknowns u of mean 0 and variance 1.

    Attributes:
        by_error: Derivative F of each measured pose by u, shape (n, 3, r): the true pose is the
            measured one plus F u plus noise.
        information: Information on u that is not in the measured poses, shape (r, r).
        gradient: Gradient of minus its log likelihood at u = 0, shape (r,).
    """

    by_error: Array
    information: Array
    gradient: Array

    @classmethod
    def none(cls, n: int) -> "SharedInput":
        """Return the input of n poses that share no errors, r = 0."""
        return cls(np.zeros((n, 3, 0)), np.zeros((0, 0)), np.zeros(0))

    @property
    def size(self) -> int:
        """Number r of shared errors."""
        return len(self.gradient)


@dataclass(frozen=True)
class Chain:
    """Times (n,) [s], measured poses (n, 3), yaw unwrapped, and covariances (n, 3, 3) of a segment.

    The covariances include the errors of the times; `by_error` (n, 3, r) are the poses' derivatives
    by the shared errors.
    """

    times: Array
    measured: Array
    spread: Array
    by_error: Array

    @classmethod
    def of(
        cls, times: Array, measured: Array, spread: Array, stamp_sd: Array, by_error: Array
    ) -> "Chain":
        """Unwrap yaw; add (rate of the pose x `stamp_sd`)² to the covariance `spread`.

        A segment of one pose has no rate, and keeps its covariance.
        """
        unwrapped = measured.copy()
        unwrapped[:, 2] = np.unwrap(measured[:, 2])
        if len(times) > 1:
            rate = np.gradient(unwrapped, times, axis=0)
            along = rate * stamp_sd[:, None]
            spread = spread + np.einsum("ni,nj->nij", along, along)
        return cls(times, unwrapped, spread, by_error)

    def head(self, n: int) -> "Chain":
        """Return the segment's first n poses, or all if it has fewer, as a segment."""
        return Chain(self.times[:n], self.measured[:n], self.spread[:n], self.by_error[:n])

    def corrected(self, errors: Array) -> Array:
        """Return the measured poses with the shared errors (r,) added, shape (n, 3)."""
        return self.measured + self.by_error @ errors

    def start(self) -> Array:
        """Compute the initial state (n, 6): measured poses, and twists from each to the next.

        The last twist repeats the one before it; that of a single pose is 0.
        """
        state = np.concatenate((self.measured, np.zeros_like(self.measured)), axis=1)
        if len(self.times) > 1:
            dt = np.diff(self.times)[:, None]
            twist = log_between(self.measured[:-1], self.measured[1:]) / dt
            state[:, 3:] = np.concatenate((twist, twist[-1:]))
        return state


@dataclass(frozen=True)
class Solution:
    """Fitted states and shared errors u, with covariances; lists have one entry for each segment.

    Attributes:
        states: Poses and twists, shape (n, 6).
        covariances: Covariance of each state if u were known, shape (n, 6, 6).
        following: The same between each state and the next, shape (n - 1, 6, 6).
        factors: Cholesky factors of the states' normal equations, to solve them again.
        shared: Estimate of u, shape (r,).
        shared_covariance: Covariance of u, shape (r, r).
        log_likelihood: Log marginal likelihood (Laplace) of the measured poses, up to a constant.
    """

    states: list[Array]
    covariances: list[Array]
    following: list[Array]
    factors: list[Factors]
    shared: Array
    shared_covariance: Array
    log_likelihood: float


class _Point(NamedTuple):
    """Unknowns: states by segment (n, 6), and shared errors (r,)."""

    states: list[Array]
    errors: Array


class _Step(NamedTuple):
    """A Gauss-Newton step of states (n, 6), by segment, and shared errors (r,).

    `normal` (r, r) is the information on the errors with the states eliminated, `factors` those of
    the states' normal equations by segment, and `cost` the cost before the step.
    """

    states: list[Array]
    errors: Array
    normal: Array
    factors: list[Factors]
    cost: float


class _Fitted(NamedTuple):
    """Unknowns of least cost, the last step there, and the log marginal likelihood (Laplace)."""

    point: _Point
    step: _Step
    log_likelihood: float


@dataclass(frozen=True)
class ChainProblem:
    """Least-squares problem: segments of a walk, and what is `known` of the errors they share."""

    parts: list[Chain]
    known: SharedInput

    def start(self) -> _Point:
        """Return where to start from: the measured poses, and no shared errors."""
        return _Point([part.start() for part in self.parts], np.zeros(self.known.size))

    def fit(self, process: Process, start: _Point) -> _Fitted:
        """Fit states and shared errors by Gauss-Newton, at most 8 steps, for given noise densities.

        It ends when a step changes the cost by less than 1e-4 of it, or than 1e-4 if it is below 1.
        """
        weights = [np.linalg.inv(part.spread) for part in self.parts]
        links = [link_weights(np.diff(part.times), process) for part in self.parts]
        point, step, cost = start, self._step(start, weights, links), np.inf
        for _ in range(8):
            if abs(cost - step.cost) < 1e-4 * max(1.0, step.cost):
                break
            cost = step.cost
            states: list[Array] = [
                state + each for state, each in zip(point.states, step.states, strict=True)
            ]
            point = _Point(states, point.errors + step.errors)
            step = self._step(point, weights, links)
        log_det = sum(factors.log_det for factors in step.factors)
        log_det += float(np.linalg.slogdet(step.normal)[1]) if self.known.size else 0.0
        log_links = sum(log for _, log in links)
        return _Fitted(point, step, -0.5 * (step.cost + log_det - log_links))

    def solve(self, process: Process) -> Solution:
        """Fit states and shared errors for given densities, with their covariances."""
        point, step, log_likelihood = self.fit(process, self.start())
        pairs = [inverse_blocks(factors) for factors in step.factors]
        return Solution(
            point.states, [own for own, _ in pairs], [cross for _, cross in pairs], step.factors,
            point.errors, np.linalg.inv(step.normal), log_likelihood,
        )  # fmt: skip

    def gain(self, solved: Solution, by_error: Array) -> Array:
        """Compute how the smoothed poses move with errors that move the measured poses.

        Args:
            solved: The solution; u is held.
            by_error: Derivative of the measured poses of all segments, shape (n, 3, q).

        Returns:
            Derivative of the smoothed poses, shape (n, 3, q).
        """
        start, moved = 0, []
        for part, factors in zip(self.parts, solved.factors, strict=True):
            own = by_error[start : start + len(part.times)]
            start += len(part.times)
            pull = np.zeros((len(own), 6, by_error.shape[2]))
            pull[:, :3] = np.linalg.inv(part.spread) @ own
            moved.append(solve_blocks(factors, pull)[:, :3])
        return np.concatenate(moved)

    def _step(self, point: _Point, weights: list[Array], links: list[tuple[Array, float]]) -> _Step:
        """Compute the Gauss-Newton step of states and shared errors at a point.

        The states of each segment are eliminated from the arrow of normal equations. What is left,
        the Schur complement, is solved for the shared errors, and they give the states.
        """
        known, (states, errors) = self.known, point
        pull = known.information @ errors
        normal = np.eye(known.size) + known.information
        gradient = -(errors + pull + known.gradient)
        cost = float(errors @ errors + errors @ pull + 2 * errors @ known.gradient)
        found, all_factors = [], []
        for part, state, weight, (link, _) in zip(self.parts, states, weights, links, strict=True):
            missed = part.corrected(errors) - state[:, :3]
            diagonal, upper, rise, own = _normal_blocks(part, state, missed, weight, link)
            border = np.zeros((len(state), 6, known.size))
            border[:, :3] = -weight @ part.by_error
            factors = factorised(diagonal, upper)
            solution = solve_blocks(factors, np.concatenate((rise[:, :, None], border), axis=2))
            by_error = part.by_error
            normal += np.einsum("nai,nab,nbj->ij", by_error, weight, by_error)
            normal -= np.einsum("nai,naj->ij", border, solution[:, :, 1:])
            gradient -= np.einsum("nai,nab,nb->i", by_error, weight, missed)
            gradient -= np.einsum("nai,na->i", border, solution[:, :, 0])
            cost += own
            found.append(solution)
            all_factors.append(factors)
        step = np.linalg.solve(normal, gradient)
        moved = [solution[:, :, 0] - solution[:, :, 1:] @ step for solution in found]
        return _Step(moved, step, normal, all_factors, cost)


def _normal_blocks(
    chain: Chain, state: Array, missed: Array, weights: Array, links: Array
) -> tuple[Array, Array, Array, float]:
    """Assemble diagonal blocks (n, 6, 6), blocks above them (n-1, 6, 6), gradient, and cost.

    The gradient (n, 6) is the right-hand side of the step; all but the blocks above the diagonal
    include the first twist's prior. `missed` (n, 3) are the measured poses, shared errors added,
    less those of `state`; `weights` (n, 3, 3) and `links` (n - 1, 6, 6) are the inverse covariances
    of `missed` and of `link_error`.
    """
    n = len(state)
    diagonal, gradient = np.zeros((n, 6, 6)), np.zeros((n, 6))
    diagonal[:, :3, :3] += weights
    gradient[:, :3] += np.einsum("nij,nj->ni", weights, missed)
    cost = float(np.einsum("ni,nij,nj->", missed, weights, missed))
    diagonal[0, 3:, 3:] += np.diag(_TWIST_SD**-2)
    gradient[0, 3:] -= state[0, 3:] / _TWIST_SD**2
    cost += float(np.sum((state[0, 3:] / _TWIST_SD) ** 2))
    a, b, dt = state[:-1], state[1:], np.diff(chain.times)
    error = link_error(a, b, dt)
    A, B = link_derivatives(a, b, dt)
    diagonal[:-1] += A.transpose(0, 2, 1) @ links @ A
    diagonal[1:] += B.transpose(0, 2, 1) @ links @ B
    gradient[:-1] -= np.einsum("nji,njk,nk->ni", A, links, error)
    gradient[1:] -= np.einsum("nji,njk,nk->ni", B, links, error)
    cost += float(np.einsum("ni,nij,nj->", error, links, error))
    return diagonal, A.transpose(0, 2, 1) @ links @ B, gradient, cost
