# SPDX-License-Identifier: MIT
r"""Normal forces of a tripod, Eq. (4-15) to (4-22).

The thesis looks for normal forces f that give the pitch and roll rates its kinematics asks for,

.. math::
    \min_f\ (\dot\theta_p - 0)^2 + (\dot\theta_r - \dot\theta_r^{kin})^2 \quad\text{such that}\quad
    \sum f_i = m (g + \ddot z_b), \quad 0 \le f_i \le m g ,

with a general optimiser. Three forces have two degrees of freedom under the sum, so inside the
bounds the minimum is zero. Here each round takes moments linear in f, which they are but for the
law's curvature, and solves that problem exactly; Gauss-Newton rounds converge in a handful.
"""

from typing import NamedTuple

import numpy as np

from model.arrays import Array
from model.compiled import compiled
from model.thesis.traction import load_derivative, traction_force

_ROUNDS = 60  # of Gauss-Newton, which converges in a handful
_CONVERGED = 1e-11  # N


class Balance(NamedTuple):
    """Contacts of the three legs that carry load, and what their normal forces have to produce.

    Attributes:
        arms: Contact points from the body's centre, inertial frame, shape (3, 3) [m].
        axes: Forward, left and up of the contact frames, in rows, shape (3, 3) [-].
        slip: Longitudinal and lateral slip of each leg, shape (3, 2) [-].
        inertia: Moments of inertia about roll and pitch axes, shape (2,) [kg m2].
        wanted: Roll and pitch acceleration that contact moments have to produce, (2,) [rad/s2].
        speeds: Of each leg, v_R of its surface (v_T on the toe), v_C of the body's point at the
            contact and v_H of the hip, forward, shape (3, 3) [m/s].
    """

    arms: Array
    axes: Array
    slip: Array
    inertia: Array
    wanted: Array
    speeds: Array


@compiled
def static_loads(points, weight, loads):
    r"""Compute the first guess of the normal forces from geometry, Eq. (4-15) to (4-18).

    .. math::
        \hat f_k = m g\,\frac{d_{Bk}}{d_k}

    with the distances of the body's centre, the origin here, and of contact k from the line through
    the other two contacts; a third of the weight each where the contacts lie on one line. With the
    centre outside the triangle the sum is larger than the weight.

    Args:
        points: Contact points seen from above, shape (3, 2 or more) [m].
        weight: Sum of the normal forces, the m g above [N].
        loads: Filled: normal forces, shape (3,) [N].
    """
    for k in range(3):
        i, j = (k + 1) % 3, (k + 2) % 3
        dx, dy = points[j, 0] - points[i, 0], points[j, 1] - points[i, 1]
        of_contact = dy * (points[k, 0] - points[i, 0]) - dx * (points[k, 1] - points[i, 1])
        of_centre = -dy * points[i, 0] + dx * points[i, 1]
        loads[k] = weight * abs(of_centre / of_contact) if of_contact != 0 else weight / 3


@compiled
def leg_force(axes, forward, left, up, force):
    """Compute a leg's force in the inertial frame from its components in the contact frame.

    Args:
        axes: Forward, left and up of the contact frame, in rows, shape (3, 3) [-].
        forward: Component along forward [N].
        left: Component along left [N].
        up: Component along up, the normal force [N].
        force: Filled: force in the inertial frame, shape (3,) [N].
    """
    for a in range(3):
        force[a] = forward * axes[0, a] + left * axes[1, a] + up * axes[2, a]


@compiled
def accelerations(balance, traction, loads, excess, slopes):
    """Compute roll and pitch acceleration by contacts less `balance.wanted`, and load derivatives.

    Args:
        balance: The contacts; see `Balance`.
        traction: The slip law.
        loads: Normal forces, shape (3,) [N].
        excess: Filled: roll and pitch acceleration less the wanted ones, shape (2,) [rad/s2].
        slopes: Filled: derivatives of excess (rows) by loads (columns), (2, 3) [rad/(s2 N)].
    """
    force, slope = np.empty(3), np.empty(3)
    excess[0], excess[1] = -balance.wanted[0], -balance.wanted[1]
    for k in range(3):
        x, y, z = balance.arms[k]
        lon, lat = balance.slip[k]
        forward = traction_force(traction, lon, loads[k])
        left = traction_force(traction, lat, loads[k])
        leg_force(balance.axes, forward, left, loads[k], force)
        forward = load_derivative(traction, lon, loads[k], forward)
        left = load_derivative(traction, lat, loads[k], left)
        leg_force(balance.axes, forward, left, 1.0, slope)
        excess[0] += (y * force[2] - z * force[1]) / balance.inertia[0]
        excess[1] += (z * force[0] - x * force[2]) / balance.inertia[1]
        slopes[0, k] = (y * slope[2] - z * slope[1]) / balance.inertia[0]
        slopes[1, k] = (z * slope[0] - x * slope[2]) / balance.inertia[1]


