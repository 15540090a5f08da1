# SPDX-License-Identifier: MIT
"""The loop over the steps of walks on flat ground, each walk at its own time, compiled.

Every walk goes by the rule of `model.walk.loop`: a long step in which a contact begins or ends is
repeated in fine steps. Walks side by side need not be fine at the same time. Each round of the loop
is one step of every walk, long or fine, and a walk that needs more of them ends later.
"""

import numpy as np

from model.compiled import borrowing, inlined
from model.lanes import put, row, select
from model.robot import N_LEGS
from model.walk.arrays import N_CONTACTS
from model.walk.flat import rows
from model.walk.flat.step import flat_step
from model.walk.leg_work import add_powers
from model.walk.loop import FINE_STEP, FINE_TIME

ENDED = -1  # in place of the number of fine steps left


@borrowing
def run_flat(A, each, laws, theta, dt, pose, legs, done, fine_left):
    """Integrate walks through leg angles at equal steps, by the rule of `model.walk.loop`.

    Args:
        A: The walks' rows, shape (N_ROWS, LANES) or (N_ROWS,): what is given once, and the states,
            which are overwritten with the final ones.
        each: The same memory as `A`, shape (N_ROWS, walks), to address one walk.
        laws: The slip laws.
        theta: Leg angles at every long step's start and the last one's end, shape
            (walks, n + 1, 6) [rad].
        dt: Length of a long step [s].
        pose: Filled at each step's end: position and quaternion, shape (walks, n, 7).
        legs: Filled at each step's end with rows of legs and body as in `run_steps`, shape
            (walks, n, 7, 6), or (walks, 0, 7, 6) not to keep them.
        done: Steps of each walk, zero at the start; filled with the number computed, which is less
            than n where the state stopped being finite, shape (walks,).
        fine_left: Work array of integers, shape (walks,).
    """
    n, walks = theta.shape[1] - 1, theta.shape[0]
    parts = max(int(np.ceil(dt / FINE_STEP - 1e-9)), 1)
    fine_steps = int(np.ceil(FINE_TIME / dt)) if parts > 1 else 0
    left, keep = walks, legs.shape[1] > 0
    if keep:
        legs[:, :, N_LEGS, :] = 0.0
    for walk in range(walks):
        fine_left[walk] = fine_steps
        begin_step(each, theta, dt, 0, walk, fine_left[walk] > 0, parts)
    while left > 0:
        prepare(A)
        flat_step(A, laws)
        compare(A)
        for walk in range(walks):
            if fine_left[walk] == ENDED:
                continue
            changed = each[rows.CHANGED, walk] > 0
            whole = each[rows.PARTS, walk] == 1
            if whole and parts > 1 and changed:
                fine_left[walk] = fine_steps
                restart(each, walk, parts)
                continue
            if keep:
                add_work(each, walk, legs[walk, done[walk], N_LEGS, 1:5])
            if not whole:
                each[rows.PART, walk] += 1.0
                if each[rows.PART, walk] < each[rows.PARTS, walk]:
                    each[rows.FRESH, walk] = 0.0
                    continue
                fine_left[walk] = fine_steps if changed else fine_left[walk] - 1
            step = done[walk]
            finite = is_finite(each, walk)
            if finite:
                for a in range(7):
                    pose[walk, step, a] = each[rows.P + a, walk]
                if keep:
                    keep_legs(each, walk, legs[walk, step])
                done[walk] = step + 1
            if finite and step + 1 < n:
                begin_step(each, theta, dt, step + 1, walk, fine_left[walk] > 0, parts)
            else:
                left -= 1
                fine_left[walk] = ENDED


@inlined
def begin_step(each, theta, dt, step, walk, fine, parts):
    """Set up the next long step of one walk, to be made at once or in `parts` fine steps."""
    for i in range(N_LEGS):
        each[rows.FROM + i, walk] = theta[walk, step, i]
        each[rows.TO + i, walk] = theta[walk, step + 1, i]
    each[rows.LONG_STEP, walk] = dt
    each[rows.PARTS, walk] = parts if fine else 1.0
    each[rows.PART, walk] = 0.0
    each[rows.FRESH, walk] = 1.0


@inlined
def restart(each, walk, parts):
    """Return one walk to the start of its long step, to be made in `parts` fine steps."""
    for i in range(rows.N_SAVED):
        each[rows.STATE + i, walk] = each[rows.BEFORE + i, walk]
    each[rows.PARTS, walk] = parts
    each[rows.PART, walk] = 0.0
    each[rows.FRESH, walk] = 1.0


@inlined
def prepare(A):
    """Compute length, leg angles and leg speeds of the next step, even over a long one.

    The states at a long step's start are saved.
    """
    fresh, whole, parts = row(A, rows.FRESH) == 1.0, row(A, rows.LONG_STEP), row(A, rows.PARTS)
    per_whole, once = 1.0 / whole, parts == 1.0
    for i in range(rows.N_SAVED):
        put(A, rows.BEFORE + i, select(fresh, row(A, rows.STATE + i), row(A, rows.BEFORE + i)))
    put(A, rows.DT, whole / parts)
    done = (row(A, rows.PART) + 1.0) / parts * whole
    for i in range(N_LEGS):
        before, after = row(A, rows.FROM + i), row(A, rows.TO + i)
        speed = (after - before) * per_whole
        put(A, rows.SPEED + i, speed)
        put(A, rows.ANGLE + i, select(once, after, before + done * speed))


