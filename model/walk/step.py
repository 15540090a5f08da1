# SPDX-License-Identifier: MIT
"""The loop over steps of the walk, compiled."""

from typing import NamedTuple

import numpy as np

from model.compiled import borrowing, compiled, inlined
from model.robot import GRAVITY
from model.slip.law import Array
from model.walk.arrays import Body, Contacts, State, Work, copy_state, new_state, new_work
from model.walk.ground import Ground
from model.walk.kernel import (
    N_CONTACTS,
    N_LEGS,
    ROLLING,
    add_contact,
    find_contacts,
    point_velocity,
    rotate,
    rotation_matrix,
    solve_positive,
    toe_traction,
    traction_secant,
)
from model.walk.traction import TractionTable

ROUNDS = 2  # solves a step: one for the contacts that press and their loads, one to use them
MOST_ROUNDS = 8  # largest number of solves until the assumed contacts are those that press
FINE_STEP = 0.0005  # s, where contacts change: both tripods are on the ground only for a short time
FINE_TIME = 0.005  # s, after a change
BRISTLE_STIFFNESS = 0.1  # of the normal stiffness: a foot yields some tenths of a millimetre


class Spare(NamedTuple):
    """Preallocated work arrays of the loop.

    Attributes:
        work: Work arrays of a step.
        before: State before a step.
        speed: Leg speeds in a step, shape (6,) [rad/s].
        angles: Leg angles at the end of a finer step, shape (6,) [rad].
        loaded: Loads before a step, shape (14,) [N].
    """

    work: Work
    before: State
    speed: Array
    angles: Array
    loaded: Array


@compiled
def run_steps(
    body: Body,
    table: TractionTable,
    ground: Ground,
    contacts: Contacts,
    state: State,
    theta: Array,
    dt: float,
    pose: Array,
    legs: Array,
) -> int:
    """Integrate a walk through leg angles at equal steps.

    A step in which a contact begins or ends is repeated with finer steps. The steps of the next few
    milliseconds are finer too.

    Args:
        body: The robot.
        table: The slip law.
        ground: The ground.
        contacts: Stiffness and damping of contacts.
        state: Initial state, overwritten with the final one.
        theta: Leg angles at every step's start and the last one's end, shape (n + 1, 6) [rad].
        dt: Length of a step [s].
        pose: Filled at each step's end: position and quaternion, shape (n, 7).
        legs: Filled at each step's end: normal force, traction (world x, y), slip velocity (world
            x, y) and slip ratio (NaN unless rolling) of each leg, shape (n, 6, 6); or shape
            (0, 6, 6) not to keep them.

    Returns:
        Steps walked: n, or fewer where the state stopped being finite.
    """
    spare = Spare(new_work(), new_state(), np.empty(N_LEGS), np.empty(N_LEGS), np.zeros(N_CONTACTS))
    return _steps(body, table, ground, contacts, state, theta, dt, pose, legs, spare)


@borrowing
def _steps(body, table, ground, contacts, state, theta, dt, pose, legs, spare):
    """Integrate as `run_steps` does, with the arrays that it allocated."""
    work, before, speed, angles, loaded = spare
    parts = max(int(np.ceil(dt / FINE_STEP - 1e-9)), 1)
    fine_steps = int(np.ceil(FINE_TIME / dt))
    fine_left = fine_steps
    for step in range(theta.shape[0] - 1):
        for i in range(N_LEGS):
            speed[i] = (theta[step + 1, i] - theta[step, i]) / dt
        copy_state(state, before)
        _copy(work.load, loaded)
        if fine_left == 0 or parts == 1:
            one_step(body, table, ground, contacts, state, work, theta[step + 1], speed, dt)
            if parts > 1 and _contacts_changed(work.load, loaded):
                copy_state(before, state)
                _copy(loaded, work.load)
                fine_left = fine_steps
        if fine_left > 0 and parts > 1:
            for part in range(parts):
                for i in range(N_LEGS):
                    angles[i] = theta[step, i] + (part + 1) / parts * dt * speed[i]
                one_step(body, table, ground, contacts, state, work, angles, speed, dt / parts)
            fine_left = fine_steps if _contacts_changed(work.load, loaded) else fine_left - 1
        if not np.isfinite(state.p.sum() + state.w.sum()):
            return step
        _keep_pose(pose[step], state)
        if len(legs):
            _keep_legs(legs[step], contacts, state, work, speed)
    return theta.shape[0] - 1


