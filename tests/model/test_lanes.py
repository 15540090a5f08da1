# SPDX-License-Identifier: MIT
"""Lanes against numpy, and against one lane by itself."""

import numpy as np
import pytest

from model.compiled import compiled
from model.lanes import (
    LANES,
    any_of,
    exponent_and_mantissa,
    floor,
    gathered,
    nearest,
    negated,
    put,
    root,
    row,
    select,
    size,
)


@compiled
def formula(A, table):
    """Store eight results of the first two rows; return whether any a is not above its b."""
    a, b = row(A, 0), row(A, 1)
    above = (a > b) & (a >= 0.5) | (a == b) ^ (a == b)
    exponent, mantissa = exponent_and_mantissa(a)
    first, second = gathered(table, floor(3.0 * b), 2)
    put(A, 2, select(above, a * b + 2.0, -root(size(b) / 2.0)))
    put(A, 3, exponent)
    put(A, 4, mantissa)
    put(A, 5, first - second)
    put(A, 6, nearest(10.0 * b))
    put(A, 7, 3.0)
    return any_of(negated(a > b))


def numbers():
    rng = np.random.default_rng(1)
    A = np.zeros((8, LANES))
    A[0], A[1] = 1.1 - 1.5 * (np.arange(LANES) % 2) * 0.5, rng.uniform(0.1, 0.9, LANES)
    return A, rng.uniform(size=(LANES, 6))


def test_every_lane_has_the_result_of_numpy():
    A, table = numbers()
    some = formula(A, table)
    a, b = A[:2]
    above, at = (a > b) & (a >= 0.5), np.floor(3 * b).astype(int)
    np.testing.assert_allclose(A[2], np.where(above, a * b + 2, -np.sqrt(b / 2)), rtol=1e-15)
    np.testing.assert_array_equal(A[4] * 2.0 ** A[3], a)
    assert np.all((A[4] >= np.sqrt(0.5) - 1e-6) & (A[4] < np.sqrt(2.0)))
    lane = np.arange(LANES)
    np.testing.assert_array_equal(A[5], table[lane, at] - table[lane, at + 1])
    np.testing.assert_array_equal(A[6], np.rint(10 * b))
    np.testing.assert_array_equal(A[7], 3.0)
    assert some == bool(np.any(~(a > b)))


@pytest.mark.parametrize("lane", range(LANES))
def test_one_walk_alone_is_its_lane(lane):
    A, table = numbers()
    alone, own = np.ascontiguousarray(A[:, lane]), table[lane : lane + 1].copy()
    formula(A, table)
    formula(alone, own)
    np.testing.assert_allclose(alone, A[:, lane], rtol=1e-15)
