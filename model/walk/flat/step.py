# SPDX-License-Identifier: MIT
r"""One step of walks on flat ground, compiled for one walk or for several side by side.

The equations are those of `model.walk.step` with the normal straight up, and so are the results but
for rounding. There each contact's matrix is diag(G, G, k dt + c), and the system's block of the
velocity is diagonal. The velocity is eliminated; three equations in the angular velocity remain,

.. math::
    \begin{pmatrix} D & C^T \\ C & B \end{pmatrix} \begin{pmatrix} v \\ w \end{pmatrix} =
    \begin{pmatrix} f \\ m \end{pmatrix}, \qquad (B - C D^{-1} C^T)\, w = m - C D^{-1} f .

There are no bristles here; walks with them are computed by `model.walk.step`.

Where traction differs along and across the legs' rolling direction, which is that of all legs, the
step is computed in axes along and across it. There a contact's matrix is diag(G, b G, k dt + c)
and all of the above holds. Other walks stay in world axes, at a heading of zero.
"""

from model.compiled import inlined
from model.elementary import sin_cos
from model.lanes import any_of, negated, put, root, row, select, size
from model.robot import GRAVITY, N_LEGS
from model.walk.anisotropy import ALONG_ONLY
from model.walk.arrays import N_CONTACTS
from model.walk.contact_points import NEAR
from model.walk.flat import rows
from model.walk.flat.law import secant
from model.walk.step import FOOT, MOST_ROUNDS, SETTLED, settling_error


@inlined
def flat_step(A, laws):
    """Advance every walk by one linearly implicit step of its own length.

    Args:
        A: The walks' rows: of the state and `GAIN`, which are overwritten, `DT`, and leg angles at
            the end and leg speeds. `LOAD` is filled with the contacts' normal forces.
        laws: The slip laws.
    """
    put_rotation(A)
    if laws.directed is not None:
        put_heading(A)
    find_legs(A)
    n = find_corners(A)
    dt, mass = row(A, rows.DT), row(A, rows.MASS)
    v0, v1 = in_axes(A, laws, row(A, rows.V), row(A, rows.V + 1))
    w0, w1 = in_axes(A, laws, row(A, rows.OMEGA), row(A, rows.OMEGA + 1))
    v2, w2 = row(A, rows.V + 2), row(A, rows.OMEGA + 2)
    I = world_inertia(A)  # noqa: E741 as in the equations
    L0 = I[0] * w0 + I[1] * w1 + I[3] * w2
    L1 = I[1] * w0 + I[2] * w1 + I[4] * w2
    L2 = I[3] * w0 + I[4] * w1 + I[5] * w2
    start = (
        mass * v0, mass * v1, mass * v2 - dt * mass * GRAVITY,
        L0 - dt * (w1 * L2 - w2 * L1), L1 - dt * (w2 * L0 - w0 * L2),
        L2 - dt * (w0 * L1 - w1 * L0),
    )  # fmt: skip
    left = row(A, rows.DAMPING) - dt * row(A, rows.STIFFNESS)
    put(A, rows.DAMPING_LEFT, select(left > 0.0, left, 0.0))
    g, done = rows.GAIN, dt < 0.0
    a0, a1 = in_axes(A, laws, row(A, g), row(A, g + 1))
    v0, v1, v2 = v0 + dt * a0, v1 + dt * a1, v2 + dt * row(A, g + 2)
    a0, a1 = in_axes(A, laws, row(A, g + 3), row(A, g + 4))
    w0, w1, w2 = w0 + dt * a0, w1 + dt * a1, w2 + dt * row(A, g + 5)
    for _ in range(MOST_ROUNDS):
        x = solved_velocities(A, laws, n, (v0, v1, v2, w0, w1, w2), I, start, done)
        d0, d1, d2, d3, d4, d5 = x[0] - v0, x[1] - v1, x[2] - v2, x[3] - w0, x[4] - w1, x[5] - w2
        turned = d3 * d3 + d4 * d4 + d5 * d5
        moved = root(d0 * d0 + d1 * d1 + d2 * d2 + FOOT * FOOT * turned)
        v0, v1, v2 = select(done, v0, x[0]), select(done, v1, x[1]), select(done, v2, x[2])
        w0, w1, w2 = select(done, w0, x[3]), select(done, w1, x[4]), select(done, w2, x[5])
        agree = contacts_agree(A, n, (v0, v1, v2, w0, w1, w2), done)
        done = done | (agree & (settling_error(moved, x[6], mass, dt) < SETTLED))
        if not any_of(negated(done)):
            break
    v0, v1 = in_world(A, laws, v0, v1)
    w0, w1 = in_world(A, laws, w0, w1)
    advance(A, (v0, v1, v2, w0, w1, w2))


