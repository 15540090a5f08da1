# SPDX-License-Identifier: MIT
import math

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from model.slip.coulomb import (
    CoulombStribeck,
    breakaway_slip,
    coulomb_stribeck,
    regularised_sign,
    stribeck_fall,
)

VALUES = (20.0, 0.4, 0.7, 0.1)
K = st.floats(1.0, 100.0)
MU = st.floats(0.05, 2.0)
Q = st.floats(0.05, 0.95)


@given(K, MU, Q)
def test_traction_far_out_is_kinetic_friction(k, mu, q):
    assert coulomb_stribeck(1e3, k, mu, q, 0.1) == pytest.approx(q * mu)


@given(K, MU)
def test_without_static_excess_traction_stays_at_friction(k, mu):
    past = breakaway_slip(k, mu) * np.array([1.0, 1.5, 10.0, 1e6])
    np.testing.assert_allclose(CoulombStribeck(False).force(past, 2.0, (k, mu)), 2.0 * mu)


def test_stiffer_regularisation_tends_to_the_sign_of_the_slip():
    np.testing.assert_array_equal(regularised_sign(np.array([-0.1, 0.0, 0.1]), 1e-9), [-1, 0, 1])


def test_stribeck_slip_is_where_all_but_one_over_e_of_the_excess_is_lost():
    left = stribeck_fall(0.03 + 0.1, kappa_c=0.03, kappa_s=0.1, q=0.7)
    assert left == pytest.approx(0.7 + 0.3 / math.e)


def test_locked_leg_with_infinite_slip_has_kinetic_friction_and_no_slope():
    law = CoulombStribeck()
    assert law.force(-math.inf, 2.0, VALUES) == pytest.approx(-2.0 * 0.28)
    assert law.slip_derivative(-math.inf, 2.0, VALUES) == 0.0
