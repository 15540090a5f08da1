# SPDX-License-Identifier: MIT
r"""Likelihood of tracked walks with steering and stride integrated out exactly.

Steering bends a path and stride stretches it, so residuals are linear in the two. In standard
normal coordinates y, steering and stride are integrated out, and need not be drawn:

.. math::
    r = r_0 + D y, \quad y \sim N(0, I): \qquad
    \log p(r_0) = -\tfrac12 (r_0^T r_0 - b^T A^{-1} b) - \tfrac12 \log |A| ,

with :math:`A = I + D^T D` and :math:`b = D^T r_0`. Each walk adds its part, so that any of them can
be left out afterwards.
"""

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np

from model.arrays import Array


@dataclass(frozen=True)
class Terms:
    """Quadratic form of the residuals of walks in steering and stride, for m draws of all else.

    Axes of length 2 are steering, then stride, in units of their prior standard deviations.

    r_0 are the whitened residuals without steering and stride, D their derivatives by the two.

    Attributes:
        square: :math:`r_0^T r_0` of each walk, shape (m, walks).
        slope: :math:`D^T r_0`, shape (m, walks, 2).
        curvature: :math:`D^T D`, shape (m, walks, 2, 2).
    """

    square: Array
    slope: Array
    curvature: Array

    @classmethod
    def of(cls, residuals: Array, bends: Array) -> "Terms":
        """Compute the terms of one walk.

        Args:
            residuals: Whitened residuals without steering and stride, r_0, shape (m, k).
            bends: Derivatives D of the residuals by steering and stride, in units of their prior
                standard deviations, shape (m, k, 2).
        """
        transposed = np.swapaxes(bends, 1, 2)
        return cls(
            (residuals**2).sum(axis=1)[:, None],
            (transposed @ residuals[..., None])[:, None, :, 0],
            (transposed @ bends)[:, None],
        )

    @classmethod
    def concat_walks(cls, walks: Sequence["Terms"]) -> "Terms":
        """Concatenate the terms of several walks at the same draws."""
        return cls(*(np.concatenate(part, axis=1) for part in _parts(walks)))

    @classmethod
    def concat_draws(cls, rounds: Sequence["Terms"]) -> "Terms":
        """Concatenate the terms of the same walks at several sets of draws."""
        return cls(*(np.concatenate(part, axis=0) for part in _parts(rounds)))

    def only(self, walks: Sequence[int]) -> "Terms":
        """Return the terms of the walks with the given indices, in their order."""
        keep = list(walks)
        return Terms(self.square[:, keep], self.slope[:, keep], self.curvature[:, keep])

    def log_likelihood(self) -> Array:
        """Compute the log likelihood of all walks at each draw, up to a constant, shape (m,).

        Steering and stride are integrated out.
        """
        A = np.eye(2) + self.curvature.sum(axis=1)
        b = self.slope.sum(axis=1)
        explained = (b * np.linalg.solve(A, b[..., None])[..., 0]).sum(axis=1)
        return -0.5 * (self.square.sum(axis=1) - explained) - 0.5 * np.linalg.slogdet(A)[1]

    def conditional(self) -> tuple[Array, Array]:
        """Compute mean (m, 2) and covariance (m, 2, 2) of steering and stride given each draw.

        They are in units of the prior standard deviations, given all walks of these terms.
        """
        covariance = np.linalg.inv(np.eye(2) + self.curvature.sum(axis=1))
        return -(covariance @ self.slope.sum(axis=1)[..., None])[..., 0], covariance

    def squares_at(self, y: Array) -> Array:
        """Compute each walk's sum of squared whitened residuals at given steering and stride [-].

        It is :math:`|r_0 + D y|^2`, not integrated, shape (m, walks).

        Args:
            y: Steering and stride of each draw, in units of their prior standard deviations, shape
                (m, 2).
        """
        linear = (self.slope * y[:, None]).sum(axis=2)
        return self.square + 2 * linear + np.einsum("mi,mwij,mj->mw", y, self.curvature, y)


def _parts(terms: Sequence[Terms]) -> tuple[list[Array], list[Array], list[Array]]:
    """Return lists of the terms' squares, slopes and curvatures."""
    return (
        [each.square for each in terms],
        [each.slope for each in terms],
        [each.curvature for each in terms],
    )
