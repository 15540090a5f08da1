# SPDX-License-Identifier: MIT
import math

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from model.slip.brush import Brush, brush, sliding_share

K = st.floats(1.0, 100.0)
MU = st.floats(0.05, 2.0)
SLIP = st.floats(-1.0, 1.0)


def bristle_by_bristle(sigma, k, mu, bristles=20_000):
    """Sum the patch's bristles under a parabolic pressure, each stuck or sliding."""
    way = (np.arange(bristles) + 0.5) / bristles
    pressure = 6 * way * (1 - way)
    each = np.minimum(2 * k * abs(sigma) * way, mu * pressure)
    return math.copysign(each.mean(), sigma)


@given(SLIP, K, MU)
def test_closed_form_is_the_sum_over_bristles(sigma, k, mu):
    assert brush(sigma, k, mu) == pytest.approx(bristle_by_bristle(sigma, k, mu), abs=3e-4 * mu)


@given(K, MU)
def test_full_sliding_begins_at_three_mu_over_k(k, mu):
    edge = 3 * mu / k
    assert sliding_share(0.999 * edge, k, mu) < 1
    assert brush(np.array([1.0, 2.0, 1e6]) * edge, k, mu) == pytest.approx([mu] * 3)


def test_traction_never_falls():
    assert Brush().peak_slip(3.0, (20.0, 0.4)) == math.inf


def test_locked_leg_with_infinite_slip_slides():
    assert Brush().force(-math.inf, 2.0, (20.0, 0.4)) == pytest.approx(-0.8)
