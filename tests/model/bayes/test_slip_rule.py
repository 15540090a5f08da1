# SPDX-License-Identifier: MIT
"""The points that average a curve over the slips of a block have the moments of these slips."""

import numpy as np
import pytest

from model.bayes.slip_rule import FAR, slip_rule
from model.slip.thesis import THESIS_LAW, THESIS_VALUES

SD = 0.004


def mean_of(curve, slip, *, sine=False):
    """Average a curve over slip of standard deviation SD by the rule, shape of slip."""
    rule = slip_rule(slip, np.full(len(slip), SD**2), sine=sine)
    pairs = ((rule.inner, rule.inner_weight), (rule.outer, rule.outer_weight))
    return curve(slip) + sum(
        weight * (curve(slip + away) - 2 * curve(slip) + curve(slip - away))
        for away, weight in pairs
    )


def slope_of(curve, slip):
    rule = slip_rule(slip, np.full(len(slip), SD**2))
    return rule.inner_slope * (curve(slip + rule.inner) - curve(slip - rule.inner)) + (
        rule.outer_slope * (curve(slip + rule.outer) - curve(slip - rule.outer))
    )


@pytest.mark.parametrize(
    ("slip", "sine", "moments"),
    [
        (0.0, False, [1, 3, 15, 105]),  # Gaussian, exact to the ninth power
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


def test_the_thesiss_curve_at_its_lightest_load_is_averaged_well():
    """It rises and falls within four standard deviations: three points are five times as wrong."""

    def curve(slip):
        return THESIS_LAW.force(slip, np.full(np.shape(slip), 2.13), THESIS_VALUES)

    nodes, weights = np.polynomial.hermite_e.hermegauss(80)
    slip = np.linspace(-3 * FAR * SD, 3 * FAR * SD, 241)
    exact = curve(slip[:, None] + SD * nodes) @ weights / weights.sum()
    away, peak = np.sqrt(3) * SD, np.abs(exact).max()
    three = (curve(slip + away) + 4 * curve(slip) + curve(slip - away)) / 6
    wrong, of_three = np.abs(mean_of(curve, slip) - exact) / peak, np.abs(three - exact) / peak
    assert wrong.max() < 2e-3
    assert of_three.max() > 5 * wrong.max()
    far = np.abs(slip) > FAR * SD
    np.testing.assert_allclose(wrong[far], of_three[far], atol=1e-12)
    assert of_three[far].max() < 1e-4
