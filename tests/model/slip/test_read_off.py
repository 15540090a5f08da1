# SPDX-License-Identifier: MIT
import numpy as np
import pytest
from hypothesis import assume, given, settings
from hypothesis import strategies as st

from model.errors import DomainError
from model.slip import Brush, magic_formula, read_off
from model.slip.magic_formula import peak_slip
from model.slip.read_off import initial_slope, shape_factor, stiffness_factor
from model.slip.thesis_curve import THESIS_LAW, THESIS_VALUES

THESIS_LOADS = (2.13, 6.63, 8.13, 12.75)  # N, Fig. 4-14
FAR = np.geomspace(1e-4, 1e3, 4000)
GRID = np.linspace(0, 1, 62)


@settings(max_examples=20)
@given(st.floats(15, 60), st.floats(1.2, 1.8), st.floats(0.5, 50), st.floats(-3, 0.7))
def test_samples_of_a_formula_give_its_coefficients_back(B, C, D, E):
    assume(0.02 < peak_slip(B, C, E) < 0.3)
    read = read_off(GRID, magic_formula(GRID, B, C, D, E))
    np.testing.assert_allclose((read.B, read.C, read.D, read.E), (B, C, D, E), 1e-4, 1e-4)


@given(st.floats(1.0, 1.999))
def test_eq_4_25_inverts_the_asymptote(C):
    assert shape_factor(np.sin(np.pi * C / 2), 1.0) == pytest.approx(C, abs=1e-7)


def test_without_the_lost_leading_one_the_shape_would_have_no_peak():
    assert shape_factor(0.6326, 1.0) - 1 < 1 < shape_factor(0.6326, 1.0)


@given(st.floats(5, 60), st.floats(1.1, 1.9), st.floats(0.5, 50))
def test_eq_4_26_inverts_the_slope_at_zero_slip(B, C, D):
    assert stiffness_factor(B * C * D, C, D) == pytest.approx(B)


def test_initial_slope_needs_no_peak():
    slip = np.linspace(0, 0.03, 40)
    found = initial_slope(slip, magic_formula(slip, 34.34, 1.564, 2.5, 0.0))
    assert found == pytest.approx(34.34 * 1.564 * 2.5, rel=1e-3)


@pytest.mark.parametrize("reach", [0.01, 0.04])
def test_curve_that_ends_before_its_peak_is_refused(reach):
    slip = np.linspace(0, reach, 50)
    with pytest.raises(DomainError, match=f"no peak within slip 0 to {reach}"):
        read_off(slip, magic_formula(slip, 34.34, 1.564, 2.5, 0.0))


def test_curve_without_a_peak_is_refused():
    with pytest.raises(DomainError, match="fit a law without a peak"):
        read_off(FAR, Brush().force(FAR, 5.0, (20.0, 0.4)) * (1 + 1e-9 * FAR))


def test_curve_that_ends_just_behind_its_peak_is_refused():
    slip = np.linspace(0, 0.06, 100)
    with pytest.raises(DomainError, match="twice the peak's slip"):
        read_off(slip, magic_formula(slip, 34.34, 1.564, 2.5, 0.0))


@pytest.mark.parametrize("load", THESIS_LOADS)
def test_the_grid_of_the_thesis_gives_its_coefficients_at_each_of_its_loads(load):
    slip = GRID
    B, C, D, E = (float(x) for x in THESIS_LAW.coefficients(load, THESIS_VALUES))
    read = read_off(slip, magic_formula(slip, B, C, D, E))
    np.testing.assert_allclose((read.B, read.C, read.D, read.E), (B, C, D, E), rtol=1e-6)
    assert read.misfit < 1e-9


def test_standard_errors_of_a_coarse_grid_are_those_of_repeated_measurements():
    slip, rng = np.linspace(0, 1, 62), np.random.default_rng(8)
    truth = magic_formula(slip, 34.34, 1.564, 4.84, 0.797)
    read = [read_off(slip, truth + 0.01 * rng.standard_normal(62)) for _ in range(25)]
    scatter = np.std([(each.B, each.C, each.D, each.E) for each in read], axis=0)
    stated = np.mean([each.errors for each in read], axis=0)
    np.testing.assert_allclose(stated, scatter, rtol=0.5)
    assert np.mean([each.misfit for each in read]) == pytest.approx(0.01, rel=0.1)


def test_slope_at_zero_slip_needs_samples_of_the_rise():
    slip = np.linspace(0, 1, 40)
    with pytest.raises(DomainError, match="measure smaller slip ratios"):
        initial_slope(slip, magic_formula(slip, 34.34, 1.564, 2.5, 0.0))


def test_five_samples_are_too_few_for_least_squares():
    slip = np.array([0.0, 0.1, 0.2, 0.6, 1.0])
    with pytest.raises(DomainError, match="5 samples of a curve"):
        read_off(slip, magic_formula(slip, 34.34, 1.564, 4.84, 0.8))


@pytest.mark.parametrize(
    ("slip", "force", "message"),
    [
        ([0.0, 0.1], [0.0], "one curve is two arrays"),
        ([0.0, np.nan, 0.2], [0.0, 1.0, 1.0], "NaN or infinite"),
        ([0.0, 0.2, 0.1], [0.0, 1.0, 1.0], "found 3 slip ratios; .* increasing from zero"),
        ([-0.1, 0.0, 0.1], [-1.0, 0.0, 1.0], "increasing from zero"),
    ],
)
def test_what_is_no_curve_is_refused(slip, force, message):
    with pytest.raises(DomainError, match=message):
        read_off(slip, force)
