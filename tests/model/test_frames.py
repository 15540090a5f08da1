# SPDX-License-Identifier: MIT
import numpy as np
from hypothesis import given
from hypothesis import strategies as st

from model.frames import (
    attitude,
    body_from_hip,
    hip_from_contact,
    roll_pitch_yaw,
    rotation_x,
    rotation_y,
    rotation_z,
    thesis_attitude,
    transform,
)
from model.leg import contact_angle, thesis_lowest_angle, thesis_tilt

ANGLE = st.floats(-3.0, 3.0)
TILT = st.floats(-0.4, 0.4)


@given(ANGLE, st.floats(-1.5, 1.5), ANGLE)
def test_angles_of_an_attitude_come_back(roll, pitch, yaw):
    np.testing.assert_allclose(
        roll_pitch_yaw(attitude(roll, pitch, yaw)), [roll, pitch, yaw], atol=1e-12
    )


@given(ANGLE)
def test_the_two_orders_agree_about_one_axis(angle):
    for angles in ((angle, 0.0, 0.0), (0.0, angle, 0.0), (0.0, 0.0, angle)):
        np.testing.assert_allclose(thesis_attitude(*angles), attitude(*angles), atol=1e-15)


def test_roll_lifts_the_left_and_pitch_lowers_the_nose():
    assert (rotation_x(0.1) @ [0, 1, 0])[2] > 0
    assert (rotation_y(0.1) @ [1, 0, 0])[2] < 0
    assert (rotation_z(0.1) @ [1, 0, 0])[1] > 0


@given(TILT)
def test_the_sources_roll_is_a_pitch_for_a_robot_that_heads_along_y(roll):
    ours = roll_pitch_yaw(thesis_attitude(roll, 0.0, np.pi / 2))
    np.testing.assert_allclose(ours, [0.0, -roll, np.pi / 2], atol=1e-12)


@given(TILT, TILT, st.floats(0.6, 2.4))
def test_the_chain_of_transforms_ends_at_the_lowest_point_in_a_level_frame(roll, pitch, theta):
    tilt = thesis_tilt(roll, pitch, 0.0)
    phi = thesis_lowest_angle(theta, tilt)
    contact = contact_angle(phi)
    hip, r = np.array([0.097, 0.1156, 0.0]), 0.035
    inertial_from_body = transform(thesis_attitude(roll, pitch, 0.0), [0.3, 0.1, 0.06])
    leg_from_contact = hip_from_contact(phi, contact, roll=roll, radius=r)
    chain = inertial_from_body @ body_from_hip(theta, hip) @ leg_from_contact
    np.testing.assert_allclose(chain[:3, :3], np.eye(3), atol=1e-12)
    around = np.linspace(max(contact, 0.0), np.pi, 400)
    arc = np.column_stack(
        [r + r * np.cos(around), 0 * around, -r * np.sin(around), np.ones_like(around)]
    )
    heights = (inertial_from_body @ body_from_hip(theta, hip) @ arc.T)[2]
    assert chain[2, 3] <= heights.min() + 1e-12
