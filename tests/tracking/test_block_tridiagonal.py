# SPDX-License-Identifier: MIT
"""Factor, solution and blocks of the inverse are those of the dense matrix."""

import numpy as np
import pytest

from tracking.block_tridiagonal import factorised, inverse_blocks, solve_blocks


def dense(diagonal, upper):
    n, b, _ = diagonal.shape
    whole = np.zeros((n, b, n, b))
    for k in range(n):
        whole[k, :, k] = diagonal[k]
    for k in range(n - 1):
        whole[k, :, k + 1], whole[k + 1, :, k] = upper[k], upper[k].T
    return whole.reshape(n * b, n * b)


@pytest.mark.parametrize("n", [1, 2, 7])
def test_it_is_the_dense_matrix(n):
    rng, b = np.random.default_rng(n), 3
    roots = rng.normal(size=(n, b, b))
    diagonal = roots @ roots.transpose(0, 2, 1) + 12 * np.eye(b)
    upper = rng.normal(size=(n - 1, b, b))
    whole, sides = dense(diagonal, upper), rng.normal(size=(n, b, 2))
    factors = factorised(diagonal, upper)
    assert factors.log_det == pytest.approx(np.linalg.slogdet(whole)[1])
    solved = solve_blocks(factors, sides).reshape(n * b, 2)
    np.testing.assert_allclose(solved, np.linalg.solve(whole, sides.reshape(n * b, 2)))
    inverse = np.linalg.inv(whole).reshape(n, b, n, b)
    own, following = inverse_blocks(factors)
    for k in range(n):
        np.testing.assert_allclose(own[k], inverse[k, :, k], atol=1e-12)
    for k in range(n - 1):
        np.testing.assert_allclose(following[k], inverse[k, :, k + 1], atol=1e-12)


def test_an_indefinite_matrix_is_refused():
    with pytest.raises(np.linalg.LinAlgError):
        factorised(-np.ones((1, 1, 1)), np.zeros((0, 1, 1)))
