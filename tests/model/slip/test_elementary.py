# SPDX-License-Identifier: MIT
import numpy as np
import pytest

from model.compiled import compiled
from model.slip.elementary import arctan, exp_of, log_of, minus_arctan, sin_half_turn
from model.slip.lanes import LANES, put, row, size


def points():
    rng = np.random.default_rng(2)
    sizes = np.concatenate([10 ** rng.uniform(-12, 5, 4000), 1 + rng.uniform(-0.01, 0.01, 1000)])
    quarters = np.pi / 4 * np.arange(1, 1001)
    return np.concatenate([sizes * rng.choice([-1.0, 1.0], 5000), quarters])


@compiled
def functions(A):
    """Fill rows of six: x, arctan(x), x - arctan(x), exp(x), log |x| and the sine of arctan(x)."""
    for i in range(0, len(A), 6):
        put(A, i + 1, arctan(row(A, i)))
        put(A, i + 2, minus_arctan(row(A, i)))
        put(A, i + 3, exp_of(row(A, i)))
        put(A, i + 4, log_of(size(row(A, i))))
        put(A, i + 5, sin_half_turn(2.0 * arctan(row(A, i))))


def values_of_functions(x, lanes):
    A = np.zeros((6 * len(x) // lanes, lanes))
    A[::6] = x.reshape(-1, lanes)
    functions(A if lanes > 1 else A.ravel())
    return [A[k::6].ravel() for k in range(1, 6)]


@pytest.mark.parametrize("lanes", [1, LANES])
def test_functions_are_numpys_to_rounding(lanes):
    x = np.concatenate([points(), 10.0 ** np.arange(0, 16), -(10.0 ** np.arange(0, 16))])
    angle, less, power, logarithm, sine = values_of_functions(x, lanes)
    np.testing.assert_allclose(angle, np.arctan(x), rtol=5e-16, atol=0)
    small = np.abs(x) < 0.2
    series = -sum(
        (-1) ** n * np.where(small, x, 0) ** (2 * n + 1) / (2 * n + 1) for n in range(1, 14)
    )
    np.testing.assert_allclose(less, np.where(small, series, x - np.arctan(x)), rtol=1e-13, atol=0)
    np.testing.assert_allclose(power, np.exp(np.clip(x, -708, 708)), rtol=1e-15, atol=0)
    np.testing.assert_allclose(logarithm, np.log(np.abs(x)), rtol=4e-16, atol=2e-16)
    np.testing.assert_allclose(sine, np.sin(2 * np.arctan(x)), rtol=4e-16, atol=4e-16)


def test_an_infinite_or_undefined_argument_stays_so():
    x = np.array([np.inf, -np.inf, np.nan, 0.0])
    angle, less, *_ = values_of_functions(x, LANES)
    np.testing.assert_allclose(angle, np.arctan(x), rtol=5e-16)
    np.testing.assert_equal(less, [np.inf, -np.inf, np.nan, 0.0])
