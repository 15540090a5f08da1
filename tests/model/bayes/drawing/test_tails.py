# SPDX-License-Identifier: MIT
"""Where a density falls more slowly than the Gaussian at its mode, a further Gaussian is found."""

import numpy as np
import pytest
from scipy import stats

from model.bayes.drawing.laplace import find_mode
from model.bayes.drawing.tails import FALLEN, approximate, find_tails

START = np.array([[0.1, 0.1, 0.1]])


def gaussian(z):
    """A correlated Gaussian narrower than the prior."""
    covariance = np.array([[0.3, 0.2, 0.0], [0.2, 0.3, 0.1], [0.0, 0.1, 0.4]])
    return np.reshape(stats.multivariate_normal([0, 0.5, -0.5], covariance).logpdf(z), len(z))


def flat_below(z):
    """Data that bound the last coordinate above: its tail below is as wide as the prior."""
    likelihood = -0.5 * (np.logaddexp(0, 10 * z[:, 2]) / 2) ** 2
    return likelihood - 0.5 * z[:, 2] ** 2 - 8 * (z[:, :2] ** 2).sum(axis=1)


def curved_ridge(z):
    """A Gaussian of x, sd 1, with y = x² - 1 to within 0.3, and a third apart."""
    x, y, other = z.T
    return -0.5 * x**2 - 0.5 * ((y - x**2 + 1) / 0.3) ** 2 - 8 * other**2


def half(z):
    """A Gaussian cut off at zero of the first coordinate."""
    return np.where(z[:, 0] >= 0, -8 * (z**2).sum(axis=1), -np.inf)


def test_a_gaussian_has_no_heavy_tail():
    assert find_tails(gaussian, find_mode(gaussian, START)) == ()


def test_a_tail_as_wide_as_the_prior_gets_a_gaussian_as_wide():
    mode = find_mode(flat_below, START)
    (tail,) = find_tails(flat_below, mode)
    assert tail.mode[2] < mode.mode[2] - 1
    assert np.sqrt(tail.covariance[2, 2]) == pytest.approx(1.0, rel=0.05)
    np.testing.assert_allclose(tail.mode[:2], 0, atol=0.01)
    assert tail.log_density == pytest.approx(float(flat_below(tail.mode[None])[0]))
    assert mode.log_density - tail.log_density > FALLEN


def test_both_ends_of_a_curved_ridge_are_found_on_the_ridge():
    tails = find_tails(curved_ridge, find_mode(curved_ridge, START - [[0, 1, 0]]))
    ends = {float(np.sign(tail.mode[0])) for tail in tails}
    assert ends == {-1.0, 1.0}
    for tail in tails:
        assert tail.mode[1] == pytest.approx(tail.mode[0] ** 2 - 1, abs=0.3)


def test_there_is_no_tail_beyond_the_edge_of_the_support():
    mode = find_mode(half, np.array([[0.3, 0.1, 0.1]]))
    assert all(tail.mode[0] >= 0 for tail in find_tails(half, mode))


def test_the_mixture_has_modes_first_and_the_weights_of_all():
    mixture = approximate(flat_below, START)
    assert len(mixture.modes) == 1
    assert len(mixture.tails) == 1
    assert mixture.parts == (*mixture.modes, *mixture.tails)
    assert mixture.weights.shape == (2,)
    assert mixture.weights.sum() == pytest.approx(1.0)
    drawn = mixture.draw(4000, rng=np.random.default_rng(1))
    near_tail = np.mean(drawn[:, 2] < mixture.tails[0].mode[2])
    assert near_tail > 0.2 * mixture.weights[1]
