# SPDX-License-Identifier: MIT
import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from model.errors import DomainError
from model.gait.steering import TripodAngles, tripod_reference
from model.gait.suriana import suriana_reference

DOWN, UP = np.radians(35.0), np.radians(130.0)  # 5-2-4
TIME = st.floats(0.1, 3.0)
DIRECTION = st.sampled_from(["left", "right"])


@given(TIME, TIME, TIME, DIRECTION)
def test_speeds_are_those_of_eq_5_1_to_5_4(ground, flight, turn, direction):
    legs = suriana_reference(
        DOWN, UP, ground_time=ground, flight_time=flight, turn_time=turn, direction=direction
    )
    stance = UP - DOWN
    inner = np.isin(np.arange(6), legs.inner)
    np.testing.assert_allclose(
        legs.ground_speed, np.where(inner, stance / (ground + turn), stance / ground)
    )
    np.testing.assert_allclose(
        legs.flight_speed,
        np.where(inner, (2 * np.pi - stance) / flight, (2 * np.pi - stance) / (flight + turn)),
    )
    assert legs.period == pytest.approx(ground + flight + turn)


@given(TIME, TIME, TIME, DIRECTION)
def test_legs_start_as_in_the_listing(ground, flight, turn, direction):
    legs = suriana_reference(
        DOWN, UP, ground_time=ground, flight_time=flight, turn_time=turn, direction=direction
    )
    np.testing.assert_allclose(legs.angles(0.0)[0], [DOWN, UP, UP, DOWN, DOWN, UP])


@given(st.floats(0.0, 10.0))
def test_without_turn_time_it_is_the_straight_tripod(t):
    legs = suriana_reference(DOWN, UP, ground_time=0.8, flight_time=0.8)
    straight = tripod_reference(TripodAngles(DOWN, UP, DOWN, UP), 1.6)
    np.testing.assert_allclose(legs.angles(t), straight.angles(t), atol=1e-9)
    assert legs.inner == ()


def test_negative_turn_time_is_refused():
    with pytest.raises(DomainError, match="choose the side with direction"):
        suriana_reference(DOWN, UP, ground_time=0.8, flight_time=0.8, turn_time=-0.1)
