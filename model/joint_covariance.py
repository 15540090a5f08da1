# SPDX-License-Identifier: MIT
"""Joint covariance of the poses of a track: errors of their own, and errors that all share."""

from dataclasses import dataclass
from functools import cached_property
from itertools import pairwise

import numpy as np
from numpy.typing import ArrayLike, NDArray

from model.arrays import Array
from model.errors import DomainError


@dataclass(frozen=True)
class JointCovariance:
    r"""Covariance of x, y and yaw of all poses of a track with each other.

    The error of pose k is the first three components of :math:`d_k`, the error of pose and twist
    that is its own, plus :math:`B_k c`, with c the errors that all poses share (camera, floor,
    height). The own errors are a Markov chain along the track:

    .. math::
        \mathrm{cov}(d_k, d_{k+1}) = F_k, \qquad
        \mathrm{cov}(d_k, d_{k+2}) = F_k C_{k+1}^{-1} F_{k+1}, \ldots

    Attributes:
        own: C, covariance of d of each pose, shape (n, b, b), b at least 3.
        following: F, covariance of d of each pose with the next, shape (n - 1, b, b); zero where
            the path is interrupted.
        by_error: B, derivative of x, y and yaw by the shared errors, shape (n, 3, q).
        errors: Covariance of the shared errors c, shape (q, q).

    Raises:
        DomainError: Shapes do not match.
    """

    own: Array
    following: Array
    by_error: Array
    errors: Array

    def __post_init__(self) -> None:
        """Check that shapes match."""
        n, q = len(self.own), len(self.errors)
        b = self.own.shape[-1]
        expected = ((n, b, b), (max(n - 1, 0), b, b), (n, 3, q), (q, q))
        found = tuple(a.shape for a in (self.own, self.following, self.by_error, self.errors))
        if found != expected or b < 3:
            raise DomainError(
                f"a joint covariance has parts of shape {found}; expected {expected}, b at least 3"
            )

    @classmethod
    def independent(cls, covariance: Array) -> "JointCovariance":
        """Build the joint covariance of poses whose errors are independent of each other's.

        There are no shared errors, q = 0, and the covariance of successive poses is zero.

        Args:
            covariance: Covariance of x, y and yaw of each pose, shape (n, 3, 3).
        """
        n = len(covariance)
        none = np.zeros((max(n - 1, 0), 3, 3))
        return cls(covariance, none, np.zeros((n, 3, 0)), np.zeros((0, 0)))

    def __len__(self) -> int:
        """Return the number of poses."""
        return len(self.own)

    @property
    def marginal(self) -> Array:
        """Covariance of x, y and yaw of each pose, shape (n, 3, 3)."""
        return self.own[:, :3, :3] + self.by_error @ self.errors @ self.by_error.transpose(0, 2, 1)

    @property
    def dense(self) -> Array:
        """Covariance of x, y and yaw of all poses, one pose after the other, shape (3n, 3n)."""
        n = len(self)
        by_error = self.by_error.reshape(3 * n, len(self.errors))
        whole = (by_error @ self.errors @ by_error.T).reshape(n, 3, n, 3)
        across = self.own  # of each pose with the one `lag` poses later
        for lag in range(n):
            across = self.own if lag == 0 else across[:-1] @ self._onward[lag - 1 :]
            a = np.arange(n - lag)
            whole[a, :, a + lag] += across[:, :3, :3]
            if lag:
                whole[a + lag, :, a] += across[:, :3, :3].transpose(0, 2, 1)
        return whole.reshape(3 * n, 3 * n)

    @cached_property
    def _onward(self) -> Array:
        """C_k^-1 F_k: regression of the next d, transposed, on that of each pose."""
        return np.linalg.pinv(self.own[:-1], hermitian=True) @ self.following

    def part(self, keep: slice | NDArray[np.bool_] | NDArray[np.intp]) -> "JointCovariance":
        """Select poses.

        Args:
            keep: Slice, boolean mask (n,) or indices in increasing order.
        """
        rows = np.arange(len(self))[keep]
        following = np.zeros((max(len(rows) - 1, 0), *self.own.shape[1:]))
        for k, (a, b) in enumerate(pairwise(rows)):
            across = self.own[a]
            for between in range(a, b):
                across = across @ self._onward[between]
            following[k] = across
        return JointCovariance(self.own[rows], following, self.by_error[rows], self.errors)

    def also(self, by_error: ArrayLike, variance: float) -> "JointCovariance":
        """Add one more error that all poses share, independent of the others.

        Args:
            by_error: Derivative of x, y and yaw of each pose by the new error, shape (n, 3).
            variance: Variance of the new error.
        """
        q = len(self.errors)
        errors = np.zeros((q + 1, q + 1))
        errors[:q, :q], errors[q, q] = self.errors, variance
        column = np.asarray(by_error, dtype=float)[:, :, None]
        by_all = np.concatenate((self.by_error, column), axis=2)
        return JointCovariance(self.own, self.following, by_all, errors)

    def draw(self, count: int, *, rng: np.random.Generator) -> Array:
        """Draw errors of x, y and yaw of all poses, shape (count, n, 3) [m, m, rad].

        Args:
            count: Number of draws.
            rng: Source of randomness.
        """
        n, b = len(self), self.own.shape[-1]
        own = np.empty((count, n, b))
        for k in range(n):
            spread, mean = self.own[k], 0.0
            if k:
                onward = self._onward[k - 1]
                spread = spread - self.following[k - 1].T @ onward
                mean = own[:, k - 1] @ onward
            own[:, k] = mean + rng.standard_normal((count, b)) @ _root(spread).T
        shared = rng.standard_normal((count, len(self.errors))) @ _root(self.errors).T
        return own[:, :, :3] + np.einsum("nip,mp->mni", self.by_error, shared)


def _root(covariance: Array) -> Array:
    """Compute a matrix root A, A A^T = `covariance`, which may be singular, by eigenvalues.

    The matrix is first scaled to unit diagonal, since its units differ; eigenvalues that rounding
    made negative count as zero.
    """
    sd = np.sqrt(np.maximum(np.diag(covariance), 0.0))
    unit = np.where(sd > 0, sd, 1.0)
    values, vectors = np.linalg.eigh(covariance / np.outer(unit, unit))
    return unit[:, None] * vectors * np.sqrt(np.maximum(values, 0.0))
