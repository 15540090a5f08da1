# SPDX-License-Identifier: MIT
"""Linear system of a step in the body's final velocities, assembled and solved, compiled."""

from model.compiled import inlined
from model.robot import GRAVITY


@inlined
def start_system(mass, inertia, gyro, state, dt, A, b):
    """Fill a step's linear system with the body's inertia, momentum, weight and gyroscopic moment.

    Args:
        mass: Mass [kg].
        inertia: Inertia in the world frame, shape (3, 3) [kg m2].
        gyro: Gyroscopic moment, shape (3,) [N m].
        state: State at the step's start.
        dt: Length of the step [s].
        A: Filled: matrix of the step, lower half, shape (6, 6).
        b: Filled: right side of the step, shape (6,).
    """
    A[:, :] = 0.0
    for i in range(3):
        A[i, i] = mass
        b[i] = mass * state.v[i]
        b[3 + i] = dt * gyro[i]
        for j in range(i + 1):
            A[3 + i, 3 + j] = inertia[i, j]
        for j in range(3):
            b[3 + i] += inertia[i, j] * state.w[j]
    b[2] -= dt * mass * GRAVITY


@inlined
def add_damping_along(A, c, place, n):
    r"""Add a damping of one contact along one direction to a step's matrix, lower half.

    With the contact Jacobian :math:`J = [1, -place\times]`, which takes velocity and angular
    velocity of the body to the velocity at `place`, it adds :math:`c\, J^T n\, n^T J`.

    Args:
        A: Matrix of the step, updated, shape (6, 6).
        c: Damping times the step's length [kg].
        place: Contact from the body's centre, world frame, shape (3,) [m].
        n: The direction, shape (3,) [-].
    """
    x, y, z = place
    n0, n1, n2 = n[0], n[1], n[2]
    m0, m1, m2 = y * n2 - z * n1, z * n0 - x * n2, x * n1 - y * n0  # place × n
    A[0, 0] += c * n0 * n0
    A[1, 0] += c * n1 * n0
    A[1, 1] += c * n1 * n1
    A[2, 0] += c * n2 * n0
    A[2, 1] += c * n2 * n1
    A[2, 2] += c * n2 * n2
    A[3, 0] += c * m0 * n0
    A[3, 1] += c * m0 * n1
    A[3, 2] += c * m0 * n2
    A[3, 3] += c * m0 * m0
    A[4, 0] += c * m1 * n0
    A[4, 1] += c * m1 * n1
    A[4, 2] += c * m1 * n2
    A[4, 3] += c * m1 * m0
    A[4, 4] += c * m1 * m1
    A[5, 0] += c * m2 * n0
    A[5, 1] += c * m2 * n1
    A[5, 2] += c * m2 * n2
    A[5, 3] += c * m2 * m0
    A[5, 4] += c * m2 * m1
    A[5, 5] += c * m2 * m2


@inlined
def add_damping(A, c, place):
    r"""Add a damping of one contact alike in all directions, :math:`c\, J^T J`, to the matrix.

    Args:
        A: Matrix of the step, lower half updated, shape (6, 6).
        c: Damping times the step's length [kg].
        place: Contact from the body's centre, world frame, shape (3,) [m].
    """
    x, y, z = place
    for i in range(3):
        A[i, i] += c
    A[3, 1] -= c * z
    A[3, 2] += c * y
    A[4, 0] += c * z
    A[4, 2] -= c * x
    A[5, 0] -= c * y
    A[5, 1] += c * x
    A[3, 3] += c * (y * y + z * z)
    A[4, 3] -= c * x * y
    A[4, 4] += c * (x * x + z * z)
    A[5, 3] -= c * x * z
    A[5, 4] -= c * y * z
    A[5, 5] += c * (x * x + y * y)


@inlined
def add_force(b, dt, place, force):
    r"""Add the impulse of a force at a contact, :math:`\Delta t\, J^T F`, to a step's right side.

    Args:
        b: Right side of the step, updated, shape (6,).
        dt: Length of the step [s].
        place: Contact from the body's centre, world frame, shape (3,) [m].
        force: Force of the contact at zero velocity of the body, shape (3,) [N].
    """
    x, y, z = place
    for i in range(3):
        b[i] += dt * force[i]
    b[3] += dt * (y * force[2] - z * force[1])
    b[4] += dt * (z * force[0] - x * force[2])
    b[5] += dt * (x * force[1] - y * force[0])


@inlined
def solve_positive(A, b, n):
    """Solve a symmetric positive definite system A x = b in place by LDL' factorisation.

    Args:
        A: Matrix, of which the lower half is used and overwritten, shape (n, n).
        b: Right side, overwritten with x, shape (n,).
        n: Number of unknowns.
    """
    for j in range(n):
        for k in range(j):
            t = A[j, k] * A[k, k]
            A[j, j] -= A[j, k] * t
        for i in range(j + 1, n):
            for k in range(j):
                A[i, j] -= A[i, k] * A[k, k] * A[j, k]
            A[i, j] /= A[j, j]
    for i in range(n):
        for k in range(i):
            b[i] -= A[i, k] * b[k]
    for i in range(n):
        b[i] /= A[i, i]
    for i in range(n - 1, -1, -1):
        for k in range(i + 1, n):
            b[i] -= A[k, i] * b[k]
