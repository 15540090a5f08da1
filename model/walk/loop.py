# SPDX-License-Identifier: MIT
"""The loop over the steps of a walk, with finer steps where contacts change, compiled."""

from typing import NamedTuple

import numpy as np

from model.arrays import Array
from model.compiled import borrowing, compiled, inlined
from model.leg import ROLLING
from model.robot import N_LEGS
from model.walk.anisotropy import sideways
from model.walk.arrays import (
    N_CONTACTS,
    Body,
    Contacts,
    State,
    Work,
    copy_state,
    new_state,
    new_work,
)
from model.walk.contact_points import point_velocity
from model.walk.ground import Ground
from model.walk.leg_work import add_work
from model.walk.step import leg_turn, one_step
from model.walk.traction import TractionTable

FINE_STEP = 0.0005  # s, where contacts change: both tripods are on the ground only for a short time
FINE_TIME = 0.005  # s, after a change


class Spare(NamedTuple):
    """Preallocated work arrays of the loop.

    Attributes:
        work: Work arrays of a step.
        before: State before a step.
        speed: Leg speeds in a step, shape (6,) [rad/s].
        angles: Leg angles at the end of a finer step, shape (6,) [rad].
        loaded: Loads before a step, shape (14,) [N].
        gain: Accelerations before a step, shape (6,).
        energy: Energies of a step, see `add_work`, shape (4,) [J].
    """

    work: Work
    before: State
    speed: Array
    angles: Array
    loaded: Array
    gain: Array
    energy: Array


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

    A step in which a contact begins or ends is repeated in steps of at most 0.5 ms. The steps of
    the 5 ms after it, and of the walk's first 5 ms, are as fine.

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
            x, y) and slip ratio of each leg, then a row for the body with the sum of the normal
            forces on its corners, the energies of the step (`add_work`) and zero, shape (n, 7, 6),
            or (0, 7, 6) not to keep them; a leg in the air has 0, and the ratio is NaN unless a leg
            rolls on the ground.

    Returns:
        Number of steps computed: n, or fewer where the state stopped being finite.
    """
    spare = Spare(
        new_work(), new_state(), np.empty(N_LEGS), np.empty(N_LEGS), np.zeros(N_CONTACTS),
        np.empty(6), np.empty(4),
    )  # fmt: skip
    return _steps(body, table, ground, contacts, state, theta, dt, pose, legs, spare)


@borrowing
def _steps(body, table, ground, contacts, state, theta, dt, pose, legs, spare):
    """Integrate a walk; arguments and result are those of `run_steps`, `spare` its work arrays."""
    work, before, speed, angles, loaded, gain, energy = spare
    keep = len(legs) > 0
    parts = max(int(np.ceil(dt / FINE_STEP - 1e-9)), 1)
    fine_steps = int(np.ceil(FINE_TIME / dt))
    fine_left = fine_steps
    for step in range(theta.shape[0] - 1):
        for i in range(N_LEGS):
            speed[i] = (theta[step + 1, i] - theta[step, i]) / dt
        copy_state(state, before)
        _copy(work.load, loaded)
        _copy(work.gain, gain)
        energy[:] = 0.0
        if fine_left == 0 or parts == 1:
            one_step(body, table, ground, contacts, state, work, theta[step + 1], speed, dt)
            if parts > 1 and _contacts_changed(work.load, loaded):  # undo it, and repeat it finely
                copy_state(before, state)
                _copy(loaded, work.load)
                _copy(gain, work.gain)
                fine_left = fine_steps
            elif keep:
                add_work(state, work, dt, energy)
        if fine_left > 0 and parts > 1:
            for part in range(parts):
                for i in range(N_LEGS):
                    angles[i] = theta[step, i] + (part + 1) / parts * dt * speed[i]
                one_step(body, table, ground, contacts, state, work, angles, speed, dt / parts)
                if keep:
                    add_work(state, work, dt / parts, energy)
            fine_left = fine_steps if _contacts_changed(work.load, loaded) else fine_left - 1
        if not np.isfinite(state.p.sum() + state.w.sum()):
            return step
        _keep_pose(pose[step], state)
        if keep:
            _keep_legs(legs[step], state, work, speed, energy)
    return theta.shape[0] - 1


@inlined
def _copy(values, to):
    """Copy a vector into another of the same length."""
    for i in range(len(values)):
        to[i] = values[i]


@inlined
def _contacts_changed(load, loaded):
    """Return whether any contact has load in only one of two arrays of loads, shape (14,)."""
    changed = False
    for i in range(N_CONTACTS):
        changed |= (load[i] > 0) != (loaded[i] > 0)
    return changed


@inlined
def _keep_pose(out, state):
    """Fill a row of shape (7,) with the state's position and quaternion."""
    for i in range(3):
        out[i] = state.p[i]
    for i in range(4):
        out[3 + i] = state.q[i]


@inlined
def _keep_legs(out, state, work, speed, energy):
    """Fill rows, shape (7, 6), of `run_steps`; a leg in the air has 0 and slip ratio NaN."""
    R, point = work.R, work.point
    out[N_LEGS, :] = 0.0
    for i in range(N_LEGS, N_CONTACTS):
        out[N_LEGS, 0] += work.load[i]
    for i in range(4):
        out[N_LEGS, 1 + i] = energy[i]
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
        lateral, across = work.lateral[i], work.across[i]
        more = work.secant[i] * sideways(lateral, across, point)
        for a in range(2):
            out[i, 1 + a] = -work.secant[i] * point[a] - more * across[a]
            out[i, 3 + a] = point[a]
        if work.kind[i] == ROLLING:
            tilt = R[0, 0] * m[0] + R[1, 0] * m[1] + R[2, 0] * m[2]  # of the body over the ground
            along = point[0] * R[0, 0] + point[1] * R[1, 0] + point[2] * R[2, 0]
            forward = along / np.sqrt(1 - tilt**2)
            out[i, 5] = -forward / (leg_turn(R, speed, state.w, i) * work.flow[i])
