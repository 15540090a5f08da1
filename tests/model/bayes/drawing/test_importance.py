# SPDX-License-Identifier: MIT
"""Weighted draws against densities whose answer is known, and what they do where it is hard."""

import numpy as np
import pytest
from scipy import stats

from model.bayes.drawing import importance
from model.bayes.drawing.importance import (
    Effort,
    draws_at_modes,
    importance_draws,
    pareto_smoothed,
)
from model.bayes.drawing.laplace import Laplace, find_mode, find_modes
from model.bayes.drawing.mixture import start_mixture

RIG = Effort(draws=2000, wanted=1000.0)
WALK = Effort(draws=200, wanted=150.0)
D = 4


def drawn(log_density, start, *, effort=RIG, seed=1):
    """Draw from a density of one case, from the modes that searches from some points find."""
    modes = find_modes(log_density, np.atleast_2d(start))
    return draws_at_modes(modes, log_density, effort=effort, rng=np.random.default_rng(seed))


def of_cases(log_density, *, log_evidence=(0.0, 0.0), centre=0.0, variance=1.0, seed=1):
    """Draw from a density of several cases in `D` dimensions, from alike Gaussians."""
    n = len(log_evidence)
    start = start_mixture(
        np.full((n, D), centre), np.tile(variance * np.eye(D), (n, 1, 1)), np.array(log_evidence),
        np.arange(n),
    )  # fmt: skip
    rng = np.random.default_rng(seed)
    return importance_draws(start, log_density, effort=WALK, rng=rng)


def moments(result):
    mean = result.weights @ result.z
    return mean, np.sqrt(result.weights @ (result.z - mean) ** 2)


def evidence(result):
    """Estimate the integral of a density by the mean of its ratios to the proposals."""
    return np.exp(result.log_density - result.log_proposal).mean()


# --- densities


def gaussian(z):
    return -0.5 * (z**2 @ np.array([1.0, 4.0, 9.0]))


def two_hills(z):
    """Two Gaussians of sd 0.3: the one at 2 three times the one at -2."""
    hills = stats.norm.logpdf(z[:, :1], [-2.0, 2.0], 0.3) + np.log([0.25, 0.75])
    return np.logaddexp(*hills.T)


def positive_only(z):
    """A gamma density of z, zero for negative z, of mean 1.05."""
    with np.errstate(all="ignore"):
        log_density = 20 * np.log(z[:, 0]) - 20 * z[:, 0]
    return np.where(z[:, 0] > 0, log_density, -np.inf)


def leaning(z):
    """Log density of sixteen skewed coordinates, logarithms of gamma variables, of shape 3."""
    return np.sum(3 * z - np.exp(z), axis=1)


def banana(z):
    """A Gaussian bent along a parabola: x of sd 0.9, y = (x² - 1) / 2 to within 0.3."""
    x, y = z.T
    return -0.5 * (x / 0.9) ** 2 - 0.5 * ((y - 0.5 * (x**2 - 1)) / 0.3) ** 2


def heavy_tailed(z):
    """Student's t with 4 degrees of freedom and scale 0.5 in each of three coordinates."""
    return stats.t.logpdf(z, 4, scale=0.5).sum(axis=1)


def kinked(z, _case=None):
    """A density that bends where two of its coordinates come to nothing together."""
    a, b = z[:, 0] + z[:, 1], z[:, 2] - z[:, 3]
    steep = (
        np.where(a > 0, 8 * a, 0.2 * a) - 1.0,
        np.where(b > 0.3, 12 * (b - 0.3), 0.0) + 3 * z[:, 0],
    )
    return -0.5 * ((z**2).sum(axis=1) + steep[0] ** 2 + steep[1] ** 2)


def unequal(z, case):
    """Standard Gaussians of two cases, with a quarter and three quarters of the probability."""
    return -0.5 * (z**2).sum(axis=1) + np.log(np.where(case == 1, 0.75, 0.25))


# --- right answers


def test_a_good_approximation_is_drawn_from_once():
    result = drawn(gaussian, np.full(3, 0.1))
    assert len(result.z) == RIG.draws
    assert result.pareto_k < 0.5
    np.testing.assert_allclose(moments(result)[1], [1, 1 / 2, 1 / 3], rtol=0.06)
    integral = (2 * np.pi) ** 1.5 / 6
    assert evidence(result) == pytest.approx(integral, rel=0.05)


def test_both_of_two_modes_have_the_weight_of_their_evidence():
    result = drawn(two_hills, [[-2.2], [2.3]])
    assert result.weights[result.z[:, 0] > 0].sum() == pytest.approx(0.75, abs=0.03)
    assert evidence(result) == pytest.approx(1.0, rel=0.03)


