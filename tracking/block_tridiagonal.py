# SPDX-License-Identifier: MIT
"""Symmetric block-tridiagonal matrices: Cholesky factor, solutions, blocks of the inverse."""

from typing import NamedTuple

import numpy as np
from scipy.linalg import cho_solve_banded, cholesky_banded

from model.arrays import Array


class Factors(NamedTuple):
    """Cholesky factor of a symmetric block-tridiagonal matrix.

    Attributes:
        banded: The factor in LAPACK's upper banded storage, shape (2 b, n b).
        diagonal: Blocks on the matrix's diagonal, shape (n, b, b).
        upper: Blocks above it, shape (n - 1, b, b).
    """

    banded: Array
    diagonal: Array
    upper: Array

    @property
    def log_det(self) -> float:
        """Logarithm of the matrix's determinant."""
        return 2 * float(np.log(self.banded[-1]).sum())


def factorised(diagonal: Array, upper: Array) -> Factors:
    """Factorise a symmetric positive definite matrix.

    Args:
        diagonal: Blocks on its diagonal, shape (n, b, b).
        upper: Blocks above them, shape (n - 1, b, b).

    Raises:
        LinAlgError: The matrix is not positive definite.
    """
    n, b, _ = diagonal.shape
    banded = np.zeros((2 * b, n, b))
    for i in range(b):
        for j in range(b):
            # LAPACK: the element of row r and column c is at row 2 b - 1 + r - c of column c.
            if i <= j:
                banded[2 * b - 1 + i - j, :, j] = diagonal[:, i, j]
            banded[b - 1 + i - j, 1:, j] = upper[:, i, j]
    factor = cholesky_banded(banded.reshape(2 * b, n * b), overwrite_ab=True, check_finite=False)
    return Factors(factor, diagonal, upper)


def solve_blocks(factors: Factors, sides: Array) -> Array:
    """Solve M x = `sides` with a factorised matrix M; both of shape (n, b, k)."""
    n, b, k = sides.shape
    flat = sides.reshape(n * b, k)
    return cho_solve_banded((factors.banded, False), flat, check_finite=False).reshape(n, b, k)


def inverse_blocks(factors: Factors) -> tuple[Array, Array]:
    """Compute the blocks of the inverse on the diagonal (n, b, b), and above it (n - 1, b, b)."""
    _, diagonal, upper = factors
    covariance, following = np.empty_like(diagonal), np.empty_like(upper)
    for k, block in enumerate(diagonal):  # forward elimination: inverses of the pivots
        pivot = block if k == 0 else block - upper[k - 1].T @ covariance[k - 1] @ upper[k - 1]
        covariance[k] = np.linalg.inv(pivot)
    for k in reversed(range(len(upper))):  # back substitution, as in a Rauch-Tung-Striebel smoother
        gain = covariance[k] @ upper[k]
        following[k] = -gain @ covariance[k + 1]
        covariance[k] -= following[k] @ gain.T
    return covariance, following
