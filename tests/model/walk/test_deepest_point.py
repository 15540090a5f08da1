# SPDX-License-Identifier: MIT
import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from model.frames import attitude
from model.leg import HIP, TOE
from model.robot import Robot
from model.walk.arrays import body_arrays
from model.walk.contact_points import lowest_point
from model.walk.deepest_point import deepest_point
from model.walk.ground import ground_at, with_slope
from support.grounds import sample_ground

ROBOT = Robot()
BODY = body_arrays(ROBOT)
HIP_AT = ROBOT.hips[0]
ROUGH = sample_ground(
    lambda x, y: 0.006 * np.sin(31 * x + 1) * np.cos(23 * y), x=(-0.5, 0.5), y=(-0.5, 0.5)
)
THETA = st.floats(-3.0, 9.0)
SMALL = st.floats(-0.3, 0.3)


def found(ground, p, R, theta):
    """Return a leg's contact in the world, the state, the gap and the normal."""
    normal = np.empty(3)
    up = np.array([-ground.slope_x, -ground.slope_y, 1.0])
    down = -R.T @ (up / np.linalg.norm(up))
    x, z, state, gap = deepest_point(BODY, ground, p, R, HIP_AT, theta, down[0], down[2], normal)
    return p + R @ (HIP_AT + np.array([x, 0.0, z])), state, gap, normal


def arc(p, R, theta, n=401):
    """Return points of the leg's arc from toe to hip in the world, shape (n, 3)."""
    psi = theta + np.linspace(np.pi - ROBOT.leg_arc, np.pi, n)
    x = ROBOT.leg_radius * (np.cos(theta) + np.cos(psi))
    z = -ROBOT.leg_radius * (np.sin(theta) + np.sin(psi))
    return p + (HIP_AT + np.column_stack([x, np.zeros(n), z])) @ R.T


@pytest.mark.parametrize("ground", [ROUGH, with_slope(ROUGH, 0.08, -0.1)])
@given(theta=THETA, roll=SMALL, pitch=SMALL, yaw=st.floats(-3.0, 3.0), x=SMALL)
def test_no_point_of_the_arc_is_deeper(ground, theta, roll, pitch, yaw, x):
    p, R = np.array([x, 0.1, 0.06]), attitude(roll, pitch, yaw)
    points = arc(p, R, theta)
    depth = np.array([ground_at(ground, *each[:2])[0] - each[2] for each in points])
    point, _, gap, normal = found(ground, p, R, theta)
    here = ground_at(ground, *point[:2])[0] - point[2]
    assert gap == pytest.approx(-here * normal[2], abs=1e-9)
    if here > -0.004:  # further up the search ends before it has refined the point
        assert here > depth.max() - 2e-6


@given(THETA, SMALL, SMALL)
def test_on_a_plane_of_heights_it_is_the_lowest_point(theta, pitch, slope):
    height = np.tan(slope)
    plane = sample_ground(lambda x, y: height * x + 0 * y, x=(-0.5, 0.5), y=(-0.5, 0.5))
    p, R = np.array([0.0, 0.0, 0.06]), attitude(0.0, pitch, 0.0)
    down = R.T @ np.array([np.sin(slope), 0.0, -np.cos(slope)])
    x, z, state = lowest_point(theta, down[0], down[2], BODY.leg_radius, BODY.toe_cos, BODY.toe_sin)
    point, kind, gap, normal = found(plane, p, R, theta)
    expected = p + R @ (HIP_AT + np.array([x, 0.0, z]))
    over = (expected[2] - height * expected[0]) * np.cos(slope)
    if over < 0.004:
        assert gap == pytest.approx(over, abs=2e-6)
        np.testing.assert_allclose(normal, [-np.sin(slope), 0.0, np.cos(slope)], atol=0.01)
        assert kind == state or np.linalg.norm(point - expected) < 1e-3


@pytest.mark.parametrize(("theta", "state"), [(2.0, TOE), (4.5, HIP)])
def test_an_end_of_the_arc_has_the_normal_of_the_ground(theta, state):
    p = np.array([0.0, 0.0, 0.03])
    point, kind, _, normal = found(ROUGH, p, np.eye(3), theta)
    assert kind == state
    np.testing.assert_allclose(normal, ground_at(ROUGH, *point[:2])[1:], atol=1e-9)