@inlined
def put_rotation(A):
    """Compute the rotation of the body, body to world, from its quaternion."""
    w, x, y, z = row(A, rows.Q), row(A, rows.Q + 1), row(A, rows.Q + 2), row(A, rows.Q + 3)
    put(A, rows.R, 1.0 - 2.0 * (y * y + z * z))
    put(A, rows.R + 1, 2.0 * (x * y - w * z))
    put(A, rows.R + 2, 2.0 * (x * z + w * y))
    put(A, rows.R + 3, 2.0 * (x * y + w * z))
    put(A, rows.R + 4, 1.0 - 2.0 * (x * x + z * z))
    put(A, rows.R + 5, 2.0 * (y * z - w * x))
    put(A, rows.R + 6, 2.0 * (x * z - w * y))
    put(A, rows.R + 7, 2.0 * (y * z + w * x))
    put(A, rows.R + 8, 1.0 - 2.0 * (x * x + y * y))


@inlined
def put_heading(A):
    """Choose the axes of the step, and turn the rotation of the body to them.

    They are along and across the legs' rolling direction; for a body on its side those of the
    world.
    """
    x, y = row(A, rows.R + 1), row(A, rows.R + 4)
    square = x * x + y * y
    on_side = square < ALONG_ONLY * ALONG_ONLY
    per_length = 1.0 / root(select(on_side, 1.0, square))
    c, s = select(on_side, 1.0, y * per_length), select(on_side, 0.0, -x * per_length)
    put(A, rows.HEADING_COS, c)
    put(A, rows.HEADING_SIN, s)
    for a in range(3):
        x, y = row(A, rows.R + a), row(A, rows.R + 3 + a)
        put(A, rows.R + a, c * x + s * y)
        put(A, rows.R + 3 + a, c * y - s * x)


@inlined
def in_axes(A, laws, x, y):
    """Turn a horizontal vector of the world to the axes of the step."""
    if laws.directed is None:
        return x, y
    c, s = row(A, rows.HEADING_COS), row(A, rows.HEADING_SIN)
    return c * x + s * y, c * y - s * x


@inlined
def in_world(A, laws, x, y):
    """Turn a horizontal vector in the axes of the step to the world."""
    if laws.directed is None:
        return x, y
    c, s = row(A, rows.HEADING_COS), row(A, rows.HEADING_SIN)
    return c * x - s * y, c * y + s * x


@inlined
def put_turned(A, to, x, y, z):
    """Turn the body vector (x, y, z) to the axes of the step; store it in three rows from `to`."""
    for a in range(3):
        turned = row(A, rows.R + 3 * a) * x
        turned = turned + row(A, rows.R + 3 * a + 1) * y + row(A, rows.R + 3 * a + 2) * z
        put(A, to + a, turned)


