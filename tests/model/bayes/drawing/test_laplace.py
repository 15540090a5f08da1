# SPDX-License-Identifier: MIT
import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from scipy import stats

from model.bayes.drawing.laplace import (
    Laplace,
    LaplaceMixture,
    find_mode,
    find_modes,
    gradient,
    hessian,
)
from model.errors import FitError


def gaussian(d, seed):
    """Return a Gaussian narrower than the prior, as every posterior is, and its log density."""
    rng = np.random.default_rng(seed)
    root = rng.standard_normal((d, d)) / np.sqrt(d)
    covariance = 0.3 * (root @ root.T + 0.1 * np.eye(d))
    covariance /= max(1.0, np.linalg.eigvalsh(covariance).max())
    mean = rng.standard_normal(d)
    return mean, covariance, stats.multivariate_normal(mean, covariance)


def scaled(distribution, log_evidence):
    """Return the log density of a distribution times a constant."""

    def log_density(z):
        return np.reshape(distribution.logpdf(z), len(z)) + log_evidence

    return log_density


# --- derivatives


@given(st.integers(0, 100))
def test_gradient_and_hessian_are_those_of_a_polynomial(seed):
    rng = np.random.default_rng(seed)
    linear, cubic = rng.standard_normal((2, 4))
    matrix = rng.standard_normal((4, 4))
    matrix += matrix.T
    z = rng.standard_normal(4)

    def polynomial(x):
        return x @ linear + 0.5 * np.einsum("wi,ij,wj->w", x, matrix, x) + x**3 @ cubic

    slope = linear + matrix @ z + 3 * cubic * z**2
    np.testing.assert_allclose(gradient(polynomial, z), slope, atol=1e-6)
    np.testing.assert_allclose(
        hessian(polynomial, z), matrix + np.diag(6 * cubic * z), atol=1e-6 * np.abs(matrix).max()
    )


# --- exact for a Gaussian


@settings(max_examples=25)  # a climb each
@given(d=st.integers(1, 8), seed=st.integers(0, 100), log_evidence=st.floats(-500, 500))
def test_a_gaussian_is_found_exactly(d, seed, log_evidence):
    mean, covariance, distribution = gaussian(d, seed)
    found = find_mode(scaled(distribution, log_evidence), np.zeros((1, d)))
    sd = np.sqrt(np.diag(covariance))
    np.testing.assert_allclose((found.mode - mean) / sd, 0.0, atol=1e-4)
    np.testing.assert_allclose(found.covariance, covariance, atol=1e-3 * covariance.max())
    assert found.log_density == pytest.approx(distribution.logpdf(mean) + log_evidence, abs=1e-6)
    assert found.log_evidence() == pytest.approx(log_evidence, abs=1e-2)


def test_every_variance_stays_within_the_priors():
    flat = find_mode(lambda z: -0.5 * (z[:, 0] / 10) ** 2 - 0.5 * z[:, 1] ** 2, np.ones((1, 2)))
    assert np.linalg.eigvalsh(flat.covariance).max() <= 1 + 1e-9


# --- from several starts


def two_hills(z):
    """Two Gaussians of sd 0.3: the one at 2 three times the one at -2."""
    hills = stats.norm.logpdf(z[:, :1], [-2.0, 2.0], 0.3) + np.log([0.25, 0.75])
    return np.logaddexp(*hills.T)


def test_the_higher_of_two_modes_is_taken_whatever_the_order_of_the_starts():
    starts = np.array([[-2.2], [2.3]])
    for order in (starts, starts[::-1]):
        found = find_mode(two_hills, order)
        assert found.mode == pytest.approx(np.array([2.0]), abs=1e-3)
        assert found.log_evidence() == pytest.approx(np.log(0.75), abs=1e-2)


def test_a_single_start_finds_the_mode_on_its_own_side():
    assert find_mode(two_hills, np.array([[-1.5]])).mode == pytest.approx(
        np.array([-2.0]), abs=1e-3
    )


def positive_only(z):
    """A gamma density of z, zero for negative z."""
    with np.errstate(all="ignore"):
        log_density = 20 * np.log(z[:, 0]) - 20 * z[:, 0]
    return np.where(z[:, 0] > 0, log_density, -np.inf)


def test_starts_out_of_support_are_passed_over():
    found = find_mode(positive_only, np.array([[-1.0], [0.5], [-3.0]]))
    assert found.mode == pytest.approx(np.array([1.0]), abs=1e-4)
    assert found.covariance == pytest.approx(np.array([[1 / 20]]), rel=1e-3)


def test_no_start_in_support_is_an_error_that_counts_them():
    with pytest.raises(FitError, match="all 3 starting points"):
        find_mode(positive_only, np.array([[-1.0], [-0.5], [-3.0]]))


def test_a_mode_on_the_edge_of_the_support_still_has_a_finite_covariance():
    def falling(z):
        return np.where(z[:, 0] >= 0, -3 * z[:, 0] - 0.5 * z[:, 0] ** 2, -np.inf)

    found = find_mode(falling, np.array([[1.0]]))
    assert np.isfinite(found.covariance).all()
    assert 0 <= found.mode[0] < 1


# --- several modes


def test_each_mode_is_listed_once_the_highest_first():
    modes = find_modes(two_hills, np.array([[-2.2], [2.3], [-1.8], [1.9]]))
    assert [float(m.mode[0]) for m in modes] == pytest.approx([2.0, -2.0], abs=1e-3)
    np.testing.assert_allclose(LaplaceMixture(modes).weights, [0.75, 0.25], atol=1e-2)


def test_a_search_climbs_from_where_the_density_is_not_convex():
    student = stats.multivariate_t(np.array([1.0, -2.0]), np.diag([0.05, 0.2]), df=3)
    (found,) = find_modes(scaled(student, 0.0), np.array([[3.0, 1.0]]))
    np.testing.assert_allclose(found.mode, [1.0, -2.0], atol=1e-3)


def test_a_mode_that_holds_nothing_is_left_out():
    def one_hill_and_a_bump(z):
        hills = stats.norm.logpdf(z[:, :1], [-2.0, 2.0], 0.3) - np.array([15.0, 0.0])
        return np.logaddexp(*hills.T)

    assert len(find_modes(one_hill_and_a_bump, np.array([[-2.0], [2.0]]))) == 1


def test_a_slight_mode_keeps_a_tenth_of_an_equal_share():
    heavy, light = (Laplace(np.zeros(1), np.eye(1), height) for height in (0.0, -9.0))
    assert LaplaceMixture((heavy, light)).weights[1] == pytest.approx(0.05, rel=0.06)


@given(st.integers(0, 20))
def test_a_mixtures_density_is_that_of_its_draws(seed):
    rng = np.random.default_rng(seed)
    modes = tuple(Laplace(np.array([x]), np.eye(1) * v, -1.0) for x, v in ((-2, 0.1), (2, 0.5)))
    mixture = LaplaceMixture(modes)
    grid = np.linspace(-40, 40, 8001)
    density = np.exp(mixture.log_pdf(grid[:, None]))
    cumulative = np.cumsum(density) * (grid[1] - grid[0])
    assert cumulative[-1] == pytest.approx(1.0, abs=1e-3)
    drawn = mixture.draw(400, rng=rng)[:, 0]
    assert stats.kstest(drawn, lambda x: np.interp(x, grid, cumulative)).pvalue > 1e-4
