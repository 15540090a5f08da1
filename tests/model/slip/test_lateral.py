# SPDX-License-Identifier: MIT
import math

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from model.slip import MagicFormula, lateral_slip, slip_angle

SPEED = st.floats(1e-6, 10.0)
SIGNED = st.floats(-10.0, 10.0)
VALUES = (20.4, 1.564, 0.3798, 0.0066)


@given(SPEED, SIGNED)
def test_force_opposes_sideways_sliding_while_moving_forward(v_x, v_y):
    force = MagicFormula().force(lateral_slip(slip_angle(v_x, v_y)), 5.0, VALUES)
    assert force * v_y <= 0


@given(SPEED, SIGNED)
def test_slip_angle_is_the_listings_arctangent(v_x, v_y):
    assert slip_angle(v_x, v_y) == pytest.approx(math.atan(-v_y / v_x))
    assert slip_angle(-v_x, v_y) == pytest.approx(math.atan(-v_y / -v_x))


@given(SPEED)
def test_slip_angle_tends_to_a_right_angle_as_forward_speed_vanishes(v_y):
    assert slip_angle(1e-15, v_y) == pytest.approx(-math.pi / 2)
    assert slip_angle(0.0, v_y) == pytest.approx(-math.pi / 2)
    assert slip_angle(-0.0, -v_y) == pytest.approx(math.pi / 2)


def test_lateral_slip_maps_a_right_angle_to_one():
    np.testing.assert_allclose(lateral_slip([-math.pi / 2, 0.0, math.pi / 2]), [-1.0, 0.0, 1.0])


@given(SPEED, SPEED)
def test_for_a_contact_moving_backwards_the_force_points_along_the_sliding(v_x, v_y):
    """The thesis's fault, kept: its arctangent cannot tell forwards from backwards."""
    assert slip_angle(-v_x, v_y) > 0
