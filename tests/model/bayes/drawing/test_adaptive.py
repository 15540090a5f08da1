# SPDX-License-Identifier: MIT
"""Weighted draws against densities whose answer is known."""

import numpy as np
import pytest

from model.bayes.drawing.adaptive import Effort, Mode, adaptive_draws

D = 4
EFFORT = Effort(200, 150.0, 10)


def ignored(_fraction):
    """Take note of no progress."""


def modes(log_evidence):
    return [Mode(np.zeros(D), np.eye(D), log) for log in log_evidence]


def drawn(log_density, *, log_evidence=(0.0, 0.0), seed=1):
    rng = np.random.default_rng(seed)
    return adaptive_draws(
        modes(log_evidence), log_density, rng=rng, progress=ignored, effort=EFFORT
    )


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


def test_a_case_of_weights_whose_squares_are_zero_keeps_its_gaussian():
    far = lambda z, case: -0.5 * ((z - 1.5) ** 2).sum(axis=1) - np.where(case == 1, 600.0, 0.0)  # noqa: E731
    result = drawn(far)
    assert 0 < result.weight[result.case == 1].sum() < 1e-200
    np.testing.assert_allclose(result.weight @ result.z, 1.5, atol=0.2)


def kinked(z, case):
    """A density that bends where two of its coordinates come to nothing together."""
    a, b = z[:, 0] + z[:, 1], z[:, 2] - z[:, 3]
    steep = (
        np.where(a > 0, 8 * a, 0.2 * a) - 1.0,
        np.where(b > 0.3, 12 * (b - 0.3), 0.0) + 3 * z[:, 0],
    )
    return -0.5 * ((z**2).sum(axis=1) + steep[0] ** 2 + steep[1] ** 2)


def test_a_kink_comes_back_from_a_narrow_start():
    narrow = [Mode(np.full(D, 0.3), 0.05 * np.eye(D), 0.0)]
    rng = np.random.default_rng(5)
    grid = rng.standard_normal((400_000, D))
    weight = np.exp(kinked(grid, None) + 0.5 * (grid**2).sum(axis=1))
    truth = weight @ grid / weight.sum()
    result = adaptive_draws(narrow, kinked, rng=rng, progress=ignored, effort=EFFORT)
    assert 1 / (result.weight @ result.weight) > 60
    np.testing.assert_allclose(result.weight @ result.z, truth, atol=0.25)


def test_bumps_around_draws_leave_the_weights_right(monkeypatch):
    monkeypatch.setattr("model.bayes.drawing.adaptive.PATIENCE", 1)
    monkeypatch.setattr("model.bayes.drawing.adaptive.ENOUGH", 1e9)
    density = lambda z, case: -0.5 * (z**2).sum(axis=1) + np.log(np.where(case == 1, 0.75, 0.25))  # noqa: E731
    wide = [Mode(np.ones(D), 0.3 * np.eye(D), 0.0) for _ in range(2)]
    results = [
        adaptive_draws(
            wide, density, rng=np.random.default_rng(seed), progress=ignored, effort=EFFORT
        )
        for seed in range(8)
    ]
    shares = [result.weight[result.case == 1].sum() for result in results]
    assert np.mean(shares) == pytest.approx(0.75, abs=0.06)
    means = np.array([result.weight @ result.z for result in results])
    np.testing.assert_allclose(means.mean(axis=0), 0.0, atol=0.1)
