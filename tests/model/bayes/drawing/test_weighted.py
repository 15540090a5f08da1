# SPDX-License-Identifier: MIT
"""Importance weights against densities whose answer is known, and what they do where it is hard."""

import numpy as np
import pytest
from scipy import stats

from model.bayes.drawing.laplace import Laplace, LaplaceMixture, find_mode, find_modes
from model.bayes.drawing.tails import approximate
from model.bayes.drawing.weighted import importance_draws, pareto_smoothed, weighted_draws


def two_hills(z):
    """Two Gaussians of sd 0.3: the one at 2 three times the one at -2."""
    hills = stats.norm.logpdf(z[:, :1], [-2.0, 2.0], 0.3) + np.log([0.25, 0.75])
    return np.logaddexp(*hills.T)


def positive_only(z):
    """A gamma density of z, zero for negative z."""
    with np.errstate(all="ignore"):
        log_density = 20 * np.log(z[:, 0]) - 20 * z[:, 0]
    return np.where(z[:, 0] > 0, log_density, -np.inf)


def curved_ridge(z):
    """A Gaussian bent along a parabola: x of sd 0.9, y = (x² - 1) / 2 to within 0.3."""
    x, y = z.T
    return -0.5 * (x / 0.9) ** 2 - 0.5 * ((y - 0.5 * (x**2 - 1)) / 0.3) ** 2


def test_weighted_draws_have_the_mean_and_spread_of_a_skewed_density():
    def log_gamma(z):  # of log of a gamma variable: skewed to the left, mode at 0
        return 6 * (z[:, 0] - np.exp(z[:, 0])) - 4.5 * (z[:, 1] - z[:, 0]) ** 2

    exact_mean = stats.loggamma(6).mean() - np.log(6)
    exact_sd = stats.loggamma(6).std()
    laplace = find_mode(log_gamma, np.zeros((1, 2)))
    assert laplace.mode[0] == pytest.approx(0.0, abs=1e-4)
    drawn = importance_draws(
        log_gamma, LaplaceMixture((laplace,)), n=20_000, rng=np.random.default_rng(0)
    )
    mean = drawn.weights @ drawn.z
    sd = np.sqrt(drawn.weights @ (drawn.z - mean) ** 2)
    assert mean == pytest.approx([exact_mean, exact_mean], abs=0.02)
    assert sd == pytest.approx([exact_sd, np.hypot(exact_sd, 1 / 3)], rel=0.02)
    assert drawn.weights.sum() == pytest.approx(1.0)
    assert drawn.pareto_k < 0.5


def test_a_density_far_wider_than_its_laplace_approximation_is_reported():
    def cauchy(z):
        return stats.cauchy.logpdf(z[:, 0], scale=0.2)

    laplace = find_mode(cauchy, np.zeros((1, 1)))
    drawn = importance_draws(
        cauchy, LaplaceMixture((laplace,)), n=4000, rng=np.random.default_rng(1)
    )
    assert drawn.pareto_k > 0.7


def test_draws_out_of_support_carry_no_weight():
    laplace = find_mode(positive_only, np.array([[0.5]]))
    wide = type(laplace)(laplace.mode, 4 * np.eye(1), laplace.log_density)
    drawn = importance_draws(
        positive_only, LaplaceMixture((wide,)), n=4000, rng=np.random.default_rng(2)
    )
    outside = drawn.z[:, 0] <= 0
    assert outside.mean() > 0.1
    np.testing.assert_array_equal(drawn.weights[outside], 0.0)
    resampled = drawn.resample(20_000, rng=np.random.default_rng(3))
    assert resampled.min() > 0
    assert resampled.mean() == pytest.approx(21 / 20, rel=0.02)


def test_share_of_accepted_jumps_is_that_of_a_sampler_that_jumps():
    def gaussian(z):
        return -0.5 * z[:, 0] ** 2

    wide = LaplaceMixture((Laplace(np.zeros(1), 9 * np.eye(1), 0.0),))
    rng = np.random.default_rng(5)
    drawn = importance_draws(gaussian, wide, n=4000, rng=rng)
    at, to = rng.standard_normal((20_000, 1)), wide.draw(20_000, rng=rng)
    ratio = [gaussian(z) - wide.log_pdf(z) for z in (at, to)]
    expected = np.exp(np.minimum(ratio[1] - ratio[0], 0)).mean()
    assert drawn.jumps == pytest.approx(expected, abs=0.03)
    same = importance_draws(wide.log_pdf, wide, n=400, rng=rng)
    assert same.jumps == pytest.approx(1.0)


def test_the_same_generator_gives_the_same_draws():
    modes = LaplaceMixture(find_modes(two_hills, np.array([[2.0]])))
    one, same = (
        importance_draws(two_hills, modes, n=500, rng=np.random.default_rng(4)) for _ in range(2)
    )
    np.testing.assert_array_equal(one.z, same.z)
    np.testing.assert_array_equal(one.weights, same.weights)


# --- adaptation


def narrow(log_density, start, *, share, shift=0.0):
    """Return the Laplace approximation found from a start, with a share of its covariance."""
    found = find_mode(log_density, np.array([start]))
    mode = found.mode + shift * np.sqrt(np.diag(found.covariance))
    return LaplaceMixture((Laplace(mode, share * found.covariance, found.log_density),))


