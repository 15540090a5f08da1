# SPDX-License-Identifier: MIT
"""Conflict of prior and data has the distribution that it says, and sees a planted one."""

import numpy as np
import pytest
from scipy import stats

from model.bayes.prior_conflict import prior_shift


def posterior_draws(rng, truth, *, precision, n=4000):
    """Draws of standard normal coordinates after a measurement of the truth, shape (n, m)."""
    m = len(truth)
    measured = rng.multivariate_normal(truth, np.linalg.inv(precision))
    covariance = np.linalg.inv(np.eye(m) + precision)
    return rng.multivariate_normal(covariance @ precision @ measured, covariance, n)


@pytest.mark.parametrize("m", [1, 3])
def test_p_values_are_uniform_where_truth_comes_from_the_prior(m):
    rng = np.random.default_rng(5)
    names = tuple("abc"[:m])
    A = rng.standard_normal((m, m))
    precision = A @ A.T + 0.5 * np.eye(m)
    p = []
    for _ in range(400):
        z = posterior_draws(rng, rng.standard_normal(m), precision=precision, n=500)
        p.append(prior_shift(names, z, z).p)
    assert stats.kstest(p, "uniform").pvalue > 0.01


def test_a_truth_four_standard_deviations_off_is_a_conflict():
    rng = np.random.default_rng(6)
    z = posterior_draws(rng, np.array([4.0]), precision=np.array([[25.0]]))
    found = prior_shift(("friction",), z, z)
    assert found.conflict
    assert found.shift[0] == pytest.approx(4 * 25 / 26, abs=0.3)


def test_nothing_is_said_where_the_data_say_nothing():
    z = np.random.default_rng(7).standard_normal((4000, 1))
    found = prior_shift(("gain",), z, z)
    assert (found.freedom, found.conflict) == (0, None)
    assert np.isnan(found.p)


def test_directions_without_data_do_not_count():
    rng = np.random.default_rng(8)
    z = np.column_stack([rng.normal(0.1, 0.3, 4000), rng.standard_normal(4000)])
    found = prior_shift(("a", "b"), z, z)
    assert found.freedom == 1
    assert found.statistic == pytest.approx(0.1**2 / (1 - 0.09), rel=0.3)


def test_a_prior_far_narrower_than_the_data_conflicts_where_they_say_another_value():
    rng = np.random.default_rng(9)
    wrong = posterior_draws(rng, np.array([120.0]), precision=np.array([[0.01]]))
    right = posterior_draws(rng, np.array([0.5]), precision=np.array([[0.01]]))
    assert prior_shift(("friction",), wrong, wrong).conflict
    assert prior_shift(("friction",), right, right).conflict is None
