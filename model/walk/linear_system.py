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
def add_contact(A, b, dt, place, P, force):
    """Add a contact to the step's linear system: dt·J'PJ to A, lower half, and dt·J'·force to b.

    J = [1, -place×] is the contact Jacobian. It takes velocity and angular velocity of the body to
    the velocity at `place`.

    Args:
        A: Matrix of the step, updated, shape (6, 6).
        b: Right side of the step, updated, shape (6,).
        dt: Length of the step [s].
        place: Contact from the body's centre, world frame, shape (3,) [m].
        P: Symmetric damping matrix of the contact, shape (3, 3) [N s/m].
        force: Force of the contact at zero velocity of the body, shape (3,) [N].
    """
    x, y, z = place
    for j in range(3):
        b[j] += dt * force[j]
        p0, p1, p2 = P[0, j], P[1, j], P[2, j]
        # Column j of place× P.
        q0, q1, q2 = y * p2 - z * p1, z * p0 - x * p2, x * p1 - y * p0
        for i in range(j, 3):
            A[i, j] += dt * P[i, j]
        A[3, j] += dt * q0
        A[4, j] += dt * q1
        A[5, j] += dt * q2
    b[3] += dt * (y * force[2] - z * force[1])
    b[4] += dt * (z * force[0] - x * force[2])
    b[5] += dt * (x * force[1] - y * force[0])
    # place× P (place×)', lower half, from the rows of place× P.
    q1 = y * P[2, 1] - z * P[1, 1]
    q2 = y * P[2, 2] - z * P[1, 2]
    A[3, 3] += dt * (y * q2 - z * q1)
    q0, q1, q2 = z * P[0, 0] - x * P[2, 0], z * P[0, 1] - x * P[2, 1], z * P[0, 2] - x * P[2, 2]
    A[4, 3] += dt * (y * q2 - z * q1)
    A[4, 4] += dt * (z * q0 - x * q2)
    q0, q1, q2 = x * P[1, 0] - y * P[0, 0], x * P[1, 1] - y * P[0, 1], x * P[1, 2] - y * P[0, 2]
    A[5, 3] += dt * (y * q2 - z * q1)
    A[5, 4] += dt * (z * q0 - x * q2)
    A[5, 5] += dt * (x * q1 - y * q0)


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
