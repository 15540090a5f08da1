# SPDX-License-Identifier: MIT
import numpy as np
import pytest
from hypothesis import assume, given
from hypothesis import strategies as st

from model.compiled import compiled
from model.frames import attitude, rotation_y, thesis_attitude
from model.leg import (
    HIP,
    ROLLING,
    TOE,
    contact_angle,
    contact_in_body,
    hip_height,
    hip_height_acceleration,
    hip_height_rate,
    leg_state,
    lowest_angle,
    plane_cosine,
    thesis_lowest_angle,
    thesis_lowest_angle_rate,
    thesis_tilt,
    thesis_tilt_rate,
    wrap_angle,
)

R = 0.035
TILT = st.floats(-0.5, 0.5)
THETA = st.floats(-7.0, 20.0)
YAW = st.floats(-7.0, 7.0)
PHI = st.floats(-3.14, 3.14)
BEYOND = st.floats(0.0, 0.6)


def arc_heights(theta, rotation, toe_beyond=0.0, n=4001):
    """Heights over the hip of points along the leg's arc, from toe to hip."""
    phi = np.linspace(-toe_beyond, np.pi, n)
    points = R * np.stack([1 + np.cos(phi), 0 * phi, -np.sin(phi)])
    return phi, (rotation @ rotation_y(theta) @ points)[2]


@given(THETA, TILT, TILT, YAW)
def test_phi_min_satisfies_eq_3_21_and_3_23(theta, roll, pitch, yaw):
    rotation = thesis_attitude(roll, pitch, yaw) @ rotation_y(theta)
    phi = thesis_lowest_angle(theta, thesis_tilt(roll, pitch, yaw))
    slope = rotation[2] @ [-np.sin(phi), 0.0, -np.cos(phi)]
    curvature = rotation[2] @ [-np.cos(phi), 0.0, np.sin(phi)]
    assert slope == pytest.approx(0.0, abs=1e-12)
    assert curvature > 0


@given(THETA, TILT, YAW)
def test_without_pitch_phi_min_is_that_of_the_printed_tangent(theta, roll, yaw):
    phi = thesis_lowest_angle(theta, thesis_tilt(roll, 0.0, yaw))
    X = np.tan(roll) * np.sin(yaw)
    rise, run = 1 + np.tan(theta) * X, np.tan(theta) - X
    assert np.sin(phi) * run == pytest.approx(np.cos(phi) * rise, rel=1e-6, abs=1e-6)


@given(TILT, YAW, st.floats(-3, 3), st.floats(-3, 3))
def test_without_pitch_the_rate_is_the_printed_one(roll, yaw, roll_rate, yaw_rate):
    printed = roll_rate * np.sin(yaw) * (1 + np.tan(roll) ** 2)
    printed += yaw_rate * np.tan(roll) * np.cos(yaw)
    rate = thesis_tilt_rate(roll, 0.0, yaw, roll_rate, 0.0, yaw_rate)
    assert rate == pytest.approx(printed, abs=1e-12)


@given(THETA, TILT, TILT, YAW, st.lists(st.floats(-3, 3), min_size=4, max_size=4))
def test_the_rate_of_phi_min_is_its_derivative(theta, roll, pitch, yaw, rates):
    h = 1e-6

    def phi(t):
        tilt = thesis_tilt(roll + rates[0] * t, pitch + rates[1] * t, yaw + rates[2] * t)
        return thesis_lowest_angle(theta + rates[3] * t, tilt)

    tilt_rate = thesis_tilt_rate(roll, pitch, yaw, *rates[:3])
    rate = thesis_lowest_angle_rate(rates[3], thesis_tilt(roll, pitch, yaw), tilt_rate)
    assert wrap_angle(phi(h) - phi(-h)) / (2 * h) == pytest.approx(rate, abs=1e-6)


@given(THETA, TILT, TILT, YAW)
def test_the_lowest_angle_is_the_circles_lowest_point_at_any_heading(theta, roll, pitch, yaw):
    rotation = attitude(roll, pitch, yaw) @ rotation_y(theta)
    phi = lowest_angle(theta, roll, pitch)
    assert rotation[2] @ [-np.sin(phi), 0.0, -np.cos(phi)] == pytest.approx(0.0, abs=1e-12)
    assert rotation[2] @ [-np.cos(phi), 0.0, np.sin(phi)] > 0
    printed = np.pi / 2 - theta - np.arctan(np.tan(pitch) / np.cos(roll))
    assert wrap_angle(phi - printed) == pytest.approx(0.0, abs=1e-12)


@given(THETA, TILT, TILT, BEYOND)
def test_no_point_of_the_arc_is_below_the_contact(theta, roll, pitch, toe_beyond):
    phi = lowest_angle(theta, roll, pitch)
    contact = contact_angle(phi, toe_beyond)
    _, heights = arc_heights(theta, attitude(roll, pitch, 0.3), toe_beyond)
    x, z = contact_in_body(theta, contact, R)
    lowest = (attitude(roll, pitch, 0.3) @ [x, 0.0, z])[2]
    assert lowest <= heights.min() + 1e-12
    assert lowest == pytest.approx(heights.min(), abs=2e-8)
    height = hip_height(phi, R, toe_beyond) * plane_cosine(roll, pitch)
    assert height == pytest.approx(-lowest, abs=1e-12)


@pytest.mark.parametrize(
    ("phi", "state"), [(0.0, ROLLING), (3.0, ROLLING), (-1e-9, TOE), (-1.57, TOE), (-1.58, HIP)]
)
def test_states_of_a_half_circle_are_those_of_section_3_4_1(phi, state):
    assert leg_state(phi) == state


@given(st.floats(-1.5, 3.1), st.floats(-0.3, 0.3))
def test_heights_of_a_half_circle_are_eq_3_37(phi, roll):
    printed = (R + R * np.cos(phi) if phi >= 0 else 2 * R * np.cos(phi)) * np.cos(roll)
    assert hip_height(phi, R) * np.cos(roll) == pytest.approx(printed, abs=1e-15)


@given(PHI, st.floats(-10, 10), BEYOND)
def test_height_rates_are_derivatives(phi, rate, toe_beyond):
    kinks = np.array([-toe_beyond, -(np.pi + toe_beyond) / 2])
    assume(np.abs(phi - kinks).min() > 1e-3 and abs(phi) < 3.13)
    h = 1e-5
    ahead, behind = phi + rate * h, phi - rate * h
    moved = hip_height(ahead, R, toe_beyond) - hip_height(behind, R, toe_beyond)
    assert hip_height_rate(phi, rate, R, toe_beyond) == pytest.approx(moved / (2 * h), abs=1e-7)
    turned = hip_height_rate(ahead, rate, R, toe_beyond)
    turned -= hip_height_rate(behind, rate, R, toe_beyond)
    acceleration = hip_height_acceleration(phi, rate, R, toe_beyond)
    assert acceleration == pytest.approx(turned / (2 * h), abs=1e-5)


@compiled
def _in_a_loop(phi, toe_beyond):
    heights = np.empty(len(phi))
    for i in range(len(phi)):
        heights[i] = hip_height(wrap_angle(phi[i]), R, toe_beyond)
    return heights


def test_compiled_loops_compute_the_same():
    phi = np.linspace(-6, 6, 101)
    np.testing.assert_allclose(
        _in_a_loop(phi, 0.35), hip_height(wrap_angle(phi), R, 0.35), atol=1e-16
    )
