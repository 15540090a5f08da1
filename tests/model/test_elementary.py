# SPDX-License-Identifier: MIT
import numpy as np
import pytest

from model.compiled import compiled
from model.elementary import arctan, arsinh, exp_of, log_of, minus_arctan, sin_cos
from model.lanes import LANES, put, row, size


@compiled
def all_of_them(A):
    """Fill rows of five: x, its sine and cosine, and log and arsinh of its size."""
    for i in range(0, len(A), 5):
        sine, cosine = sin_cos(row(A, i))
        put(A, i + 1, sine)
        put(A, i + 2, cosine)
        put(A, i + 3, log_of(size(row(A, i))))
        put(A, i + 4, arsinh(size(row(A, i))))


def points():
    rng = np.random.default_rng(2)
    sizes = np.concatenate([10 ** rng.uniform(-12, 5, 4000), 1 + rng.uniform(-0.01, 0.01, 1000)])
    quarters = np.pi / 4 * np.arange(1, 1001)
    return np.concatenate([sizes * rng.choice([-1.0, 1.0], 5000), quarters])


@pytest.mark.parametrize("lanes", [1, LANES])
def test_functions_are_numpys_to_rounding(lanes):
    x = points()
    A = np.zeros((5 * len(x) // lanes, lanes))
    A[::5] = x.reshape(-1, lanes)
    all_of_them(A if lanes > 1 else A.ravel())
    found = [A[k::5].ravel() for k in range(1, 5)]
    exact = [np.sin(x), np.cos(x), np.log(np.abs(x)), np.arcsinh(np.abs(x))]
    for each, truth, allowed in zip(found, exact, (0.0, 0.0, 0.0, 5e-16), strict=True):
        np.testing.assert_allclose(each, truth, rtol=max(allowed, 4e-16), atol=2e-16)
    small = np.abs(x) < 0.01
    np.testing.assert_allclose(found[3][small], exact[3][small], rtol=1e-15, atol=0)
    np.testing.assert_allclose(found[0][small], exact[0][small], rtol=1e-15, atol=0)


@compiled
def further_ones(A):
    """Fill rows of four: x, arctan(x), x - arctan(x) and exp(x)."""
    for i in range(0, len(A), 4):
        put(A, i + 1, arctan(row(A, i)))
        put(A, i + 2, minus_arctan(row(A, i)))
        put(A, i + 3, exp_of(row(A, i)))


def values_of_further_ones(x, lanes):
    A = np.zeros((4 * len(x) // lanes, lanes))
    A[::4] = x.reshape(-1, lanes)
    further_ones(A if lanes > 1 else A.ravel())
    return [A[k::4].ravel() for k in range(1, 4)]


@pytest.mark.parametrize("lanes", [1, LANES])
def test_inverse_tangent_and_exponential_are_numpys_to_rounding(lanes):
    x = np.concatenate([points(), 10.0 ** np.arange(0, 16), -(10.0 ** np.arange(0, 16))])
    angle, less, power = values_of_further_ones(x, lanes)
    np.testing.assert_allclose(angle, np.arctan(x), rtol=5e-16, atol=0)
    small = np.abs(x) < 0.2
    series = -sum(
        (-1) ** n * np.where(small, x, 0) ** (2 * n + 1) / (2 * n + 1) for n in range(1, 14)
    )
    np.testing.assert_allclose(less, np.where(small, series, x - np.arctan(x)), rtol=1e-13, atol=0)
    np.testing.assert_allclose(power, np.exp(np.clip(x, -708, 708)), rtol=1e-15, atol=0)


def test_an_infinite_or_undefined_argument_stays_so():
    x = np.array([np.inf, -np.inf, np.nan, 0.0])
    angle, less, _ = values_of_further_ones(x, LANES)
    np.testing.assert_allclose(angle, np.arctan(x), rtol=5e-16)
    np.testing.assert_equal(less, [np.inf, -np.inf, np.nan, 0.0])
