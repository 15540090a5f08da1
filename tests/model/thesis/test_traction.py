# SPDX-License-Identifier: MIT
import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from model.slip import CoulombStribeck, MagicFormula
from model.thesis.traction import (
    THESIS_TRACTION,
    law_traction,
    load_derivative,
    table_traction,
    traction_force,
)
from model.walk.traction import VelocityCoulomb

WEIGHT = 2.17 * 9.81
B, C, MU, PEAK = 34.34, 1.564, 0.3798, 0.0066
VALUES = np.array([B * C * MU, C, MU, PEAK])
SLIP = st.floats(-100.0, 100.0)
LOAD = st.floats(1e-12, 2 * WEIGHT)


@given(SLIP, LOAD)
def test_the_sources_law_is_the_magic_formula_of_the_slip_package(kappa, load):
    expected = MagicFormula("peak").force(kappa, load, VALUES)
    assert traction_force(THESIS_TRACTION, kappa, load) == pytest.approx(expected, rel=1e-9)


def test_a_magic_formula_with_the_sources_values_is_the_sources_law():
    prepared = law_traction(MagicFormula("peak"), VALUES, weight=WEIGHT)
    assert prepared[:5] == pytest.approx(THESIS_TRACTION[:5])


@given(SLIP)
def test_force_vanishes_with_load_though_the_curvature_runs_away(kappa):
    for load in (1e-3, 1e-9, 1e-30, 1e-150, 0.0):
        force = traction_force(THESIS_TRACTION, kappa, load)
        assert abs(force) <= MU * load


@given(st.floats(0.05, 20.0), st.floats(0.5, WEIGHT))
def test_other_laws_are_followed_through_their_table(kappa, load):
    law, values = CoulombStribeck(), np.array([20.0, 0.4, 0.7, 0.1])
    table = law_traction(law, values, weight=WEIGHT)
    expected = law.force(kappa, load, values)
    assert not table.exact
    assert traction_force(table, kappa, load) == pytest.approx(expected, rel=2e-3)
    assert traction_force(table, -kappa, load) == -traction_force(table, kappa, load)


def test_coulomb_friction_by_velocity_keeps_its_scale():
    table = table_traction(VelocityCoulomb(0.38, 0.002).table(weight=WEIGHT))
    assert table.table.by_velocity
    assert traction_force(table, 1.0, 10.0) == pytest.approx(0.38 * 10.0 / np.sqrt(2), rel=1e-6)


@given(st.floats(-2.0, 2.0), st.floats(0.1, WEIGHT))
def test_the_derivative_with_respect_to_load_is_one(kappa, load):
    h = 1e-4 * load
    ahead, behind = (traction_force(THESIS_TRACTION, kappa, load + d) for d in (h, -h))
    force = traction_force(THESIS_TRACTION, kappa, load)
    slope = load_derivative(THESIS_TRACTION, kappa, load, force)
    assert slope == pytest.approx((ahead - behind) / (2 * h), abs=1e-4)
