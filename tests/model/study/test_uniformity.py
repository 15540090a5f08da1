# SPDX-License-Identifier: MIT
"""Uniform ranks stay inside the simultaneous band as often as it says, and others leave it."""

import numpy as np
import pytest
from scipy.stats import binom, kstest

from model.study.uniformity import (
    BINS,
    DRAWS,
    chi_square_p,
    cumulative,
    ecdf_p,
    histogram,
    simultaneous_band,
)


def test_the_band_is_left_as_often_as_stated():
    band = simultaneous_band(80, 0.1)
    rng = np.random.default_rng(1)
    left = 0
    for _ in range(4000):
        counts = cumulative(rng.integers(0, DRAWS + 1, 80))
        left += bool(np.any((counts < band.low) | (counts > band.high)))
    assert binom.ppf(0.001, 4000, 0.08) <= left <= binom.ppf(0.999, 4000, 0.1)


def test_p_values_of_uniform_ranks_are_uniform():
    rng = np.random.default_rng(2)
    p = [ecdf_p(rng.integers(0, DRAWS + 1, 60)) for _ in range(60)]
    assert kstest(p, "uniform").pvalue > 0.001


def test_ranks_at_the_edge_of_the_band_have_its_level():
    band = simultaneous_band(50, 0.05)
    rng = np.random.default_rng(3)
    for _ in range(15):
        ranks = np.minimum(rng.integers(0, 130, 50), DRAWS)
        counts = cumulative(ranks)
        outside = bool(np.any((counts < band.low) | (counts > band.high)))
        assert outside == (ecdf_p(ranks) <= 0.05)


@pytest.mark.parametrize("p", [chi_square_p, ecdf_p])
def test_ranks_that_pile_up_are_found(p):
    ends = np.repeat([0, 1, 98, 99], 50)
    assert p(ends) < 1e-9
    assert p(np.arange(DRAWS + 1)) > 0.9


def test_the_histogram_counts_every_rank_once():
    counts = histogram(np.arange(DRAWS + 1))
    assert counts.tolist() == [5] * BINS
