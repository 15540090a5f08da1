# SPDX-License-Identifier: MIT
"""Every value of a covariate gives a similar copy of the curve at the reference."""

import numpy as np
import pytest

from model.slip import Brush, CoulombStribeck, MagicFormula
from model.slip.covariate import Covariate, CovariateLaw, law_at, reference_law
from model.slip.laws import law_options, slip_law
from model.slip.sided import SidedLaw, braking_peak_slip, middle_curve
from model.walk.traction import law_table

PRESSURE = Covariate("pressure", "kPa", reference=80.0, scale=0.2)
CASES = [
    (MagicFormula(), (20.0, 1.5, 0.4, 0.0066)),
    (Brush(kinetic=True), (20.0, 0.4, 0.7)),
    (CoulombStribeck(), (20.0, 0.4, 0.7, 0.1)),
    (SidedLaw(MagicFormula("constant")), (20.0, 1.5, 0.4, -0.5, 0.2, -0.1)),
]
OWN = (-0.1, 0.3, -0.05, 0.02)  # friction and stiffness, then those of the square
SLIP, LOAD = np.linspace(-0.5, 0.5, 101), 8.0


@pytest.fixture(params=CASES, ids=lambda case: repr(case[0]))
def case(request):
    law, values = request.param
    return law, values, CovariateLaw(law, PRESSURE, 2), (*values, *OWN)


def test_the_coordinate_is_that_of_the_logarithm():
    assert PRESSURE.coordinate(80.0) == 0
    assert PRESSURE.coordinate(80 * np.exp(0.2)) == pytest.approx(1)
    assert PRESSURE.value(PRESSURE.coordinate(61.0)) == pytest.approx(61)


def test_without_a_value_the_law_is_that_at_the_reference(case):
    law, values, following, every = case
    for each in (following, law_at(following, np.zeros(len(SLIP)))):
        np.testing.assert_allclose(each.force(SLIP, LOAD, every), law.force(SLIP, LOAD, values))
    assert reference_law(following, every) == (law, values)
    assert reference_law(law, values) == (law, values)
    assert law_at(law, np.ones(3)) is law


@pytest.mark.parametrize("z", [-1.0, 0.7])
def test_a_copy_is_the_same_law_with_other_values(case, z):
    law, _, following, every = case
    there = law_at(following, np.array([z])).force(SLIP, LOAD, every)
    copied = following.copied_values(np.array([every]), z)[0]
    np.testing.assert_allclose(law.force(SLIP, LOAD, tuple(copied)), there, rtol=1e-12)


@pytest.mark.parametrize("z", [-1.0, 0.7])
def test_friction_and_stiffness_grow_as_their_polynomials_say(case, z):
    law, values, following, every = case
    there = law_at(following, np.array([z]))
    friction, stiffness = np.exp(OWN[0] * z + OWN[2] * z**2), np.exp(OWN[1] * z + OWN[3] * z**2)
    slope, usual = (each.slip_derivative(0.0, LOAD, v)
                    for each, v in ((there, every), (law, values)))  # fmt: skip
    assert slope == pytest.approx(stiffness * usual)
    top = there.force(there.peak_slip(LOAD, every), LOAD, every)
    assert top == pytest.approx(friction * law.force(law.peak_slip(LOAD, values), LOAD, values))


def test_the_slope_is_the_derivative_of_the_force_at_each_points_own_value(case):
    _, _, following, every = case
    slip = SLIP[np.abs(SLIP) > 0.02]
    there, step = law_at(following, np.linspace(-1, 1, len(slip))), 1e-7
    change = there.force(slip + step, LOAD, every) - there.force(slip - step, LOAD, every)
    np.testing.assert_allclose(
        change / (2 * step), there.slip_derivative(slip, LOAD, every), rtol=1e-5, atol=1e-5
    )


def test_a_law_is_stored_and_walked_with_at_the_reference(case):
    law, values, following, every = case
    assert slip_law(following.name, **law_options(following)) == following
    assert middle_curve(following, every) == middle_curve(law, values)
    assert braking_peak_slip(following, LOAD, every) == braking_peak_slip(law, LOAD, values)
    np.testing.assert_array_equal(
        law_table(following, every, weight=20.0).phi, law_table(law, values, weight=20.0).phi
    )