@inlined
def compare(A):
    """Compare which contacts have load with those at the long step's start."""
    first = row(A, rows.LOAD) > 0.0
    changed = first ^ first
    for i in range(N_CONTACTS):
        now, then = row(A, rows.LOAD + i) > 0.0, row(A, rows.BEFORE + rows.N_STATE + i) > 0.0
        changed = changed | (now ^ then)
    put(A, rows.CHANGED, select(changed, row(A, rows.DT) * 0.0 + 1.0, 0.0))


@inlined
def keep_legs(each, walk, out):
    """Fill rows of legs and body of one walk's step, shape (7, 6), as in `run_steps`.

    The body's energies are left as they are.
    """
    for k in range(N_LEGS, N_CONTACTS):
        out[N_LEGS, 0] += each[rows.LOAD + k, walk]
    v0, v1, w0, w1 = motion_in_axes(each, walk)
    w2, R = each[rows.OMEGA + 2, walk], rows.R
    about_y = 0.0
    about_y += each[R + 1, walk] * w0
    about_y += each[R + 4, walk] * w1
    about_y += each[R + 7, walk] * w2
    c, s = each[rows.HEADING_COS, walk], each[rows.HEADING_SIN, walk]
    b = each[rows.LATERAL_SECANT, walk]
    for i in range(N_LEGS):
        out[i, :] = 0.0
        out[i, 5] = np.nan
        if each[rows.LOAD + i, walk] == 0.0:
            continue
        place, velocity = rows.PLACE + 3 * i, rows.VELOCITY + 3 * i
        x, y, z = each[place, walk], each[place + 1, walk], each[place + 2, walk]
        slip_x = v0 + w1 * z - w2 * y
        slip_y = v1 + w2 * x - w0 * z
        slip_x, slip_y = slip_x + each[velocity, walk], slip_y + each[velocity + 1, walk]
        out[i, 0] = each[rows.LOAD + i, walk]
        along, across = -each[rows.SECANT + i, walk] * slip_x, -each[rows.SECANT + i, walk] * slip_y
        across *= b
        out[i, 1], out[i, 2] = c * along - s * across, c * across + s * along
        out[i, 3], out[i, 4] = c * slip_x - s * slip_y, c * slip_y + s * slip_x
        if each[rows.ROLLS + i, walk] == 1.0:
            along = slip_x * each[R, walk] + slip_y * each[R + 3, walk]
            forward = along / np.sqrt(1 - each[R + 6, walk] ** 2)
            turn = each[rows.SPEED + i, walk] + about_y
            out[i, 5] = -forward / (turn * each[rows.RADIUS, walk])


@inlined
def add_work(each, walk, out):
    """Add the energies of one walk's step, shape (4,) [J], see `model.walk.leg_work.add_work`."""
    v0, v1, w0, w1 = motion_in_axes(each, walk)
    v2, w2 = each[rows.V + 2, walk], each[rows.OMEGA + 2, walk]
    for i in range(N_CONTACTS):
        load = each[rows.LOAD + i, walk]
        if load == 0.0:
            continue
        place, velocity = rows.PLACE + 3 * i, rows.VELOCITY + 3 * i
        x, y, z = each[place, walk], each[place + 1, walk], each[place + 2, walk]
        u0, u1, u2 = each[velocity, walk], each[velocity + 1, walk], each[velocity + 2, walk]
        s0 = v0 + w1 * z - w2 * y + u0
        s1 = v1 + w2 * x - w0 * z + u1
        rise = v2 + w0 * y - w1 * x + u2
        G = each[rows.SECANT + i, walk]
        b1 = s1 * each[rows.LATERAL_SECANT + i, walk]
        power = G * (s0 * u0 + b1 * u1) - load * u2
        add_powers(out, power, G * (s0 * s0 + b1 * s1), -load * rise, each[rows.DT, walk])


@inlined
def motion_in_axes(each, walk):
    """Return horizontal velocity and angular velocity of one walk in the axes of its last step."""
    c, s = each[rows.HEADING_COS, walk], each[rows.HEADING_SIN, walk]
    v0, v1 = each[rows.V, walk], each[rows.V + 1, walk]
    w0, w1 = each[rows.OMEGA, walk], each[rows.OMEGA + 1, walk]
    return c * v0 + s * v1, c * v1 - s * v0, c * w0 + s * w1, c * w1 - s * w0


@inlined
def is_finite(each, walk):
    """Return whether leg angles and speeds, position and angular velocity of one walk are finite.

    A leg whose angle is not finite would otherwise pass for one in the air.
    """
    total = 0.0
    for i in range(N_LEGS):
        total += each[rows.ANGLE + i, walk] + each[rows.SPEED + i, walk]
    for a in range(3):
        total += each[rows.P + a, walk] + each[rows.OMEGA + a, walk]
    return np.isfinite(total)
