# SPDX-License-Identifier: MIT
import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st
from scipy.stats import norm

from model.errors import InsufficientData
from model.metrics.difference import difference


def normal(mean, sd, seed, n=3000):
    return np.random.default_rng(seed).normal(mean, sd, n)


def test_the_probability_is_that_of_two_gaussians():
    found = difference(normal(0, 1, 1), normal(1, 2, 2), rng=np.random.default_rng(3))
    assert found.probability == pytest.approx(norm.cdf(1 / np.sqrt(5)), abs=0.02)
    assert found.median == pytest.approx(1.0, abs=0.15)
    assert found.high - found.low == pytest.approx(2 * 1.645 * np.sqrt(5), rel=0.05)
    assert not found.clear


@given(shift=st.floats(-3, 3))
def test_the_other_way_round_is_the_other_sign(shift):
    a, b = normal(0, 1, 1, 200), normal(shift, 1, 2, 200)
    one = difference(a, b, rng=np.random.default_rng(1))
    other = difference(b, a, rng=np.random.default_rng(1))
    assert one.probability == pytest.approx(1 - other.probability)
    assert one.median == pytest.approx(-other.median, abs=0.3)


def test_the_same_number_is_larger_than_itself_half_of_the_time():
    same = np.full(5, 2.0)
    found = difference(same, same, rng=np.random.default_rng(1))
    assert (found.probability, found.median, found.clear) == (0.5, 0.0, False)


def test_far_apart_is_clear():
    assert difference(normal(0, 1, 1), normal(9, 1, 2), rng=np.random.default_rng(1)).clear


def test_no_draws_and_no_numbers_are_refused():
    rng = np.random.default_rng(1)
    with pytest.raises(InsufficientData, match="has no draws"):
        difference(np.empty(0), np.ones(2), rng=rng)
    with pytest.raises(InsufficientData, match="finite"):
        difference(np.array([np.nan]), np.ones(2), rng=rng)
