# SPDX-License-Identifier: MIT
import numpy as np
from hypothesis import given
from hypothesis import strategies as st

from model.robot import GRAVITY
from model.walk.arrays import new_state
from model.walk.linear_system import (
    add_damping,
    add_damping_along,
    add_force,
    solve_positive,
    start_system,
)


@given(st.integers(0, 2**32 - 1))
def test_a_contact_adds_its_jacobians_square(seed):
    rng = np.random.default_rng(seed)
    place, force, direction = rng.normal(size=(3, 3))
    x, y, z = place
    J = np.hstack([np.eye(3), -np.array([[0, -z, y], [z, 0, -x], [-y, x, 0]])])
    alike, along, b = np.zeros((6, 6)), np.zeros((6, 6)), np.zeros(6)
    add_damping(alike, 0.3, place)
    add_damping_along(along, -0.2, place, direction)
    add_force(b, 0.1, place, force)
    np.testing.assert_allclose(alike, np.tril(0.3 * J.T @ J), atol=1e-12)
    square = J.T @ np.outer(direction, direction) @ J
    np.testing.assert_allclose(along, np.tril(-0.2 * square), atol=1e-12)
    np.testing.assert_allclose(b, 0.1 * J.T @ force, atol=1e-12)


@given(st.integers(0, 2**32 - 1))
def test_the_solver_solves_from_the_lower_half_alone(seed):
    rng = np.random.default_rng(seed)
    root, b = rng.normal(size=(6, 6)), rng.normal(size=6)
    A = root @ root.T + np.eye(6)
    x = b.copy()
    solve_positive(np.tril(A), x, 6)
    np.testing.assert_allclose(A @ x, b, atol=1e-9)


def test_without_contacts_the_system_gives_free_flight_with_its_gyroscopic_moment():
    state = new_state()
    state.v[:], state.w[:] = [1.0, 2.0, 3.0], [0.1, -0.2, 0.3]
    inertia, gyro = np.diag([0.01, 0.02, 0.03]), np.array([0.5, 0.0, -0.3])
    A, b = np.empty((6, 6)), np.empty(6)
    start_system(2.0, inertia, gyro, state, 0.1, A, b)
    solve_positive(A, b, 6)
    np.testing.assert_allclose(b[:3], [1.0, 2.0, 3.0 - 0.1 * GRAVITY])
    np.testing.assert_allclose(b[3:], state.w + 0.1 * gyro / np.diag(inertia))