@inlined
def find_legs(A):
    """Compute place, velocity, gap and kind of the lowest point of every leg.

    The cases are those of `model.walk.contact_points.lowest_point`.
    """
    down_x, down_z = -row(A, rows.R + 6), -row(A, rows.R + 8)
    per_length = 1.0 / root(down_x * down_x + down_z * down_z)
    dx, dz = down_x * per_length, down_z * per_length
    r, toe_cos, toe_sin = row(A, rows.RADIUS), row(A, rows.TOE_COS), row(A, rows.TOE_SIN)
    above = row(A, rows.P + 2) - row(A, rows.HEIGHT)
    no = r * 0.0
    for i in range(N_LEGS):
        s, c = sin_cos(row(A, rows.ANGLE + i))
        cos_phi, sin_phi = dx * c - dz * s, -(dx * s + dz * c)
        long_arc = (sin_phi >= 0.0) | (cos_phi >= toe_cos)
        short_arc = (sin_phi >= 0.0) & (cos_phi <= toe_cos)
        rolls = ((toe_sin >= 0.0) & long_arc) | ((toe_sin < 0.0) & short_arc)
        toe_x = r * (c + c * toe_cos + s * toe_sin)
        toe_z = -r * (s + s * toe_cos - c * toe_sin)
        on_toe = toe_x * dx + toe_z * dz >= 0.0
        x = select(rolls, r * (c + dx), select(on_toe, toe_x, no))
        z = select(rolls, r * (dz - s), select(on_toe, toe_z, no))
        put(A, rows.ROLLS + i, select(rolls, no + 1.0, no))
        hip, place, speed = rows.HIPS + 3 * i, rows.PLACE + 3 * i, row(A, rows.SPEED + i)
        put_turned(A, place, row(A, hip) + x, row(A, hip + 1), row(A, hip + 2) + z)
        put_turned(A, rows.VELOCITY + 3 * i, speed * z, no, -speed * x)
        put(A, rows.GAP + i, above + row(A, place + 2))


@inlined
def find_corners(A):
    """Compute the corners of the body if any walk's body is near the ground.

    Returns:
        Number of contacts: 14, or 6 if every corner of every walk is more than `NEAR` above the
        ground; loads of the corners are then zero.
    """
    half = rows.HALF_SIZE
    reach = size(row(A, rows.R + 6)) * row(A, half) + size(row(A, rows.R + 7)) * row(A, half + 1)
    reach = reach + size(row(A, rows.R + 8)) * row(A, half + 2)
    above = row(A, rows.P + 2) - row(A, rows.HEIGHT)
    near = above - reach <= NEAR
    no = reach * 0.0
    if not any_of(near):
        for k in range(N_LEGS, N_CONTACTS):
            put(A, rows.LOAD + k, no)
            put(A, rows.SECANT + k, no)
        return N_LEGS
    for i in range(8):
        k = N_LEGS + i
        sx, sy, sz = 1.0 - 2 * (i & 1), 1.0 - (i & 2), 1.0 - (i & 4) / 2
        place = rows.PLACE + 3 * k
        put_turned(A, place, sx * row(A, half), sy * row(A, half + 1), sz * row(A, half + 2))
        for a in range(3):
            put(A, rows.VELOCITY + 3 * k + a, no)
        put(A, rows.ROLLS + k, no)
        put(A, rows.GAP + k, select(near, above + row(A, place + 2), no + 1e3))
    return N_CONTACTS


@inlined
def world_inertia(A):
    """Compute R diag(principal) R', the inertia in the step's axes, lower half by rows [kg m2]."""
    i0, i1, i2 = row(A, rows.INERTIA), row(A, rows.INERTIA + 1), row(A, rows.INERTIA + 2)
    a0, a1, a2 = row(A, rows.R), row(A, rows.R + 1), row(A, rows.R + 2)
    b0, b1, b2 = row(A, rows.R + 3), row(A, rows.R + 4), row(A, rows.R + 5)
    c0, c1, c2 = row(A, rows.R + 6), row(A, rows.R + 7), row(A, rows.R + 8)
    return (
        a0 * i0 * a0 + a1 * i1 * a1 + a2 * i2 * a2,
        b0 * i0 * a0 + b1 * i1 * a1 + b2 * i2 * a2,
        b0 * i0 * b0 + b1 * i1 * b1 + b2 * i2 * b2,
        c0 * i0 * a0 + c1 * i1 * a1 + c2 * i2 * a2,
        c0 * i0 * b0 + c1 * i1 * b1 + c2 * i2 * b2,
        c0 * i0 * c0 + c1 * i1 * c1 + c2 * i2 * c2,
    )


@inlined
def load_of(A, i, rise):
    """Compute the normal force of contact i at the step's end, negative where it would pull [N].

    Args:
        A: The walks' rows.
        i: Index of the contact.
        rise: Upward velocity of the material contact point [m/s].
    """
    by_body = rise - row(A, rows.VELOCITY + 3 * i + 2)
    sunk = row(A, rows.GAP + i) + row(A, rows.DT) * by_body
    return -(row(A, rows.STIFFNESS) * sunk + row(A, rows.DAMPING_LEFT) * rise)


