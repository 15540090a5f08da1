# SPDX-License-Identifier: MIT
"""The points that average a curve over the slips of a block have the moments of these slips."""

import numpy as np
import pytest

from model.bayes.averaging.slip_rule import FAR, NEAR_PAIRS, POINTS, WEIGHTS, slip_rule
from model.slip.thesis_curve import THESIS_LAW, THESIS_VALUES

SD = 0.004


def pairs(rule):
    """Return distances and weights of pairs, shape (pairs, n); what a block lacks has no weight."""
    index = rule.first + np.arange(NEAR_PAIRS)[:, None]
    last = np.minimum(index, rule.last - 1)
    return POINTS[last] * rule.sd, np.where(index < rule.last, WEIGHTS[last], 0.0)


def mean_of(curve, slip, *, sd=SD, sine=False):
    """Average a curve over slip of a standard deviation by the rule."""
    away, weight = pairs(slip_rule(slip, np.full(len(slip), sd**2), sine=sine))
    return curve(slip) + np.sum(
        weight * (curve(slip + away) - 2 * curve(slip) + curve(slip - away)), axis=0
    )


def slope_of(curve, slip):
    away, weight = pairs(slip_rule(slip, np.full(len(slip), SD**2)))
    return np.sum(weight * away / SD**2 * (curve(slip + away) - curve(slip - away)), axis=0)


@pytest.mark.parametrize(
    ("slip", "sine", "moments"),
    [
        (0.0, False, [1, 3, 15, 105, 945]),  # Gaussian
        (0.5, False, [1, 3]),  # three points, exact to the fifth
        (0.0, True, [1, 3 / 2, 5 / 2, 35 / 8]),
    ],
)
def test_the_points_have_the_moments_of_the_distribution(slip, sine, moments):
    for half, moment in enumerate(moments, start=1):
        found = mean_of(lambda x, p=2 * half: ((x - slip) / SD) ** p, np.array([slip]), sine=sine)
        assert found == pytest.approx([moment])
        odd = mean_of(lambda x, p=2 * half + 1: ((x - slip) / SD) ** p, np.array([slip]), sine=sine)
        assert odd == pytest.approx([0.0], abs=1e-9)


def test_the_slope_is_that_of_the_regression_over_the_spread():
    """Of a cube it is three times the variance, where the derivative at the mean is zero."""
    assert slope_of(lambda x: x**3, np.zeros(1)) == pytest.approx([3 * SD**2])
    assert slope_of(lambda x: 7 * x, np.array([0.0, 1.0])) == pytest.approx([7.0, 7.0])


@pytest.mark.parametrize(("sd", "most", "of_one_pair"), [(SD, 1e-4, 0.01), (0.01, 0.01, 0.1)])
def test_the_thesiss_curve_at_its_lightest_load_is_averaged_well(sd, most, of_one_pair):
    """It rises and falls within a few standard deviations, and bends no more far from zero."""

    def curve(slip):
        return THESIS_LAW.force(slip, np.full(np.shape(slip), 2.13), THESIS_VALUES)

    nodes, weights = np.polynomial.hermite_e.hermegauss(120)
    slip = np.linspace(-3 * FAR * sd, 3 * FAR * sd, 961)
    exact = curve(slip[:, None] + sd * nodes) @ weights / weights.sum()
    away, peak = np.sqrt(3) * sd, np.abs(exact).max()
    three = (curve(slip + away) + 4 * curve(slip) + curve(slip - away)) / 6
    wrong, of_three = (np.abs(x - exact) / peak for x in (mean_of(curve, slip, sd=sd), three))
    assert wrong.max() < most
    assert of_three.max() > of_one_pair
    far = np.abs(slip) > FAR * sd
    np.testing.assert_allclose(wrong[far], of_three[far], atol=1e-12)
    assert of_three[far].max() < 1e-4
