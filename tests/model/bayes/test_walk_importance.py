# SPDX-License-Identifier: MIT
"""Weighted draws against densities whose answer is known."""

import numpy as np
import pytest

from model.bayes.walk_importance import Mode, weighted_draws
from model.bayes.walk_prior import WrongLeg

D = 4
CASES = (None, WrongLeg(1))


def modes(log_evidence):
    guesses = zip(CASES, log_evidence, strict=True)
    return [Mode(case, np.zeros(D), np.eye(D), log) for case, log in guesses]


def drawn(log_density, *, log_evidence=(0.0, 0.0), seed=1):
    rng = np.random.default_rng(seed)
    return weighted_draws(modes(log_evidence), log_density, rng=rng, tell=lambda _: None)


def test_a_gaussian_comes_back_from_a_wrong_start():
    mean, sd = np.array([0.5, -0.5, 0.0, 1.0]), np.array([0.5, 1.0, 0.7, 1.2])
    result = drawn(lambda z, case: -0.5 * (((z - mean) / sd) ** 2).sum(axis=1))
    found = result.weight @ result.z
    np.testing.assert_allclose(found, mean, atol=0.2)
    np.testing.assert_allclose(np.sqrt(result.weight @ (result.z - found) ** 2), sd, rtol=0.2)


def test_half_a_gaussian_is_told_from_a_whole_one():
    half = lambda z, case: np.where(z[:, 0] < 0, -0.5 * (z**2).sum(axis=1), -1e9)  # noqa: E731
    result = drawn(half)
    assert result.weight[result.z[:, 0] > 0].sum() == 0
    assert result.weight @ result.z[:, 0] == pytest.approx(-np.sqrt(2 / np.pi), abs=0.12)


def test_cases_get_the_weight_of_their_evidence_whatever_was_guessed():
    density = lambda z, case: -0.5 * (z**2).sum(axis=1) + np.log(np.where(case == 1, 0.75, 0.25))  # noqa: E731
    for guess in ((0.0, 0.0), (0.0, -2.0)):
        results = [drawn(density, log_evidence=guess, seed=seed) for seed in range(20)]
        shares = [result.weight[result.case == 1].sum() for result in results]
        assert np.mean(shares) == pytest.approx(0.75, abs=0.03)
        assert np.std(shares) < 0.08
