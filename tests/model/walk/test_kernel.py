# SPDX-License-Identifier: MIT
import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st
from scipy.spatial.transform import Rotation

from model.leg import HIP, ROLLING, TOE
from model.walk.kernel import add_contact, lowest_point, rotate, rotation_matrix, solve_positive

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


# --- legs of any arc


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


# --- algebra


@given(st.integers(0, 2**32 - 1))
def test_a_contact_adds_its_jacobians_square(seed):
    rng = np.random.default_rng(seed)
    place, force, root = rng.normal(size=3), rng.normal(size=3), rng.normal(size=(3, 3))
    P = root @ root.T
    A, b = np.zeros((6, 6)), np.zeros(6)
    add_contact(A, b, 0.1, place, P, force)
    x, y, z = place
    J = np.hstack([np.eye(3), -np.array([[0, -z, y], [z, 0, -x], [-y, x, 0]])])
    np.testing.assert_allclose(np.tril(A), np.tril(0.1 * J.T @ P @ J), atol=1e-12)
    np.testing.assert_allclose(b, 0.1 * J.T @ force, atol=1e-12)


@given(st.integers(0, 2**32 - 1))
def test_the_solver_solves_from_the_lower_half_alone(seed):
    rng = np.random.default_rng(seed)
    root, b = rng.normal(size=(6, 6)), rng.normal(size=6)
    A = root @ root.T + np.eye(6)
    x = b.copy()
    solve_positive(np.tril(A), x, 6)
    np.testing.assert_allclose(A @ x, b, atol=1e-9)


@given(st.lists(st.floats(-30.0, 30.0), min_size=3, max_size=3), st.floats(1e-5, 0.1))
def test_turning_by_a_vector_is_its_rotation(w, dt):
    q = Rotation.from_euler("ZYX", [0.4, -0.3, 0.2]).as_quat(scalar_first=True)
    expected = Rotation.from_rotvec(np.array(w) * dt) * Rotation.from_quat(q, scalar_first=True)
    matrix = np.empty((3, 3))
    rotate(q, np.array(w), dt)
    rotation_matrix(q, matrix)
    np.testing.assert_allclose(matrix, expected.as_matrix(), atol=1e-12)
