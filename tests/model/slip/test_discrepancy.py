# SPDX-License-Identifier: MIT
"""A departure is smooth, small, zero at zero slip, and gone where nothing was tested."""

import numpy as np
import pytest

from model.slip import Brush, MagicFormula, law_options, slip_law
from model.slip.discrepancy import LawWithDiscrepancy, chance_of_law, with_discrepancy

LAW, TRUTH = Brush(), (20.0, 0.4)
TWO_SIDED = with_discrepancy(LAW, 0.03, smallest=-0.3, largest=0.5)
N_KNOTS = len(TWO_SIDED.parameters) - 2


def drawn(n=4000, seed=1):
    """Return prior draws of the departure with the law's values, entries of shape (n, 1)."""
    own = np.random.default_rng(seed).normal(size=(N_KNOTS, n, 1))
    return [*TRUTH, *own]


def test_without_a_departure_it_is_the_law():
    slip = np.linspace(-0.5, 0.5, 41)
    values = [*TRUTH, *np.zeros(N_KNOTS)]
    np.testing.assert_array_equal(TWO_SIDED.force(slip, 8.0, values), LAW.force(slip, 8.0, TRUTH))
    assert TWO_SIDED.valid(8.0, values) == LAW.valid(8.0, TRUTH)


def test_a_priori_it_has_the_stated_size_on_both_sides_and_none_at_zero():
    slip = np.array([-0.3, -0.1, 0.0, 0.1, 0.3, 0.5])
    found = TWO_SIDED.departure(slip, drawn())
    assert np.abs(found[:, 2]).max() < 1e-12
    np.testing.assert_allclose(found[:, [0, 1, 3, 4, 5]].std(axis=0), 0.03, rtol=0.12)
    assert abs(np.corrcoef(found[:, 1], found[:, 3])[0, 1]) < 0.6


def test_far_beyond_the_tested_slips_the_curve_is_the_laws():
    found = TWO_SIDED.departure(np.array([-1e4, 1e4, 1e9]), drawn(100))
    assert np.abs(found).max() < 1e-6


def test_the_slope_is_the_derivative_of_the_force():
    values = [*TRUTH, *np.random.default_rng(2).normal(size=N_KNOTS)]
    slip, step = np.array([-0.2, -0.01, 0.004, 0.03, 0.3]), 1e-7
    change = TWO_SIDED.force(slip + step, 8.0, values) - TWO_SIDED.force(slip - step, 8.0, values)
    slope = TWO_SIDED.slip_derivative(slip, 8.0, values)
    np.testing.assert_allclose(change / (2 * step), slope, rtol=1e-5, atol=1e-5)


def test_the_peak_is_that_of_law_and_departure_together():
    values = [np.asarray(each)[..., 0] for each in drawn(50)[2:]]
    every = [*(np.full(50, each) for each in TRUTH), *values]
    peaks = TWO_SIDED.peak_slip(8.0, every)
    inside = np.isfinite(peaks) & (peaks < 0.9)
    assert inside.any()
    top = TWO_SIDED.force(peaks, 8.0, every)
    for factor in (0.9, 1.1):
        assert np.all(top[inside] >= TWO_SIDED.force(factor * peaks, 8.0, every)[inside])
    braking = with_discrepancy(LAW, 0.03, smallest=-0.3, largest=-0.01)
    assert braking.last == 0
    assert np.isinf(braking.peak_slip(8.0, [*TRUTH, *np.zeros(len(braking.parameters) - 2)]))


@pytest.mark.parametrize("law", [LAW, MagicFormula("constant", True, 8.0)])
def test_a_law_comes_back_from_its_name_and_options(law):
    departing = with_discrepancy(law, 0.02, smallest=0.0, largest=1.0)
    assert (departing.first, isinstance(departing, LawWithDiscrepancy)) == (0, True)
    assert slip_law(departing.name, **law_options(departing)) == departing


def test_the_law_alone_is_improbable_where_the_departure_is_far_from_zero():
    noise = np.random.default_rng(3).normal(size=(1000, N_KNOTS + 2))
    assert chance_of_law(TWO_SIDED, noise) > 0.9
    assert chance_of_law(TWO_SIDED, noise + 3.0) < 1e-6
