# SPDX-License-Identifier: MIT
r"""One step of the rigid body on compliant contacts, compiled.

Unknowns of a step are the velocity v and angular velocity w of the body at its end. Normal force
and traction of every contact are taken there, linear in them,

.. math::
    N_i' = -k (g_i + \Delta t\, n_i \cdot J_i v') - c'\, n_i \cdot (J_i v' + u_i), \qquad
    T_i' = -G_i (J_i v' + u_i)_t,

with stiffness k of contact i, gap g, normal n, contact Jacobian J, the leg's own velocity u at its
contact, and the secant G of the slip law. A prime marks the step's end, v' stands for v and w
there, and the index t for the part along the ground. Where grip differs along and across a leg's
rolling direction, G has a further part across it, see `model.walk.anisotropy`. Taking the gap at
the step's end damps as a damping of k dt does; c' is what the contact's damping c leaves beyond
that, or zero. A step of up to c/k therefore damps as much as any shorter one.

This gives a symmetric positive definite 6x6 system. Iterations determine which contacts press and
what G is, from the velocities that the step before leads to. One is enough where motion is even.
Where feet that slid take hold or let go, G changes by orders of magnitude within a step, and each
iteration comes nearer by only a part of the way that is left: see `settling_error`. No contact
pulls, and traction opposes slip whatever the step. The step is therefore stable at any length,
unlike the explicit step of the thesis.
"""

import numpy as np

from model.compiled import inlined
from model.robot import N_LEGS
from model.walk.anisotropy import effective_size, find_across, sideways
from model.walk.arrays import N_CONTACTS
from model.walk.contact_points import find_contacts, point_velocity
from model.walk.linear_system import (
    add_damping,
    add_damping_along,
    add_force,
    solve_positive,
    start_system,
)
from model.walk.quaternion import rotate, rotation_matrix
from model.walk.traction_lookup import traction_secant

MOST_ROUNDS = 20  # largest number of solves until contacts press as assumed and velocities settle
SETTLED = 3e-4  # m/s; the last guess of the velocities was no further from where they settle
FOOT = 0.15  # m, distance of the feet from the body's centre, to compare its turning with that


@inlined
def one_step(body, table, ground, contacts, state, work, theta, speed, dt):
    """Advance the body's state by one linearly implicit step.

    Args:
        body: The robot.
        table: The slip law.
        ground: The ground.
        contacts: Stiffness and damping of contacts.
        state: State at the start, overwritten with the state at the end.
        work: Filled with the contacts of the step; `load` must hold the loads and `gain` the
            accelerations of the step before.
        theta: Leg angles at the end, shape (6,) [rad].
        speed: Leg speeds in the step, shape (6,) [rad/s].
        dt: Length of the step [s].
    """
    rotation_matrix(state.q, work.R)
    n = find_contacts(
        body, ground, state.p, work.R, theta, speed, work.place, work.velocity, work.normal,
        work.gap, work.kind, work.flow,
    )  # fmt: skip
    for i in range(n, N_CONTACTS):
        work.load[i] = 0.0
    for i in range(3):
        work.b[i] = state.v[i] + dt * work.gain[i]
        work.b[3 + i] = state.w[i] + dt * work.gain[3 + i]
    v, w, inertia, gyro = work.v, work.w, work.inertia, work.gyro
    _world_inertia(work.R, body.inertia, inertia)
    _gyroscopic(inertia, state.w, gyro)
    for _ in range(MOST_ROUNDS):
        for i in range(3):
            v[i], w[i] = work.b[i], work.b[3 + i]
        start_system(body.mass, inertia, gyro, state, dt, work.A, work.b)
        held = add_contact_forces(table, contacts, work, n, speed, dt)
        solve_positive(work.A, work.b, 6)
        agree = contacts_agree(contacts, work, n, dt)
        if agree and settling_error(velocity_change(work), held, body.mass, dt) < SETTLED:
            break
    for i in range(3):
        work.gain[i] = (work.b[i] - state.v[i]) / dt
        work.gain[3 + i] = (work.b[3 + i] - state.w[i]) / dt
        state.v[i], state.w[i] = work.b[i], work.b[3 + i]
        state.p[i] += dt * state.v[i]
    rotate(state.q, state.w, dt)


@inlined
def velocity_change(work):
    """Return by how much a solve changed the body's velocity and, by its turning, the feet's [m/s].

    It is the root of the sum of the squares of both, which does not depend on the heading.

    Args:
        work: Arrays of the step with the solved velocities in `b`, those before in `v` and `w`.
    """
    squares = 0.0
    for i in range(3):
        squares += (work.b[i] - work.v[i]) ** 2 + (FOOT * (work.b[3 + i] - work.w[i])) ** 2
    return np.sqrt(squares)


@inlined
def settling_error(moved, held, mass, dt):
    r"""Estimate how far a guess of the velocities is from those at which iterations settle [m/s].

    A solve with traction as secant G times slip, where traction hardly changes with slip any more,
    takes the guess's error times

    .. math:: \rho = \frac{G\, \Delta t}{m + G\, \Delta t} .

    The guess was therefore off by what the solve moved it, over :math:`1 - \rho`. Near the peak of
    a slip curve that is many times as much in a long step.

    Args:
        moved: Change of the velocities by a solve [m/s].
        held: Sum of the secants of all contacts [N s/m].
        mass: Mass of the body [kg].
        dt: Length of the step [s].
    """
    return moved * (mass + dt * held) / mass


