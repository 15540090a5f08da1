# SPDX-License-Identifier: MIT
import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from model.leg import HIP, ROLLING, TOE
from model.walk.contact_points import lowest_point

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
