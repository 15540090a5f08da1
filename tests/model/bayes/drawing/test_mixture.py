# SPDX-License-Identifier: MIT
"""Densities, draws and fits of mixtures, against scipy's distributions and known clouds."""

import numpy as np
import pytest
from scipy.stats import multivariate_t

from model.bayes.drawing.mixture import StudentMixture, fit_mixture, start_mixture


def single(centre, scale, *, case=0, freedom=9.0):
    part = np.full((1, len(centre)), centre), np.asarray(scale)[None]
    return StudentMixture(np.ones(1), *part, np.full(1, freedom), np.full(1, case))


TILTED = np.array([[1.0, 0.8], [0.8, 1.0]])
ONE, FAR = single(np.zeros(2), np.eye(2)), single(np.full(2, 40.0), 4 * TILTED)


def two_clouds(n, rng):
    """Return draws of two Gaussians, 70 % narrow at (-3, 0) and 30 % tilted at (3, 0)."""
    right = rng.random(n) < 0.3
    narrow = 0.5 * rng.standard_normal((n, 2)) - [3.0, 0.0]
    tilted = rng.standard_normal((n, 2)) @ np.linalg.cholesky(TILTED).T + [3.0, 0.0]
    return np.where(right[:, None], tilted, narrow)


def fitted(z, weights, *, case=None, former=ONE):
    rng, cases = np.random.default_rng(1), np.zeros(len(z), dtype=int) if case is None else case
    return fit_mixture(z, cases, weights / weights.sum(), former=former, rng=rng)


def test_the_density_is_the_weighted_sum_of_its_parts():
    mixture = ONE.beside(FAR, 0.25)
    z = np.array([[0.0, 0.0], [1.0, -2.0], [40.0, 41.0]])
    expected = 0.75 * multivariate_t(np.zeros(2), np.eye(2), df=9).pdf(z)
    expected += 0.25 * multivariate_t(np.full(2, 40.0), 4 * TILTED, df=9).pdf(z)
    np.testing.assert_allclose(np.exp(mixture.log_pdf(z)), expected, rtol=1e-12)


def test_a_point_has_the_density_of_the_parts_of_its_case():
    mixture = ONE.beside(single(np.zeros(2), 4 * np.eye(2), case=3), 0.25)
    z, case = np.zeros((3, 2)), np.array([0, 3, 1])
    expected = [0.75 / (2 * np.pi), 0.25 / (8 * np.pi), 0.0]
    np.testing.assert_allclose(np.exp(mixture.log_pdf(z, case)), expected, rtol=1e-12)


def test_draws_have_the_shares_the_centres_and_the_spreads_of_the_parts():
    mixture = ONE.beside(single(np.full(2, 40.0), 4 * TILTED, case=1), 0.25)
    z, case = mixture.draw(40_000, rng=np.random.default_rng(1))
    far = z[:, 0] > 20
    np.testing.assert_array_equal(case, far)
    assert far.mean() == pytest.approx(0.25, abs=0.01)
    assert far[:100].any()  # in random order, not part by part
    np.testing.assert_allclose(z[~far].mean(axis=0), 0.0, atol=0.03)
    np.testing.assert_allclose(np.cov(z[far].T), mixture.covariance(1), rtol=0.08)
    np.testing.assert_allclose(mixture.covariance(1), 4 * TILTED * 9 / 7, rtol=1e-12)


def test_a_covariance_is_that_of_all_parts_of_a_case():
    mixture = single([-3.0], [[1.0]]).beside(single([3.0], [[1.0]]), 0.5)
    np.testing.assert_allclose(mixture.covariance(0), 9 + 9 / 7)


def test_modes_are_weighted_by_evidence_but_none_is_left_out():
    start = start_mixture(np.zeros((3, 2)), np.tile(np.eye(2), (3, 1, 1)), np.array([0, 0, -50.0]))
    np.testing.assert_allclose(start.weights[:2], start.weights[0])
    assert start.weights[2] == pytest.approx(1 / 31)


def test_a_fitted_mixture_has_the_clouds_of_the_draws():
    z = two_clouds(6000, np.random.default_rng(2))
    mixture = fitted(z, np.ones(6000))
    left = mixture.centres[:, 0] < 0
    assert mixture.weights[left].sum() == pytest.approx(0.7, abs=0.02)
    rows = z[:, 0] < 0
    drawn = mixture.draw(40_000, rng=np.random.default_rng(3))[0]
    for side in (1, -1):
        found, given = drawn[side * drawn[:, 0] > 0], z[rows if side < 0 else ~rows]
        np.testing.assert_allclose(found.mean(axis=0), given.mean(axis=0), atol=0.15)
        np.testing.assert_allclose(np.cov(found.T), np.cov(given.T), atol=0.2)


def test_weights_count_as_repeated_draws():
    z = np.random.default_rng(3).standard_normal((3000, 2))
    mixture = fitted(z, np.exp(z[:, 0]))  # moves the mean to (1, 0)
    np.testing.assert_allclose(mixture.weights @ mixture.centres, [1.0, 0.0], atol=0.15)


def test_each_case_has_parts_of_its_own_by_its_weight():
    rng = np.random.default_rng(4)
    z, case = rng.standard_normal((400, 2)), np.arange(400) % 2
    former = ONE.beside(single(np.zeros(2), np.eye(2), case=1), 0.5)
    mixture = fitted(z + 9 * case[:, None], np.where(case == 1, 3.0, 1.0), case=case, former=former)
    second = mixture.case == 1
    assert mixture.weights[second].sum() == pytest.approx(0.75)
    np.testing.assert_allclose(mixture.centres[second], 9.0, atol=1.5)
    np.testing.assert_allclose(mixture.centres[~second], 0.0, atol=1.5)


def test_a_case_of_weights_whose_squares_are_zero_has_no_part():
    z, case = np.random.default_rng(4).standard_normal((400, 2)), np.arange(400) % 2
    mixture = fitted(z, np.where(case == 1, 1e-200, 1.0), case=case)
    assert set(mixture.case) == {0}


def test_a_covariance_of_few_draws_is_shrunk_to_the_former():
    """One draw has all the weight: its own covariance is zero."""
    z = np.random.default_rng(4).standard_normal((200, 3))
    former = single(np.zeros(3), np.diag([1.0, 4.0, 9.0]))
    mixture = fitted(z, np.eye(1, 200)[0], former=former)
    shrunk = 6 / 7 * former.covariance(0)
    np.testing.assert_allclose(mixture.covariance(0), shrunk, rtol=1e-9)


def test_no_part_is_narrower_than_its_draws_can_tell():
    """A few draws far from all others, nearly at one place, may have a part of their own."""
    z = np.random.default_rng(4).standard_normal((400, 3))
    z[:4] = 30 + 1e-6 * z[:4]
    mixture = fitted(z, np.ones(400), former=single(np.zeros(3), np.eye(3)))
    assert all(np.linalg.eigvalsh(scale).min() > 0.1 for scale in mixture.scales)