@inlined
def solved_velocities(A, laws, n, guess, I, start, done):  # noqa: E741 as in the equations
    """Solve for the final velocities with contact forces linearised about a guess of them.

    Args:
        A: The walks' rows; `LOAD` and `SECANT` are filled where not done.
        laws: The slip laws.
        n: Number of contacts.
        guess: Velocity and angular velocity of the body, six numbers.
        I: Inertia in the axes of the step, lower half by rows.
        start: Right side of the system without contacts.
        done: Walks that keep their loads and secants.

    Returns:
        Velocity and angular velocity of the body at the step's end, six numbers, and the sum of
        the contacts' larger secants [N s/m].
    """
    v0, v1, v2, w0, w1, w2 = guess
    b0, b1, b2, b3, b4, b5 = start
    I00, I10, I11, I20, I21, I22 = I
    dt, k, c = row(A, rows.DT), row(A, rows.STIFFNESS), row(A, rows.DAMPING_LEFT)
    turn = row(A, rows.R + 1) * w0 + row(A, rows.R + 4) * w1 + row(A, rows.R + 7) * w2
    d = row(A, rows.MASS)  # and sums of g along, h across the rolling direction, and q upwards
    held, e, xh, yg, zg, xq, yq = d * 0.0, d, d * 0.0, d * 0.0, d * 0.0, d * 0.0, d * 0.0
    across, zh = d, zg
    for i in range(n):
        place, velocity = rows.PLACE + 3 * i, rows.VELOCITY + 3 * i
        x, y, z = row(A, place), row(A, place + 1), row(A, place + 2)
        u0, u1, u2 = row(A, velocity), row(A, velocity + 1), row(A, velocity + 2)
        load = load_of(A, i, v2 + w0 * y - w1 * x + u2)
        pressed = load > 0.0
        load = select(pressed, load, 0.0)
        put(A, rows.LOAD + i, select(done, row(A, rows.LOAD + i), load))
        if not any_of(pressed):
            put(A, rows.SECANT + i, select(done, row(A, rows.SECANT + i), load))
            continue
        s0, s1 = v0 + w1 * z - w2 * y + u0, v1 + w2 * x - w0 * z + u1
        if laws.directed is not None:
            s1 = row(A, rows.LATERAL_SLIP + i) * s1
        slip = root(s0 * s0 + s1 * s1)
        speed = turn + row(A, rows.SPEED + i) if i < N_LEGS else turn * 0.0
        rolls = row(A, rows.ROLLS + i) == 1.0
        G = secant(A, laws, rolls, pressed, load, slip, speed, row(A, rows.RADIUS))
        G = select(pressed, G, 0.0)
        put(A, rows.SECANT + i, select(done, row(A, rows.SECANT + i), G))
        push = select(pressed, -dt * (k * row(A, rows.GAP + i) + c * u2), 0.0)
        q, g = select(pressed, dt * (k * dt + c), 0.0), dt * G
        h, largest = g, G
        if laws.directed is not None:
            b = row(A, rows.LATERAL_SECANT + i)
            h, largest = b * g, select(b > 1.0, b * G, G)
        held = held + largest
        f0, f1 = -g * u0, -h * u1
        b0, b1, b2 = b0 + f0, b1 + f1, b2 + push
        b3, b4, b5 = b3 + y * push - z * f1, b4 + z * f0 - x * push, b5 + x * f1 - y * f0
        d, e = d + g, e + q
        hx, gy, gz, qx, qy = h * x, g * y, g * z, q * x, q * y
        xh, yg, zg, xq, yq = xh + hx, yg + gy, zg + gz, xq + qx, yq + qy
        hz = gz
        if laws.directed is not None:
            hz = h * z
            across, zh = across + h, zh + hz
        I00, I11, I22 = I00 + y * qy + z * hz, I11 + x * qx + z * gz, I22 + x * hx + y * gy
        I10, I20, I21 = I10 - x * qy, I20 - x * hz, I21 - y * gz
    if laws.directed is None:
        across, zh = d, zg
    d, across, e = 1.0 / d, 1.0 / across, 1.0 / e
    xa, yd, zd, za, xe, ye = xh * across, yg * d, zg * d, zh * across, xq * e, yq * e
    b3, b4, b5 = b3 + za * b1 - ye * b2, b4 - zd * b0 + xe * b2, b5 + yd * b0 - xa * b1
    w0, w1, w2 = _solve_three(
        I00 - zh * za - yq * ye, I10 + xq * ye, I11 - zg * zd - xq * xe, I20 + xh * za,
        I21 + yg * zd, I22 - xh * xa - yg * yd, b3, b4, b5,
    )  # fmt: skip
    return (
        b0 * d - zd * w1 + yd * w2, b1 * across + za * w0 - xa * w2, b2 * e - ye * w0 + xe * w1,
        w0, w1, w2, held,
    )  # fmt: skip


