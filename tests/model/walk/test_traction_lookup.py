# SPDX-License-Identifier: MIT
import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from model.leg import ROLLING
from model.slip.magic_formula import MagicFormula
from model.walk.traction import law_table
from model.walk.traction_lookup import hermite, load_row, table_value, traction_secant

SOURCE = np.array([34.34 * 1.564 * 0.3798, 1.564, 0.3798, 0.0066])
TABLE = law_table(MagicFormula("peak"), SOURCE, weight=21.3)


def test_the_secant_at_small_slip_is_stiffness_over_the_arcs_speed():
    load, flow = 7.0, 0.05
    secant = traction_secant(TABLE, ROLLING, load, 1e-9, flow)
    expected = SOURCE[0] * load / np.hypot(flow, TABLE.speed_scale)
    assert secant == pytest.approx(expected, rel=2e-3)


@given(load=st.floats(1e-6, 200.0), slip=st.floats(0.0, 1e7))
def test_a_table_is_finite_and_no_larger_than_the_peak_whatever_load_and_slip(load, slip):
    value = table_value(TABLE, load, slip)
    assert -1e-9 <= value <= SOURCE[2] * 1.001


def test_loads_between_rows_are_interpolated_and_loads_outside_take_the_nearest_row():
    loads = np.exp(TABLE.log_load)
    row, weight = load_row(TABLE, float(np.sqrt(loads[3] * loads[4])))
    assert (row, weight) == (3, pytest.approx(0.5))
    assert load_row(TABLE, float(loads[0] / 10)) == (0, 0.0)
    assert load_row(TABLE, float(loads[-1] * 10)) == (len(loads) - 2, 1.0)


@given(st.lists(st.floats(-1.0, 1.0), min_size=4, max_size=4), st.floats(0.0, 1.0))
def test_a_hermite_piece_is_the_cubic_it_was_made_of(coefficients, a):
    cubic, step = np.poly1d(coefficients), 0.3
    ends = np.array([0.0, step])
    found = hermite(cubic(ends), cubic.deriv()(ends), 0, a, step)
    assert found == pytest.approx(cubic(a * step), abs=1e-12)