@inlined
def contact_damping(contacts, dt):
    """Return the damping of a contact beyond k dt, by which a step damps already [N s/m].

    Args:
        contacts: Stiffness k and damping of contacts.
        dt: Length of the step [s].
    """
    return max(contacts.damping - contacts.stiffness * dt, 0.0)


@inlined
def add_contact_forces(table, contacts, work, n, speed, dt):
    """Add the contact forces, linearised in the final velocities about a guess, to a step's system.

    Args:
        table: The slip law.
        contacts: Stiffness and damping of contacts.
        work: The contacts and the guess of velocities; `A` and `b` are updated, `load` and
            `secant` of each contact filled.
        n: Number of contacts.
        speed: Leg speeds in the step, shape (6,) [rad/s].
        dt: Length of the step [s].

    Returns:
        Sum over contacts of the largest traction over slip velocity in any direction [N s/m].
    """
    k, c, held = contacts.stiffness, contact_damping(contacts, dt), 0.0
    v, w, force, point = work.v, work.w, work.force, work.point
    for i in range(n):
        point_velocity(v, w, work.place[i], work.velocity[i], point)
        m0, m1, m2 = work.normal[i, 0], work.normal[i, 1], work.normal[i, 2]
        u0, u1, u2 = work.velocity[i, 0], work.velocity[i, 1], work.velocity[i, 2]
        rise = point[0] * m0 + point[1] * m1 + point[2] * m2
        u_n = u0 * m0 + u1 * m1 + u2 * m2
        load = -k * (work.gap[i] + dt * (rise - u_n)) - c * rise
        work.load[i] = max(load, 0.0)
        work.secant[i] = 0.0
        if load <= 0.0:
            continue
        find_across(table, work, i)
        lateral, across = work.lateral[i], work.across[i]
        x, y, z = point[0] - rise * m0, point[1] - rise * m1, point[2] - rise * m2
        slip = effective_size(lateral, across, x, y, z)
        flow = abs(leg_turn(work.R, speed, w, i)) * work.flow[i] if i < N_LEGS else 0.0
        G = traction_secant(table, work.kind[i], load, slip, flow)
        work.secant[i] = G
        held += G * (1.0 + max(lateral[0], 0.0))
        push, place = -k * work.gap[i] - c * u_n, work.place[i]
        for a in range(3):
            m_a = work.normal[i, a]
            force[a] = push * m_a - G * (work.velocity[i, a] - u_n * m_a)
        if lateral[0] != 0.0:
            more = G * sideways(lateral, across, work.velocity[i])
            for a in range(3):
                force[a] -= more * across[a]
            add_damping_along(work.A, dt * G * lateral[0], place, across)
        add_damping_along(work.A, dt * (k * dt + c - G), place, work.normal[i])
        add_damping(work.A, dt * G, place)
        add_force(work.b, dt, place, force)
    return held


@inlined
def contacts_agree(contacts, work, n, dt):
    """Compute contact loads at the solved velocities; return whether contacts press as assumed.

    Args:
        contacts: Stiffness and damping of contacts.
        work: Arrays of the step with the solved velocities in `b`; `load` is compared, then
            overwritten.
        n: Number of contacts.
        dt: Length of the step [s].
    """
    k, c = contacts.stiffness, contact_damping(contacts, dt)
    v, w, point = work.b[:3], work.b[3:], work.point
    agree = True
    for i in range(n):
        point_velocity(v, w, work.place[i], work.velocity[i], point)
        rise, u_n = 0.0, 0.0
        for a in range(3):
            rise += point[a] * work.normal[i, a]
            u_n += work.velocity[i, a] * work.normal[i, a]
        load = -k * (work.gap[i] + dt * (rise - u_n)) - c * rise
        if (load > 0.0) != (work.load[i] > 0.0):
            agree = False
        work.load[i] = max(load, 0.0)
    return agree


@inlined
def leg_turn(R, speed, w, i):
    """Compute the speed at which a leg turns relative to the ground, about the body's y axis.

    Args:
        R: Rotation of the body, body to world, shape (3, 3).
        speed: Leg speeds relative to the body, shape (6,) [rad/s].
        w: Angular velocity of the body in the world frame, shape (3,) [rad/s].
        i: Index of the leg.

    Returns:
        Leg speed plus the body's angular velocity about its own y axis [rad/s].
    """
    return speed[i] + R[0, 1] * w[0] + R[1, 1] * w[1] + R[2, 1] * w[2]


@inlined
def _world_inertia(R, principal, out):
    """Fill `out` with R diag(principal) R', the inertia in the world frame [kg m2]."""
    for i in range(3):
        for j in range(3):
            out[i, j] = 0.0
            for a in range(3):
                out[i, j] += R[i, a] * principal[a] * R[j, a]


@inlined
def _gyroscopic(inertia, w, out):
    """Fill `out` with the gyroscopic moment -w × (I w), shape (3,) [N m]."""
    L0 = inertia[0, 0] * w[0] + inertia[0, 1] * w[1] + inertia[0, 2] * w[2]
    L1 = inertia[1, 0] * w[0] + inertia[1, 1] * w[1] + inertia[1, 2] * w[2]
    L2 = inertia[2, 0] * w[0] + inertia[2, 1] * w[1] + inertia[2, 2] * w[2]
    out[0] = -(w[1] * L2 - w[2] * L1)
    out[1] = -(w[2] * L0 - w[0] * L2)
    out[2] = -(w[0] * L1 - w[1] * L0)