@inlined
def _solve_three(a, b, c, d, e, f, x, y, z):
    """Solve a symmetric positive definite system of three by LDL' factorisation.

    The matrix has the lower half a; b, c; d, e, f, and the right side is x, y, z.
    """
    first = 1.0 / a
    b1, d1 = b * first, d * first
    second = 1.0 / (c - b * b1)
    e = e - d * b1
    e1 = e * second
    third = 1.0 / (f - d * d1 - e * e1)
    y = y - b1 * x
    z = (z - d1 * x - e1 * y) * third
    y = y * second - e1 * z
    return x * first - b1 * y - d1 * z, y, z


@inlined
def contacts_agree(A, n, motion, done):
    """Compute loads at the solved velocities; return whether contacts press as assumed.

    Args:
        A: The walks' rows; `LOAD` is compared, then overwritten where not done.
        n: Number of contacts.
        motion: Velocity and angular velocity of the body at the step's end, in its axes.
        done: Walks that keep their loads.
    """
    v2, w0, w1 = motion[2], motion[3], motion[4]
    agree = v2 == v2
    agree = agree | negated(agree)  # true, also for velocities that are not finite
    for i in range(n):
        place = rows.PLACE + 3 * i
        rise = v2 + w0 * row(A, place + 1) - w1 * row(A, place)
        load = load_of(A, i, rise + row(A, rows.VELOCITY + 3 * i + 2))
        before = row(A, rows.LOAD + i)
        pressed = load > 0.0
        agree = agree & negated(pressed ^ (before > 0.0))
        put(A, rows.LOAD + i, select(done, before, select(pressed, load, 0.0)))
    return agree


@inlined
def advance(A, motion):
    """Store the final velocities and accelerations; move and turn the body for the step."""
    dt = row(A, rows.DT)
    for a in range(3):
        put(A, rows.GAIN + a, (motion[a] - row(A, rows.V + a)) / dt)
        put(A, rows.GAIN + 3 + a, (motion[3 + a] - row(A, rows.OMEGA + a)) / dt)
        put(A, rows.V + a, motion[a])
        put(A, rows.OMEGA + a, motion[3 + a])
        put(A, rows.P + a, row(A, rows.P + a) + dt * motion[a])
    w0, w1, w2 = motion[3], motion[4], motion[5]
    rate = root(w0 * w0 + w1 * w1 + w2 * w2)
    half = 0.5 * rate * dt
    sine, cosine = sin_cos(half)
    # sin(half) / rate, and its series where the angle is small
    s = select(half < 5e-5, 0.5 * dt * (1.0 - half * half / 6.0), sine / rate)
    b, c, d = s * w0, s * w1, s * w2
    q0, q1, q2, q3 = row(A, rows.Q), row(A, rows.Q + 1), row(A, rows.Q + 2), row(A, rows.Q + 3)
    n0, n1 = cosine * q0 - b * q1 - c * q2 - d * q3, cosine * q1 + b * q0 + c * q3 - d * q2
    n2, n3 = cosine * q2 - b * q3 + c * q0 + d * q1, cosine * q3 + b * q2 - c * q1 + d * q0
    one = 1.0 / root(n0 * n0 + n1 * n1 + n2 * n2 + n3 * n3)
    put(A, rows.Q, n0 * one)
    put(A, rows.Q + 1, n1 * one)
    put(A, rows.Q + 2, n2 * one)
    put(A, rows.Q + 3, n3 * one)
