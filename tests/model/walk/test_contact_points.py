# SPDX-License-Identifier: MIT
import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from model.leg import HIP, ROLLING, TOE
from model.robot import Robot
from model.walk.arrays import body_arrays, new_work
from model.walk.contact_points import find_contacts, lowest_point
from model.walk.ground import FLAT

R = 0.035
ARC = st.floats(90.0, 359.0).map(np.radians)
THETA = st.floats(-7.0, 20.0)
TILT = st.floats(-0.8, 0.8)


def lowest(theta, tilt, arc):
    """Return a leg's lowest point where "down" is turned by a tilt about y."""
    beyond = arc - np.pi
    down = np.sin(tilt), -np.cos(tilt)
    x, z, state = lowest_point(theta, *down, R, np.cos(beyond), np.sin(beyond))
    return np.array([x, z]), np.array(down), state


def arc_points(theta, arc, n=2001):
    """Return points from toe to hip, shape (n, 2)."""
    angle = theta + np.linspace(np.pi - arc, np.pi, n)
    return R * np.column_stack([np.cos(theta) + np.cos(angle), -np.sin(theta) - np.sin(angle)])


@given(THETA, TILT, ARC)
def test_no_point_of_the_arc_is_lower(theta, tilt, arc):
    point, down, _ = lowest(theta, tilt, arc)
    depths = arc_points(theta, arc) @ down
    assert depths.max() == pytest.approx(point @ down, abs=R * 1e-5)


@given(THETA, TILT, ARC)
def test_the_state_says_which_point_it_is(theta, tilt, arc):
    point, down, state = lowest(theta, tilt, arc)
    ends = arc_points(theta, arc)[[0, -1]]
    if state == ROLLING:
        centre = R * np.array([np.cos(theta), -np.sin(theta)])
        np.testing.assert_allclose(point, centre + R * down, atol=1e-12)
    else:
        np.testing.assert_allclose(point, ends[{TOE: 0, HIP: 1}[state]], atol=1e-12)


@given(TILT, ARC)
def test_a_leg_comes_onto_its_toe_without_a_jump(tilt, arc):
    # The arc's end is at the bottom where theta turns it straight "down".
    end = 0.5 * np.pi - tilt + (arc - np.pi)
    before, _, rolling = lowest(end - 1e-7, tilt, arc)
    after, _, toe = lowest(end + 1e-7, tilt, arc)
    assert (rolling, toe) == (ROLLING, TOE)
    np.testing.assert_allclose(before, after, atol=R * 1e-6)


@pytest.mark.parametrize("arc_deg", [120.0, 180.0, 200.0, 300.0])
def test_a_turning_legs_depth_never_jumps(arc_deg):
    theta = np.linspace(0, 2 * np.pi, 4001)
    found = (lowest(a, 0.1, np.radians(arc_deg)) for a in theta)
    depth = np.array([point @ down for point, down, _ in found])
    assert np.abs(np.diff(depth)).max() <= 2 * R * (theta[1] - theta[0])


def contacts(height, theta, speed):
    """Find the contacts of a level robot with its centre above the origin of flat ground."""
    work = new_work()
    found = [work.place, work.velocity, work.normal, work.gap, work.kind, work.flow]
    n = find_contacts(
        body_arrays(ROBOT), FLAT, np.array([0.0, 0.0, height]), np.eye(3), theta, speed, *found
    )
    return n, found


ROBOT = Robot()
DOWNWARD = np.full(6, 1.2)


def test_gaps_of_a_level_robot_are_its_height_less_legs_and_body():
    length, width, depth = ROBOT.body_size
    height = depth / 2 + 0.005
    n, (place, _, normal, gap, state, flow) = contacts(height, DOWNWARD, np.zeros(6))
    assert n == 14
    reach = ROBOT.leg_radius * (1 + np.sin(DOWNWARD))
    np.testing.assert_allclose(gap[:6], height + ROBOT.hips[:, 2] - reach)
    np.testing.assert_allclose(place[:6, 1], ROBOT.hips[:, 1])
    assert set(state[:6]) == {ROLLING}
    np.testing.assert_allclose(flow, [ROBOT.leg_radius] * 6 + [0.0] * 8)
    np.testing.assert_allclose(normal, np.tile([0.0, 0.0, 1.0], (14, 1)))
    corners = np.abs(place[6:])
    np.testing.assert_allclose(corners, np.tile([length / 2, width / 2, depth / 2], (8, 1)))
    np.testing.assert_allclose(np.sort(gap[6:]), np.repeat([0.005, 0.005 + depth], 4))


def test_corners_high_above_the_ground_are_not_computed():
    assert contacts(0.05 + ROBOT.body_size[2], DOWNWARD, np.zeros(6))[0] == 6


def test_the_contacts_velocity_is_the_leg_s_turning_about_the_hip():
    speed = np.arange(1.0, 7.0)
    _, (place, velocity, *_) = contacts(0.05, DOWNWARD, speed)
    turning = np.cross(speed[:, None] * [0.0, 1.0, 0.0], place[:6] - ROBOT.hips)
    np.testing.assert_allclose(velocity[:6], turning, atol=1e-12)