def test_a_good_approximation_is_drawn_from_once():
    modes = LaplaceMixture(find_modes(two_hills, np.array([[-2.2], [2.3]])))
    plain = importance_draws(two_hills, modes, n=1000, rng=np.random.default_rng(1))
    rng = np.random.default_rng(1)
    drawn = weighted_draws(two_hills, modes, n=1000, wanted=200, rng=rng, threads=2)
    np.testing.assert_array_equal(drawn.z, plain.z)


def test_the_first_draws_stay_among_those_of_later_rounds():
    modes = LaplaceMixture(find_modes(two_hills, np.array([[-2.2], [2.3]])))
    first = importance_draws(two_hills, modes, n=1000, rng=np.random.default_rng(1))
    wanted = 1.5 * first.effective_size
    drawn = weighted_draws(two_hills, modes, n=1000, wanted=wanted, rng=np.random.default_rng(1))
    assert set(first.z[:, 0]) < set(drawn.z[:, 0])
    assert drawn.effective_size >= wanted
    assert drawn.weights[drawn.z[:, 0] > 0].sum() == pytest.approx(0.75, abs=0.02)


def leaning(z):
    """Log density of sixteen skewed coordinates, logarithms of gamma variables, of shape 3."""
    return np.sum(3 * z - np.exp(z), axis=1)


@pytest.mark.parametrize("seed", range(3))
def test_a_leaning_density_is_known_to_its_tails(seed):
    """Its Laplace approximation lacks the lean: a mixture fitted to weighted draws has it."""
    rng = np.random.default_rng(seed)
    modes = LaplaceMixture((find_mode(leaning, np.zeros((1, 16))),))
    first = importance_draws(leaning, modes, n=10_000, rng=rng)
    assert first.effective_size < 1500
    drawn = weighted_draws(leaning, modes, n=10_000, wanted=4000, rng=rng)
    assert drawn.reliable
    assert drawn.effective_size >= 4000
    mean = drawn.weights @ drawn.z
    np.testing.assert_allclose(mean, 0.9228, atol=0.05)  # digamma(3)
    tail = drawn.weights @ (drawn.z < -0.2012)  # the 5 % quantile of gamma(3) is 0.8177
    np.testing.assert_allclose(tail, 0.05, atol=0.015)


@pytest.mark.parametrize("seed", range(3))
def test_a_curved_ridge_is_followed_by_the_gaussians_in_its_tails(seed):
    rng, start = np.random.default_rng(seed), np.array([[0.1, -0.4]])
    modes = LaplaceMixture(find_modes(curved_ridge, start))
    assert not importance_draws(curved_ridge, modes, n=4000, rng=rng).reliable
    approximation = approximate(curved_ridge, start)
    drawn = weighted_draws(curved_ridge, approximation, n=4000, wanted=1000, rng=rng)
    assert drawn.reliable
    assert drawn.effective_size > 500
    x, y = drawn.z.T
    assert drawn.weights @ x == pytest.approx(0.0, abs=0.12)
    assert drawn.weights @ x**2 == pytest.approx(0.81, rel=0.12)
    assert drawn.weights @ y == pytest.approx(-0.095, abs=0.08)


def test_a_poor_start_is_mended_by_its_own_draws():
    def gaussian(z):
        return -0.5 * (z**2 @ np.array([1.0, 4.0, 9.0]))

    poor = narrow(gaussian, [0.1, 0.1, 0.1], share=0.1, shift=2.0)
    drawn = weighted_draws(gaussian, poor, n=500, wanted=1000, rng=np.random.default_rng(3))
    assert drawn.reliable
    assert drawn.jumps < 0.05
    sd = np.sqrt(drawn.weights @ drawn.z**2)
    np.testing.assert_allclose(sd, [1, 1 / 2, 1 / 3], rtol=0.1)


def test_adapted_draws_come_in_random_order():
    """Parts of the draws stand for independent ensembles: none is of one round alone."""
    approximation = narrow(curved_ridge, [0.1, -0.4], share=1.0)
    drawn = weighted_draws(
        curved_ridge, approximation, n=500, wanted=1000, rng=np.random.default_rng(0)
    )
    half = len(drawn.z) // 2
    assert drawn.part(slice(half)).effective_size > 0.3 * drawn.effective_size
    assert drawn.part(slice(half, None)).effective_size > 0.3 * drawn.effective_size


@pytest.mark.parametrize(
    "log_ratio", [np.zeros(60), np.array([0.0, -1.0, -2.0]), np.r_[0.0, np.full(59, -5000.0)]]
)
def test_ratios_without_a_tail_are_unreliable_and_kept_as_they_are(log_ratio):
    smoothed, pareto_k = pareto_smoothed(log_ratio)
    assert pareto_k == np.inf
    assert np.exp(smoothed).sum() == pytest.approx(1.0)
    assert smoothed - smoothed[0] == pytest.approx(log_ratio - log_ratio[0])


@pytest.mark.parametrize("k", [0.3, 0.9])
def test_the_tail_index_of_pareto_ratios_is_found(k):
    rng = np.random.default_rng(1)
    drawn = [pareto_smoothed(-k * np.log(rng.random(40_000))) for _ in range(8)]
    assert np.mean([found for _, found in drawn]) == pytest.approx(k, abs=0.1)
    assert np.exp(drawn[0][0]).sum() == pytest.approx(1.0)
