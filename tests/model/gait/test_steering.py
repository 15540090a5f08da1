# SPDX-License-Identifier: MIT
import tomllib
from pathlib import Path

import numpy as np
import pytest
from hypothesis import assume, given
from hypothesis import strategies as st

from model.errors import DomainError
from model.gait.steering import (
    TripodAngles,
    ideal_liftoff,
    largest_steering_factor,
    solve_outer_touchdown,
    tripod_angles,
    tripod_reference,
)
from model.leg import hip_height, lowest_angle

FILE = Path(__file__).parents[3] / "datasets" / "thesis" / "tables.toml"
TABLES = tomllib.loads(FILE.read_text(encoding="utf-8"))
TURNS = [f"table_5_{number}" for number in range(1, 6)]
ARC = st.floats(np.radians(120.0), np.radians(260.0))
STEERING = st.floats(0.8, 1.8)
TOUCHDOWN = st.floats(0.2, 0.95)


def height(theta, arc=np.pi):
    """Compute the height of the hip above the ground, over the leg's radius."""
    return hip_height(lowest_angle(np.asarray(theta), 0.0, 0.0), 1.0, arc - np.pi)


@pytest.mark.parametrize("name", TURNS)
def test_simulation_columns_come_out_to_the_printed_digits(name):
    printed = TABLES[name]["simulated"]
    degrees = "inner_touchdown_deg" in printed
    inner = printed["inner_touchdown_deg" if degrees else "inner_touchdown"]
    angles = tripod_angles(np.radians(inner) if degrees else inner, TABLES[name]["steering_factor"])
    for key, value in printed.items():
        found = getattr(angles, key.removesuffix("_deg"))
        rounded = round(np.degrees(found), 1) if degrees else round(found, 4)
        assert rounded == pytest.approx(value, abs=5e-5)


def test_longer_leg_has_the_angles_that_its_heights_ask_for():
    angles = tripod_angles(np.radians(50.0), 1.1, leg_arc=np.radians(200.0))
    found = np.degrees([angles.inner_liftoff, angles.outer_touchdown, angles.outer_liftoff])
    np.testing.assert_allclose(found, [126.2796, 45.5885, 129.4961], atol=5e-5)


@given(ARC, st.floats(0.001, 0.999))
def test_hip_is_as_high_at_liftoff_as_at_touchdown(arc, share):
    down = -np.pi / 2 + share * (np.pi / 2 + min(np.pi / 2, arc / 2))
    up = ideal_liftoff(down, arc)
    assert up > down
    np.testing.assert_allclose(height(up, arc), height(down, arc), atol=1e-9)


@given(ARC)
def test_stance_angle_falls_with_touchdown_from_its_limit_to_zero(arc):
    highest = min(np.pi / 2, arc / 2)
    down = np.linspace(-np.pi / 2, highest, 400)[1:-1]
    stance = ideal_liftoff(down, arc) - down
    assert np.all(np.diff(stance) < 0)
    assert stance[0] == pytest.approx(np.pi + arc / 2, abs=0.03)
    limit = ideal_liftoff(highest - 1e-9, arc) - highest
    assert limit == pytest.approx(0.0, abs=1e-3)


@given(TOUCHDOWN, STEERING, ARC)
def test_outer_side_has_the_steering_factor_and_equal_heights(inner, steering, arc):
    assume(steering < largest_steering_factor(inner, arc) - 1e-6)
    angles = tripod_angles(inner, steering, leg_arc=arc)
    assert angles.steering_factor == pytest.approx(steering, abs=1e-9)
    np.testing.assert_allclose(
        height(angles.outer_liftoff, arc), height(angles.outer_touchdown, arc), atol=1e-9
    )


def test_largest_steering_factor_is_where_solutions_end():
    inner = np.radians(50.0)
    largest = largest_steering_factor(inner)
    assert solve_outer_touchdown(inner, largest * (1 - 1e-6)) == pytest.approx(-np.pi / 2, abs=1e-2)
    with pytest.raises(
        DomainError, match=r"no solution .* at 50 degrees; expected less than 3\.971"
    ):
        solve_outer_touchdown(inner, largest)


@pytest.mark.parametrize("steering", [0.0, -1.0, np.nan])
def test_steering_factor_that_is_not_positive_is_refused(steering):
    with pytest.raises(DomainError, match="expected more than zero"):
        tripod_angles(0.8, steering)


@pytest.mark.parametrize("touchdown", [-np.pi / 2, np.pi / 2, 3.0, np.nan])
def test_touchdown_without_an_equal_height_later_is_refused(touchdown):
    with pytest.raises(DomainError, match="above -90 and below 90"):
        ideal_liftoff(touchdown)


@pytest.mark.parametrize("name", TURNS[2:])
def test_measured_angles_stand_where_they_are_given(name):
    steering, printed = TABLES[name]["steering_factor"], TABLES[name]["measured"]
    given_deg = {key.removesuffix("_deg"): np.radians(value) for key, value in printed.items()}
    angles = tripod_angles(
        given_deg["inner_touchdown"],
        steering,
        inner_liftoff=given_deg["inner_liftoff"],
        outer_touchdown=given_deg["outer_touchdown"],
        outer_liftoff=given_deg["outer_liftoff"],
    )
    assert angles == TripodAngles(**given_deg)


def test_liftoff_before_touchdown_is_refused_with_its_side():
    with pytest.raises(DomainError, match="outer legs touch down at 60 and lift off at 40 degrees"):
        tripod_angles(
            np.radians(50.0), outer_touchdown=np.radians(60.0), outer_liftoff=np.radians(40.0)
        )


@pytest.mark.parametrize("direction", ["left", "right"])
def test_legs_start_as_in_the_listing(direction):
    angles = tripod_angles(0.8, 1.2)
    inner = (angles.inner_touchdown, angles.inner_liftoff)
    outer = (angles.outer_touchdown, angles.outer_liftoff)
    left, right = (inner, outer) if direction == "left" else (outer, inner)
    expected = [left[0], right[1], left[1], right[0], left[0], right[1]]
    legs = tripod_reference(angles, 2.0, direction=direction)
    np.testing.assert_array_equal(legs.angles(0.0)[0], expected)


@given(st.floats(0.0, 10.0), STEERING)
def test_right_turn_is_the_mirror_image_of_a_left_one_half_a_cycle_later(t, steering):
    angles = tripod_angles(0.8, steering)
    left = tripod_reference(angles, 2.0, direction="left").mirrored().angles(t + 1.0)[0]
    right = tripod_reference(angles, 2.0, direction="right").angles(t)[0]
    turns = (left - right) / (2 * np.pi)
    np.testing.assert_allclose(turns, np.round(turns), atol=1e-9)


@given(TOUCHDOWN, st.floats(1.0, 1.8), st.floats(0.5, 4.0))
def test_speeds_are_those_of_eq_2_20_and_2_21(inner, steering, cycle):
    angles = tripod_angles(inner, steering)
    legs = tripod_reference(angles, cycle)
    stance = np.array([angles.inner_liftoff - inner, angles.outer_liftoff - angles.outer_touchdown])
    np.testing.assert_allclose(legs.ground_speed[:2], stance / (cycle / 2))
    np.testing.assert_allclose(legs.flight_speed[:2], (2 * np.pi - stance) / (cycle / 2))
    np.testing.assert_allclose(legs.ground_speed[1] / legs.ground_speed[0], steering)


def test_unknown_direction_is_refused():
    with pytest.raises(DomainError, match="'up'; expected 'left' or 'right'"):
        tripod_reference(tripod_angles(0.8), 2.0, direction="up")
