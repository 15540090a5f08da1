# SPDX-License-Identifier: MIT
import numpy as np
import pytest
from scipy.stats import multivariate_normal, multivariate_t

from model.bayes.drawing.student_mixture import StudentMixture, _log_gaussian, fit_mixture

ONE = StudentMixture(np.ones(1), np.zeros((1, 2)), np.eye(2)[None], np.array([9.0]))
FAR = StudentMixture(np.ones(1), np.full((1, 2), 40.0), 4 * np.eye(2)[None], np.array([9.0]))


def two_clouds(n, rng):
    """Return draws of two Gaussians, 70 % narrow at (-3, 0) and 30 % tilted at (3, 0)."""
    right = rng.random(n) < 0.3
    narrow = 0.5 * rng.standard_normal((n, 2)) - [3.0, 0.0]
    tilted = rng.standard_normal((n, 2)) @ np.array([[1.0, 0.8], [0.0, 0.6]]) + [3.0, 0.0]
    return np.where(right[:, None], tilted, narrow)


def test_the_density_is_the_weighted_sum_of_its_parts():
    mixture = ONE.beside(FAR, 0.25)
    z = np.array([[0.0, 0.0], [1.0, -2.0], [40.0, 41.0]])
    expected = 0.75 * multivariate_t(np.zeros(2), np.eye(2), df=9).pdf(z)
    expected += 0.25 * multivariate_t(np.full(2, 40.0), 4 * np.eye(2), df=9).pdf(z)
    np.testing.assert_allclose(np.exp(mixture.log_pdf(z)), expected, rtol=1e-12)


def test_draws_have_the_shares_the_centres_and_the_spreads_of_the_parts():
    z = ONE.beside(FAR, 0.25).draw(40_000, rng=np.random.default_rng(1))
    far = z[:, 0] > 20
    assert far.mean() == pytest.approx(0.25, abs=0.01)
    assert far[:100].any()  # in random order, not part by part
    np.testing.assert_allclose(z[~far].mean(axis=0), 0.0, atol=0.03)
    np.testing.assert_allclose(z[far].std(axis=0), 2 * np.sqrt(9 / 7), rtol=0.05)


def test_a_fitted_mixture_has_the_clouds_of_the_draws():
    rng = np.random.default_rng(2)
    z = two_clouds(6000, rng)
    fitted = fit_mixture(z, np.full(6000, 1 / 6000), parts=2, freedom=20.0, rng=rng)
    left, right = np.argsort(fitted.centres[:, 0])
    assert fitted.weights[left] == pytest.approx(0.7, abs=0.03)
    np.testing.assert_allclose(fitted.centres[[left, right]], [[-3, 0], [3, 0]], atol=0.1)
    covariance = fitted.scales[right] * 20 / 18
    np.testing.assert_allclose(covariance, [[1, 0.8], [0.8, 1]], atol=0.1)


def test_weights_count_as_repeated_draws():
    rng = np.random.default_rng(3)
    z = rng.standard_normal((3000, 2))
    weights = np.exp(-0.5 * (z[:, 0] - 1) ** 2 + 0.5 * z[:, 0] ** 2)  # moves the mean to (1, 0)
    fitted = fit_mixture(z, weights / weights.sum(), parts=1, freedom=20.0, rng=rng)
    np.testing.assert_allclose(fitted.centres[0], [1.0, 0.0], atol=0.1)


def test_a_part_of_few_draws_is_not_narrower_than_they_can_tell():
    """Three draws far from all others, nearly at one place, have a part of their own."""
    rng = np.random.default_rng(4)
    z = rng.standard_normal((200, 3))
    z[:3] = 30 + 1e-6 * z[:3]
    fitted = fit_mixture(
        z, np.full(200, 1 / 200), parts=2, freedom=20.0, rng=np.random.default_rng(1)
    )
    assert fitted.weights.min() == pytest.approx(3 / 200, rel=0.01)
    for scale in fitted.scales:
        assert np.linalg.eigvalsh(scale).min() > 0.1


def test_the_density_that_weighs_parts_is_a_gaussian_s():
    covariance = np.array([[1.0, 0.8, 0.0], [0.8, 2.0, -0.5], [0.0, -0.5, 0.3]])
    away = np.random.default_rng(0).standard_normal((50, 3))
    expected = multivariate_normal(cov=covariance).logpdf(away)
    found = _log_gaussian(away, covariance) - 1.5 * np.log(2 * np.pi)
    np.testing.assert_allclose(found, expected, rtol=1e-12)
