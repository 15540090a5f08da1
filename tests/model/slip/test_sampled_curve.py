# SPDX-License-Identifier: MIT
import numpy as np
import pytest
from hypothesis import assume, given, settings
from hypothesis import strategies as st

from model.errors import DomainError
from model.slip.magic_formula import magic_formula, peak_slip
from model.slip.sampled_curve import fitted_coefficients

GRID = np.linspace(0, 1, 62)


@settings(max_examples=20)
@given(st.floats(15, 60), st.floats(1.2, 1.8), st.floats(0.5, 50), st.floats(-3, 0.7))
def test_samples_of_a_formula_give_its_coefficients_back(B, C, D, E):
    assume(0.02 < peak_slip(B, C, E) < 0.3)
    found = fitted_coefficients(GRID, magic_formula(GRID, B, C, D, E))
    np.testing.assert_allclose(found.values, (B, C, D, E), rtol=1e-4, atol=1e-4)


def test_coefficients_scale_with_the_force_only_in_the_peak():
    force = magic_formula(GRID, 30.0, 1.5, 2.0, 0.3) + 0.01 * np.sin(40 * GRID)
    one, other = fitted_coefficients(GRID, force), fitted_coefficients(GRID, 1000 * force)
    expected = np.array(one.values) * (1, 1, 1000, 1)
    np.testing.assert_allclose(other.values, expected, rtol=1e-5)
    assert other.misfit == pytest.approx(1000 * one.misfit)


def test_what_samples_do_not_determine_has_an_infinite_error():
    slip = np.array([0.0, 0.5, 0.6, 0.7, 0.8, 0.9, 1.0])
    found = fitted_coefficients(slip, np.array([0.0, *[1.0] * 6]))
    assert np.isinf(found.errors[0]) or found.errors[0] > found.values[0]


def test_too_few_samples_are_refused():
    with pytest.raises(DomainError, match="four coefficients need 6"):
        fitted_coefficients(GRID[:5], GRID[:5])