@compiled
def solve_inside(c, slopes, total, loads):
    """Solve the linear system c + slopes f = 0 for three forces f of given sum.

    Args:
        c: Constant terms, shape (2,) [rad/s2].
        slopes: Coefficients of f, shape (2, 3) [rad/(s2 N)].
        total: Sum of f [N].
        loads: Filled: f, not finite where the system is singular, shape (3,) [N].
    """
    a, b = slopes[0, 0] - slopes[0, 2], slopes[0, 1] - slopes[0, 2]
    d, e = slopes[1, 0] - slopes[1, 2], slopes[1, 1] - slopes[1, 2]
    p, q = c[0] + slopes[0, 2] * total, c[1] + slopes[1, 2] * total
    determinant = a * e - b * d
    loads[0] = (b * q - e * p) / determinant
    loads[1] = (d * p - a * q) / determinant
    loads[2] = total - loads[0] - loads[1]


@compiled
def solve_on_edges(c, slopes, total, most, loads):
    """Minimise |c + slopes f|^2 over three forces f of given sum, at least one at a bound.

    Args:
        c: Constant terms, shape (2,) [rad/s2].
        slopes: Coefficients of f, shape (2, 3) [rad/(s2 N)].
        total: Sum of f [N].
        most: Upper bound of each f; the lower is zero [N].
        loads: Filled: f of the minimum, shape (3,) [N]; left as it is where no f has this sum.
    """
    best = np.inf
    for i in range(3):
        j, k = (i + 1) % 3, (i + 2) % 3
        for bound in (0.0, most):
            rest = total - bound
            low, high = max(0.0, rest - most), min(most, rest)
            if high < low:
                continue
            p0, p1 = slopes[0, j] - slopes[0, k], slopes[1, j] - slopes[1, k]
            q0 = c[0] + slopes[0, i] * bound + slopes[0, k] * rest
            q1 = c[1] + slopes[1, i] * bound + slopes[1, k] * rest
            f_j = min(max(-(p0 * q0 + p1 * q1) / (p0 * p0 + p1 * p1), low), high)
            value = (q0 + p0 * f_j) ** 2 + (q1 + p1 * f_j) ** 2
            if value < best:
                best = value
                loads[i], loads[j], loads[k] = bound, f_j, rest - f_j


@compiled
def normal_forces(balance, traction, total, most, loads):
    """Solve Eq. (4-22) for the normal forces of three legs by 60 Gauss-Newton rounds at most.

    They sum to `total`, lie between 0 and `most`, and come as near to the wanted roll and pitch
    accelerations as that allows, by least squares.
    A round that leaves the bounds, or whose system is singular, takes the best point on an edge.

    Args:
        balance: Contacts and wanted accelerations; see `Balance`.
        traction: The slip law.
        total: Sum of the forces; at least 0 and at most three times `most` [N].
        most: Largest force of a leg [N].
        loads: First guess, overwritten with the result, shape (3,) [N].
    """
    excess, slopes, c, trial = np.empty(2), np.empty((2, 3)), np.empty(2), np.empty(3)
    for _ in range(_ROUNDS):
        accelerations(balance, traction, loads, excess, slopes)
        for row in range(2):
            c[row] = excess[row]
            for k in range(3):
                c[row] -= slopes[row, k] * loads[k]
        solve_inside(c, slopes, total, trial)
        if not (trial.min() >= 0.0 and trial.max() <= most):
            solve_on_edges(c, slopes, total, most, trial)
        moved = np.abs(trial - loads).max()
        loads[:] = trial
        if moved < _CONVERGED:
            return