@inlined
def one_step(body, table, ground, contacts, state, work, theta, speed, dt):
    """Integrate one linearly implicit step; see `model.walk.kernel`.

    Args:
        body: The robot.
        table: The slip law.
        ground: The ground.
        contacts: Stiffness and damping of contacts.
        state: State at the start, overwritten with that at the end.
        work: Filled with the contacts of the step.
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
    for i in range(n):
        if work.load[i] == 0.0 or work.kind[i] == ROLLING:  # no bristle there
            state.stretch[i, 0] = state.stretch[i, 1] = state.stretch[i, 2] = 0.0
    for i in range(3):
        work.b[i], work.b[3 + i] = state.v[i], state.w[i]
    v, w, inertia, gyro = work.v, work.w, work.inertia, work.gyro
    _world_inertia(work.R, body.inertia, inertia)
    _gyroscopic(inertia, state.w, gyro)
    for solved in range(1, MOST_ROUNDS + 1):
        for i in range(3):
            v[i], w[i] = work.b[i], work.b[3 + i]
        _inertial_part(body.mass, inertia, gyro, state, dt, work.A, work.b)
        add_contact_forces(table, contacts, state, work, n, speed, dt)
        solve_positive(work.A, work.b, 6)
        if contacts_agree(contacts, work, n, dt) and solved >= ROUNDS:
            break
    for i in range(3):
        state.v[i], state.w[i] = work.b[i], work.b[3 + i]
        state.p[i] += dt * state.v[i]
    rotate(state.q, state.w, dt)
    if table.bristle:
        for i in range(n):
            _stretch_bristle(table, contacts, state, work, i, dt)


@inlined
def add_contact_forces(table, contacts, state, work, n, speed, dt):
    """Add the contact forces, linearised in the final velocities about a guess, to a step's system.

    Args:
        table: The slip law.
        contacts: Stiffness and damping of contacts.
        state: State at the step's start.
        work: The contacts and the guess; load and secant of each contact are filled in.
        n: Number of contacts.
        speed: Leg speeds in the step, shape (6,) [rad/s].
        dt: Length of the step [s].
    """
    k, c = contacts.stiffness, contacts.damping
    v, w, P, force, point = work.v, work.w, work.P, work.force, work.point
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
        x, y, z = point[0] - rise * m0, point[1] - rise * m1, point[2] - rise * m2
        if table.bristle and work.kind[i] != ROLLING:
            pull = bristle_pull(table, contacts, state.stretch[i], load, dt * x, dt * y, dt * z)
            G = pull * dt
        else:
            slip = np.sqrt(x * x + y * y + z * z)
            flow = abs(leg_turn(work.R, speed, w, i)) * work.flow[i] if i < N_LEGS else 0.0
            G, pull = traction_secant(table, work.kind[i], load, slip, flow), 0.0
            work.secant[i] = G
        push = -k * work.gap[i] - c * u_n
        for a in range(3):
            m_a = work.normal[i, a]
            force[a] = push * m_a - G * (work.velocity[i, a] - u_n * m_a)
            force[a] -= pull * state.stretch[i, a]
            for d in range(3):
                P[a, d] = (k * dt + c - G) * m_a * work.normal[i, d]
            P[a, a] += G
        add_contact(work.A, work.b, dt, work.place[i], P, force)


@inlined
def bristle_pull(table, contacts, stretch, load, x, y, z):
    """Compute a bristle's force over its stretch after a further slip of (x, y, z).

    It is the bristle's stiffness, or less where the force would exceed the largest traction: the
    bristle then slides at that limit.

    Args:
        table: The slip law.
        contacts: Stiffness and damping of contacts.
        stretch: Stretch of the bristle before, shape (3,) [m].
        load: Normal force of the contact [N].
        x: Further slip along x [m].
        y: Further slip along y [m].
        z: Further slip along z [m].

    Returns:
        Force over stretch [N/m].
    """
    stiffness = BRISTLE_STIFFNESS * contacts.stiffness
    size = np.sqrt((stretch[0] + x) ** 2 + (stretch[1] + y) ** 2 + (stretch[2] + z) ** 2)
    most = load * toe_traction(table, load)
    return most / size if stiffness * size > most else stiffness


@inlined
def contacts_agree(contacts, work, n, dt):
    """Compute the loads of the solved velocities; return whether the same contacts press as before.

    Args:
        contacts: Stiffness and damping of contacts.
        work: Arrays of the step with the solved velocities in `b`; loads are overwritten.
        n: Number of contacts.
        dt: Length of the step [s].
    """
    k, c = contacts.stiffness, contacts.damping
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
        Angular speed [rad/s].
    """
    return speed[i] + R[0, 1] * w[0] + R[1, 1] * w[1] + R[2, 1] * w[2]