def test_the_first_draws_stay_among_those_of_later_rounds():
    first = drawn(two_hills, [[-2.2], [2.3]], effort=Effort(1000, rounds=1))
    more = Effort(1000, 1.5 * first.effective_size)
    result = drawn(two_hills, [[-2.2], [2.3]], effort=more)
    np.testing.assert_array_equal(result.z[:1000], first.z)
    assert result.effective_size >= more.wanted
    assert evidence(result) == pytest.approx(1.0, rel=0.03)


@pytest.mark.parametrize("seed", range(3))
def test_a_leaning_density_is_known_to_its_tails(seed):
    """Its Laplace approximation lacks the lean: a mixture fitted to weighted draws has it."""
    start = np.zeros(16)
    assert drawn(leaning, start, effort=Effort(10_000, rounds=1), seed=seed).effective_size < 1500
    result = drawn(leaning, start, effort=Effort(10_000, 4000.0), seed=seed)
    assert result.reliable
    assert result.effective_size >= 4000
    np.testing.assert_allclose(moments(result)[0], 0.9228, atol=0.05)  # digamma(3)
    tail = result.weights @ (result.z < -0.2012)  # the 5 % quantile of gamma(3) is 0.8177
    np.testing.assert_allclose(tail, 0.05, atol=0.015)


@pytest.mark.parametrize("seed", range(3))
def test_a_banana_is_followed_to_its_ends(seed):
    result = drawn(banana, [0.1, -0.4], seed=seed)
    assert result.reliable
    assert result.effective_size >= RIG.wanted
    x, y = result.z.T
    assert result.weights @ x == pytest.approx(0.0, abs=0.12)
    assert result.weights @ x**2 == pytest.approx(0.81, rel=0.12)
    assert result.weights @ y == pytest.approx(-0.095, abs=0.08)
    assert evidence(result) == pytest.approx(2 * np.pi * 0.27, rel=0.08)


@pytest.mark.parametrize("seed", range(3))
def test_tails_that_reach_farther_than_the_gaussian_at_the_mode_are_weighed(seed):
    result = drawn(heavy_tailed, np.full(3, 0.1), effort=Effort(5000, 2000.0), seed=seed)
    assert result.reliable
    beyond = result.weights @ (np.abs(result.z) > 1.388)  # twice the 97.5 % quantile
    np.testing.assert_allclose(beyond, 0.05, atol=0.012)
    assert evidence(result) == pytest.approx(1.0, rel=0.05)


def test_a_density_far_wider_than_any_proposal_is_reported():
    result = drawn(lambda z: stats.cauchy.logpdf(z[:, 0], scale=0.2), [0.0], effort=Effort(4000))
    assert result.pareto_k > 0.7
    assert not result.reliable


def test_draws_out_of_support_carry_no_weight():
    wide = (Laplace(np.ones(1), np.eye(1), 0.0),)
    rng = np.random.default_rng(2)
    result = draws_at_modes(wide, positive_only, effort=RIG, rng=rng)
    outside = result.z[:, 0] <= 0
    assert outside.mean() > 0.1
    np.testing.assert_array_equal(result.weights[outside], 0.0)
    resampled = result.resample(20_000, rng=rng)
    assert resampled.min() > 0
    assert resampled.mean() == pytest.approx(21 / 20, rel=0.03)


def test_a_poor_start_is_mended_by_its_own_draws():
    found = find_mode(gaussian, np.full((1, 3), 0.1))
    away = 2 * np.sqrt(np.diag(found.covariance))
    poor = (Laplace(found.mode + away, 0.1 * found.covariance, 0.0),)
    rng = np.random.default_rng(3)
    result = draws_at_modes(poor, gaussian, effort=Effort(500, 1000.0), rng=rng)
    assert result.reliable
    np.testing.assert_allclose(moments(result)[1], [1, 1 / 2, 1 / 3], rtol=0.1)


# --- the mixture that is left


def test_the_last_mixture_is_nearer_to_the_density_than_the_first():
    first = drawn(leaning, np.zeros(16), effort=Effort(10_000, rounds=1))
    last = drawn(leaning, np.zeros(16), effort=Effort(10_000, 4000.0)).mixture
    z, _ = last.draw(4000, rng=np.random.default_rng(4))
    weights = np.exp(pareto_smoothed(leaning(z) - last.log_pdf(z))[0])
    assert 1 / np.sum(weights**2) / 4000 > 3 * first.effective_size / len(first.z)


