# SPDX-License-Identifier: MIT
import math

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from model.slip.brush import Brush, brush, sliding_share, static_friction_from_peak

K = st.floats(1.0, 100.0)
MU = st.floats(0.05, 2.0)
Q = st.floats(0.05, 0.95)
SLIP = st.floats(-1.0, 1.0)


def bristle_by_bristle(sigma, k, mu_s, q, bristles=20_000):
    """Sum the patch's bristles under a parabolic pressure, each stuck or sliding."""
    way = (np.arange(bristles) + 0.5) / bristles
    pressure = 6 * way * (1 - way)
    bent = 2 * k * abs(sigma) * way
    each = np.where(bent <= mu_s * pressure, bent, q * mu_s * pressure)
    return math.copysign(each.mean(), sigma)


@given(SLIP, K, MU, Q)
def test_closed_form_is_the_sum_over_bristles(sigma, k, mu_s, q):
    expected = bristle_by_bristle(sigma, k, mu_s, q)
    assert brush(sigma, k, mu_s, q) == pytest.approx(expected, abs=3e-4 * mu_s)


@given(SLIP, K, MU)
def test_one_friction_gives_pacejkas_cubic(sigma, k, mu):
    psi = sliding_share(sigma, k, mu)
    cubic = math.copysign(mu * (3 * psi - 3 * psi**2 + psi**3), sigma)
    assert brush(sigma, k, mu) == pytest.approx(cubic, abs=1e-12)


@given(K, MU)
def test_full_sliding_begins_at_three_mu_over_k(k, mu):
    edge = 3 * mu / k
    assert sliding_share(0.999 * edge, k, mu) < 1
    assert brush(np.array([1.0, 2.0, 1e6]) * edge, k, mu) == pytest.approx([mu] * 3)


@given(MU, Q)
def test_traction_far_out_is_kinetic_friction_and_below_the_peak(mu, q):
    far = Brush(kinetic=True).force(1e3, 1.0, (20.0, mu, q))
    assert far == pytest.approx(q * static_friction_from_peak(mu, q))
    assert far < mu


@given(MU)
def test_equal_frictions_peak_at_static_friction(mu):
    assert static_friction_from_peak(mu, 1.0) == pytest.approx(mu)


def test_brush_with_one_friction_has_no_peak():
    assert Brush().peak_slip(3.0, (20.0, 0.4)) == math.inf


def test_locked_leg_with_infinite_slip_slides():
    assert Brush().force(-math.inf, 2.0, (20.0, 0.4)) == pytest.approx(-0.8)