@inlined
def _inertial_part(mass, inertia, gyro, state, dt, A, b):
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
def _stretch_bristle(table, contacts, state, work, i, dt):
    """Stretch a bristle by the step's slip; let it slide where the largest traction is reached."""
    if work.load[i] == 0.0 or work.kind[i] == ROLLING:
        return
    point, m = work.point, work.normal[i]
    point_velocity(state.v, state.w, work.place[i], work.velocity[i], point)
    rise = point[0] * m[0] + point[1] * m[1] + point[2] * m[2]
    stretched = 0.0
    for a in range(3):
        state.stretch[i, a] += dt * (point[a] - rise * m[a])
        stretched += state.stretch[i, a] ** 2
    longest = work.load[i] * toe_traction(table, work.load[i])
    longest /= BRISTLE_STIFFNESS * contacts.stiffness
    if np.sqrt(stretched) > longest:
        for a in range(3):
            state.stretch[i, a] *= longest / np.sqrt(stretched)


@inlined
def _copy(values, to):
    for i in range(len(values)):
        to[i] = values[i]


@inlined
def _keep_pose(out, state):
    for i in range(3):
        out[i] = state.p[i]
    for i in range(4):
        out[3 + i] = state.q[i]


@inlined
def _contacts_changed(load, loaded):
    changed = False
    for i in range(N_CONTACTS):
        changed |= (load[i] > 0) != (loaded[i] > 0)
    return changed


@inlined
def _world_inertia(R, principal, out):
    for i in range(3):
        for j in range(3):
            out[i, j] = 0.0
            for a in range(3):
                out[i, j] += R[i, a] * principal[a] * R[j, a]


@inlined
def _gyroscopic(inertia, w, out):
    """Compute the gyroscopic moment -w × (I w) [N m]."""
    L0 = inertia[0, 0] * w[0] + inertia[0, 1] * w[1] + inertia[0, 2] * w[2]
    L1 = inertia[1, 0] * w[0] + inertia[1, 1] * w[1] + inertia[1, 2] * w[2]
    L2 = inertia[2, 0] * w[0] + inertia[2, 1] * w[1] + inertia[2, 2] * w[2]
    out[0] = -(w[1] * L2 - w[2] * L1)
    out[1] = -(w[2] * L0 - w[0] * L2)
    out[2] = -(w[0] * L1 - w[1] * L0)


@inlined
def _keep_legs(out, contacts, state, work, speed):
    """Fill a step's row of `legs`; see `run_steps`."""
    R, point = work.R, work.point
    bristle = BRISTLE_STIFFNESS * contacts.stiffness
    for i in range(N_LEGS):
        out[i, :] = 0.0
        out[i, 5] = np.nan
        if work.load[i] == 0.0:
            continue
        m = work.normal[i]
        point_velocity(state.v, state.w, work.place[i], work.velocity[i], point)
        rise = point[0] * m[0] + point[1] * m[1] + point[2] * m[2]
        out[i, 0] = work.load[i]
        for a in range(3):
            point[a] -= rise * m[a]
        for a in range(2):
            out[i, 1 + a] = -work.secant[i] * point[a] - bristle * state.stretch[i, a]
            out[i, 3 + a] = point[a]
        if work.kind[i] == ROLLING:
            tilt = R[0, 0] * m[0] + R[1, 0] * m[1] + R[2, 0] * m[2]  # of the body over the ground
            along = point[0] * R[0, 0] + point[1] * R[1, 0] + point[2] * R[2, 0]
            forward = along / np.sqrt(1 - tilt**2)
            out[i, 5] = -forward / (leg_turn(R, speed, state.w, i) * work.flow[i])
