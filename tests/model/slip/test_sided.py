# SPDX-License-Identifier: MIT
"""Sides that are apart are similar copies of one curve, which meet in zero force at zero slip."""

import numpy as np
import pytest

from model.slip import Brush, CoulombStribeck, MagicFormula
from model.slip.laws import law_options, slip_law
from model.slip.sided import SidedLaw, braking_peak_slip, middle_curve
from model.walk.traction import law_table

CASES = [
    (MagicFormula("constant"), (20.0, 1.5, 0.4, -0.5)),
    (MagicFormula(), (20.0, 1.5, 0.4, 0.0066)),
    (Brush(), (20.0, 0.4)),
    (CoulombStribeck(), (20.0, 0.4, 0.7, 0.1)),
]
D_K, D_MU = 0.3, -0.2
SLIP, LOAD = np.linspace(-0.5, 0.5, 101), 8.0


@pytest.fixture(params=CASES, ids=lambda case: repr(case[0]))
def case(request):
    law, values = request.param
    return law, values, SidedLaw(law), (*values, D_K, D_MU)


def test_without_a_difference_the_law_is_the_middle_curve(case):
    law, values, sided, _ = case
    alike = (*values, 0.0, 0.0)
    np.testing.assert_allclose(sided.force(SLIP, LOAD, alike), law.force(SLIP, LOAD, values))
    assert middle_curve(sided, alike)[0] == law
    assert middle_curve(law, values) == (law, values)


def test_slopes_at_zero_and_peaks_have_the_stated_ratios(case):
    law, values, sided, apart = case
    driving = sided.slip_derivative(0.0, LOAD, apart)
    braking = sided.slip_derivative(-1e-12, LOAD, apart)
    assert np.log(driving / braking) == pytest.approx(D_K)
    assert driving * braking == pytest.approx(law.slip_derivative(0.0, LOAD, values) ** 2)
    tops = [
        abs(float(sided.force(at, LOAD, apart)))
        for at in (sided.peak_slip(LOAD, apart), braking_peak_slip(sided, LOAD, apart))
    ]
    assert np.log(tops[0] / tops[1]) == pytest.approx(D_MU)
    assert braking_peak_slip(law, LOAD, values) == -law.peak_slip(LOAD, values)


def test_the_slope_is_the_derivative_of_the_force_on_both_sides(case):
    _, _, sided, apart = case
    slip = SLIP[np.abs(SLIP) > 0.02]
    step = 1e-7
    change = sided.force(slip + step, LOAD, apart) - sided.force(slip - step, LOAD, apart)
    slope = sided.slip_derivative(slip, LOAD, apart)
    np.testing.assert_allclose(change / (2 * step), slope, rtol=1e-5, atol=1e-5)


def test_peaks_are_where_force_is_largest(case):
    law, values, sided, apart = case
    if np.isinf(law.peak_slip(LOAD, values)):
        assert sided.peak_slip(LOAD, apart) == np.inf
        return
    for at in (sided.peak_slip(LOAD, apart), braking_peak_slip(sided, LOAD, apart)):
        near = np.abs(sided.force(at * np.array([0.98, 1.0, 1.02]), LOAD, apart))
        assert np.argmax(near) == 1


def test_a_law_comes_back_from_its_name_and_options(case):
    law, _, sided, _ = case
    assert slip_law(sided.name, **law_options(sided)) == sided
    assert slip_law(law.name, **law_options(law)) == law


def test_walks_tabulate_the_middle_curve(case):
    law, values, sided, apart = case
    np.testing.assert_array_equal(
        law_table(sided, apart, weight=20.0).phi, law_table(law, values, weight=20.0).phi
    )
