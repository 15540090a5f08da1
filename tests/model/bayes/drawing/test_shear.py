# SPDX-License-Identifier: MIT
"""A shear straightens a curved posterior, and leaves every density as it is."""

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from model.bayes.drawing.laplace import LaplaceMixture, find_mode
from model.bayes.drawing.shear import Shear, find_shear
from model.bayes.drawing.weighted import importance_draws

BEND = 8.0  # standard deviations of the narrow direction, at one of the wide
RIDGE_SD = 0.02
D = 4


def curved(z):
    """Wide in the first two coordinates; the third follows both of them along a curve."""
    a, b, narrow, apart = z.T
    curve = BEND * RIDGE_SD * (a**2 - 0.5 * a * b + 0.1 * a**3)
    return -0.5 * (a**2 + (b / 0.5) ** 2 + ((narrow - curve) / RIDGE_SD) ** 2 + (apart / 0.05) ** 2)


def straight(z):
    return -0.5 * (z**2 @ np.array([1.0, 4.0, 1 / RIDGE_SD**2, 400.0]))


def mode_of(log_density):
    return find_mode(log_density, np.full((1, D), 0.05))


@pytest.fixture(scope="module")
def shear():
    return find_shear(curved, mode_of(curved), np.random.default_rng(1))


def test_a_straight_density_needs_no_shear():
    assert find_shear(straight, mode_of(straight), np.random.default_rng(1)) is None


def test_a_density_as_wide_as_its_prior_everywhere_needs_no_shear():
    def prior(z):
        return -0.5 * (z**2).sum(axis=1)

    assert find_shear(prior, mode_of(prior), np.random.default_rng(1)) is None


def test_the_narrow_coordinate_s_curve_is_found(shear):
    x = np.array([[1.0, 0.0, 0.0, 0.0], [-1.0, 0.0, 0.0, 0.0], [1.0, -0.5, 0.0, 0.0]])
    expected = BEND * RIDGE_SD * np.array([1.1, 0.9, 1.1 + 0.25])
    np.testing.assert_allclose(shear.sheared(x)[:, 2], expected, atol=0.3 * RIDGE_SD)


def test_straightened_draws_have_good_weights_and_the_same_answer(shear):
    rng = np.random.default_rng(2)
    plain = importance_draws(curved, LaplaceMixture((mode_of(curved),)), n=4000, rng=rng)
    assert not plain.reliable

    def straightened(x):
        return curved(shear.sheared(x))

    mixture = LaplaceMixture((mode_of(straightened),))
    drawn = importance_draws(straightened, mixture, n=4000, rng=rng)
    assert drawn.pareto_k < 0.5
    assert drawn.effective_size > 2000
    z = shear.sheared(drawn.z)
    assert drawn.weights @ z[:, 0] ** 2 == pytest.approx(1.0, rel=0.1)
    mean_curve = BEND * RIDGE_SD  # of a² with variance one; the other terms have no mean
    assert drawn.weights @ z[:, 2] == pytest.approx(mean_curve, rel=0.1)


@settings(max_examples=50)
@given(st.integers(0, 1000), st.floats(0.1, 20.0))
def test_it_is_inverted_exactly_and_keeps_volumes(seed, far):
    rng = np.random.default_rng(seed)
    vectors = np.linalg.qr(rng.standard_normal((D, D)))[0]
    terms = ((0, 0), (0, 1), (0, 0, 1))
    shift = rng.standard_normal((len(terms), 2)) @ vectors[:, 2:].T
    shear = Shear(rng.standard_normal(D), vectors[:, :2] / [1.0, 0.3], terms, shift)
    x = far * rng.standard_normal((5, D))
    np.testing.assert_allclose(shear.straightened(shear.sheared(x)), x, atol=1e-9 * far)
    point = shear.centre + 0.1 * vectors[:, 0]
    step = 1e-6 * np.eye(D)
    jacobian = (shear.sheared(point + step) - shear.sheared(point - step)) / 2e-6
    assert np.linalg.det(jacobian) == pytest.approx(1.0, rel=1e-5)


def test_the_same_generator_gives_the_same_shear(shear):
    again = find_shear(curved, mode_of(curved), np.random.default_rng(1))
    np.testing.assert_array_equal(again.shift, shear.shift)