def test_modes_stay_in_the_last_mixture_though_no_draw_of_weight_is_there():
    far = lambda z: np.where(z[:, 0] > 4.5, -np.inf, -0.5 * np.sum(z**2, axis=1))  # noqa: E731
    modes = (Laplace(np.zeros(2), np.eye(2), 0.0), Laplace(np.full(2, 9.0), np.eye(2), 0.0))
    rng = np.random.default_rng(2)
    result = draws_at_modes(modes, far, effort=Effort(500, 1e9, 3), rng=rng)
    assert result.mixture.log_pdf(np.full((1, 2), 9.0))[0] > np.log(0.05 / (2 * np.pi))


# --- cases, and kinks


def test_a_gaussian_comes_back_from_a_wrong_start():
    mean, sd = np.array([0.5, -0.5, 0.0, 1.0]), np.array([0.5, 1.0, 0.7, 1.2])
    result = of_cases(lambda z, _: -0.5 * (((z - mean) / sd) ** 2).sum(axis=1))
    np.testing.assert_allclose(moments(result)[0], mean, atol=0.2)
    np.testing.assert_allclose(moments(result)[1], sd, rtol=0.2)


def test_half_a_gaussian_is_told_from_a_whole_one():
    result = of_cases(lambda z, _: np.where(z[:, 0] < 0, -0.5 * (z**2).sum(axis=1), -1e9))
    assert result.weights[result.z[:, 0] > 0].sum() == 0
    assert result.weights @ result.z[:, 0] == pytest.approx(-np.sqrt(2 / np.pi), abs=0.12)


def test_cases_get_the_weight_of_their_evidence_whatever_was_guessed():
    for guess in ((0.0, 0.0), (0.0, -2.0)):
        results = [of_cases(unequal, log_evidence=guess, seed=seed) for seed in range(20)]
        shares = [result.weights[result.case == 1].sum() for result in results]
        assert np.mean(shares) == pytest.approx(0.75, abs=0.03)
        assert np.std(shares) < 0.08


def test_a_case_of_weights_whose_squares_are_zero_does_no_harm():
    far = lambda z, case: -0.5 * ((z - 1.5) ** 2).sum(axis=1) - np.where(case == 1, 600.0, 0.0)  # noqa: E731
    result = of_cases(far)
    assert 0 < result.weights[result.case == 1].sum() < 1e-200
    np.testing.assert_allclose(result.weights @ result.z, 1.5, atol=0.2)


def test_a_kink_comes_back_from_a_narrow_start():
    grid = np.random.default_rng(5).standard_normal((400_000, D))
    weight = np.exp(kinked(grid) + 0.5 * (grid**2).sum(axis=1))
    result = of_cases(kinked, log_evidence=(0.0,), centre=0.3, variance=0.05, seed=5)
    assert result.effective_size > 60
    np.testing.assert_allclose(result.weights @ result.z, weight @ grid / weight.sum(), atol=0.25)


def test_proposals_around_draws_leave_the_weights_right(monkeypatch):
    monkeypatch.setattr(importance, "PATIENCE", 1)
    monkeypatch.setattr(importance, "FEWEST", 1e9)
    results = [of_cases(unequal, centre=1.0, variance=0.3, seed=seed) for seed in range(8)]
    shares = [result.weights[result.case == 1].sum() for result in results]
    assert np.mean(shares) == pytest.approx(0.75, abs=0.06)
    np.testing.assert_allclose(np.mean([moments(r)[0] for r in results], axis=0), 0.0, atol=0.1)
    assert np.mean([evidence(r) for r in results]) == pytest.approx((2 * np.pi) ** 2, rel=0.1)


# --- rounds and weights


def test_the_same_generator_gives_the_same_draws():
    one, same = (drawn(banana, [0.1, -0.4], seed=4) for _ in range(2))
    np.testing.assert_array_equal(one.z, same.z)
    np.testing.assert_array_equal(one.weights, same.weights)
    np.testing.assert_array_equal(one.mixture.centres, same.mixture.centres)


def test_every_round_tells_its_share_and_the_last_ends_it():
    told, effort = [], Effort(50, 1e9, 4)
    start = start_mixture(np.zeros((1, 3)), np.eye(3)[None], np.zeros(1))
    rng = np.random.default_rng(1)
    result = importance_draws(
        start, lambda z, _: gaussian(z), effort=effort, rng=rng, progress=told.append
    )
    assert told == [0.25, 0.5, 0.75, 1.0]
    assert len(result.z) == 200


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
    smoothed = [pareto_smoothed(-k * np.log(rng.random(40_000))) for _ in range(8)]
    assert np.mean([found for _, found in smoothed]) == pytest.approx(k, abs=0.1)
    assert np.exp(smoothed[0][0]).sum() == pytest.approx(1.0)
