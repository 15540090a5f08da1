# SPDX-License-Identifier: MIT
"""Lanes against numpy, and against one lane by itself."""

import numpy as np
import pytest

from model.compiled import compiled
from model.slip.lanes import (
    LANES,
    exponent_and_mantissa,
    nearest,
    power_of_two,
    put,
    row,
    select,
    size,
)


@compiled
def formula(A):
    """Store six results of the first two rows."""
    a, b = row(A, 0), row(A, 1)
    exponent, mantissa = exponent_and_mantissa(a)
    put(A, 2, select(a > b, a * b + 2.0, -size(b) / 2.0))
    put(A, 3, exponent)
    put(A, 4, mantissa)
    put(A, 5, power_of_two(nearest(3.0 * b)))
    put(A, 6, nearest(10.0 * b))
    put(A, 7, 3.0)


def numbers():
    rng = np.random.default_rng(1)
    A = np.zeros((8, LANES))
    A[0], A[1] = 1.1 - 1.5 * (np.arange(LANES) % 2) * 0.5, rng.uniform(0.1, 0.9, LANES)
    return A


def test_every_lane_has_the_result_of_numpy():
    A = numbers()
    formula(A)
    a, b = A[:2]
    np.testing.assert_allclose(A[2], np.where(a > b, a * b + 2, -b / 2), rtol=1e-15)
    np.testing.assert_array_equal(A[4] * 2.0 ** A[3], a)
    assert np.all((A[4] >= np.sqrt(0.5) - 1e-6) & (A[4] < np.sqrt(2.0)))
    np.testing.assert_array_equal(A[5], 2.0 ** np.rint(3 * b))
    np.testing.assert_array_equal(A[6], np.rint(10 * b))
    np.testing.assert_array_equal(A[7], 3.0)


@pytest.mark.parametrize("lane", range(LANES))
def test_a_float_alone_is_its_lane(lane):
    A = numbers()
    alone = np.ascontiguousarray(A[:, lane])
    formula(A)
    formula(alone)
    np.testing.assert_allclose(alone, A[:, lane], rtol=1e-15)
