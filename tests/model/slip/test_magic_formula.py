# SPDX-License-Identifier: MIT
import math

import numpy as np
import pytest
from hypothesis import assume, given
from hypothesis import strategies as st

from model.slip.magic_formula import (
    MagicFormula,
    curvature_from_peak,
    magic_formula,
    peak_slip,
)

SOURCE = {"B": 34.34, "C": 1.564}  # Eq. (4-45)
THESIS_LOADS = (2.13, 6.63, 8.13, 12.75)
THESIS_FRICTION, THESIS_PEAK_PER_LOAD = 0.3798, 0.0066  # Listing A.20
THESIS_VALUES = (
    SOURCE["B"] * SOURCE["C"] * THESIS_FRICTION,
    SOURCE["C"],
    THESIS_FRICTION,
    THESIS_PEAK_PER_LOAD,
)

B_RANGE, C_RANGE, E_RANGE = st.floats(1, 100), st.floats(1.02, 1.98), st.floats(-50, 0.99)


@given(B_RANGE, C_RANGE, E_RANGE)
def test_curve_settles_at_d_sin_of_half_pi_c(B, C, E):
    far = magic_formula(1e9, B, C, 2.5, E)
    assert far == pytest.approx(2.5 * math.sin(C * math.pi / 2), abs=1e-5)


@given(B_RANGE, C_RANGE, E_RANGE)
def test_eq_4_27_gives_back_the_curvature_at_its_peak_slip(B, C, E):
    x_m = peak_slip(B, C, E)
    assume(x_m < 1e3)  # further out (C near 1 with E near 1) Bx - atan Bx has lost its digits
    assert curvature_from_peak(B, C, x_m) == pytest.approx(E, rel=1e-6, abs=1e-6)


@given(B_RANGE, C_RANGE, E_RANGE)
def test_peak_force_is_d_for_curvature_below_one(B, C, E):
    assert magic_formula(peak_slip(B, C, E), B, C, 2.5, E) == pytest.approx(2.5)


def test_peak_slip_is_infinite_where_the_curve_only_rises():
    assert np.all(np.isinf(peak_slip(20.0, np.array([0.7, 1.0]), -0.5)))


def test_peak_slip_is_infinite_where_curvature_one_keeps_the_curve_below_its_peak():
    assert peak_slip(20.0, 1.3, 1.0) == math.inf


def test_curvature_above_one_turns_the_force_round():
    assert magic_formula(10.0, 34.34, 1.564, 1.0, 1.2) < 0


@pytest.mark.parametrize("load", THESIS_LOADS)
def test_source_curve_peaks_where_its_listing_says(load):
    law = MagicFormula()
    assert law.peak_slip(load, THESIS_VALUES) == pytest.approx(THESIS_PEAK_PER_LOAD * load)
    found = law.coefficients(load, THESIS_VALUES)[:3]
    np.testing.assert_allclose(found, (SOURCE["B"], SOURCE["C"], THESIS_FRICTION * load))


@given(st.floats(1e-3, 1e4))
def test_source_shape_keeps_curvature_below_one_at_every_load(load):
    assert MagicFormula().valid(load, THESIS_VALUES)


def test_shape_just_above_the_source_lets_curvature_pass_one_at_high_load():
    K, _, mu, x_m = THESIS_VALUES
    limit = math.pi / (2 * math.atan(math.pi / 2))
    assert limit == pytest.approx(1.56472, abs=1e-5)
    assert MagicFormula().valid(1e6, (K, limit - 1e-5, mu, x_m))
    assert not MagicFormula().valid(1e6, (K, limit + 1e-5, mu, x_m))


def test_curvature_falls_without_bound_as_load_vanishes():
    E = MagicFormula().coefficients(np.array([1.0, 1e-2, 1e-4]), THESIS_VALUES)[3]
    assert np.all(np.diff(E) < 0)
    assert E[-1] < -1e12


@pytest.mark.parametrize("x", [1e-12, 1e-6, 0.0099, 0.0101])
def test_curvature_keeps_its_digits_at_the_smallest_loads(x):
    exact = x**3 * (1 / 3 - x**2 / 5 + x**4 / 7 - x**6 / 9 + x**8 / 11)
    expected = (x - math.tan(math.pi / 3)) / exact
    assert curvature_from_peak(1.0, 1.5, x) == pytest.approx(expected, rel=1e-11)


def test_load_sensitivity_scales_friction_and_stiffness_by_powers_of_load():
    plain, sensitive = MagicFormula("constant"), MagicFormula("constant", True, 5.0)
    values = (20.0, 1.5, 0.4, -0.2)
    at_reference = sensitive.force(0.05, 5.0, (*values, -0.1, 0.2))
    assert at_reference == pytest.approx(plain.force(0.05, 5.0, values))
    doubled = (20.0 * 2**0.2, 1.5, 0.4 * 2**-0.1, -0.2)
    at_double = sensitive.force(0.05, 10.0, (*values, -0.1, 0.2))
    assert at_double == pytest.approx(plain.force(0.05, 10.0, doubled))


def test_fixed_curvature_equals_the_same_constant_one():
    fixed, constant = MagicFormula(curvature=-0.3), MagicFormula(curvature="constant")
    slip = np.linspace(-1, 1, 11)
    np.testing.assert_array_equal(
        fixed.force(slip, 4.0, (20.0, 1.5, 0.4)), constant.force(slip, 4.0, (20.0, 1.5, 0.4, -0.3))
    )
