# SPDX-License-Identifier: MIT
r"""One step of the rigid body on compliant contacts, compiled.

Unknowns of a step are the velocity v and angular velocity w of the body at its end. Normal force
and traction of every contact are taken there, linear in them,

.. math::
    N_i' = -k (g_i + \Delta t\, n_i \cdot J_i v') - c\, n_i \cdot (J_i v' + u_i), \qquad
    T_i' = -G_i (J_i v' + u_i)_t,

with gap g, normal n, contact Jacobian J, the leg's own velocity u at its contact, and the secant
G of the slip law. This gives a symmetric positive definite 6x6 system. A few iterations determine
which contacts press and what G is. No contact pulls, and traction opposes slip whatever the step.
The step is therefore stable at any length, unlike the explicit step of the thesis.
"""

import numpy as np

from model.compiled import inlined
from model.leg import HIP, ROLLING, TOE
from model.robot import N_LEGS

N_CONTACTS = N_LEGS + 8  # legs, then the corners of the body
NEAR = 0.01  # height over the ground below which the body's corners are computed [m]


@inlined
def rotation_matrix(q, R):
    """Compute the rotation matrix of a unit quaternion, body to world.

    Args:
        q: Unit quaternion (w, x, y, z), shape (4,).
        R: Filled: rotation matrix, shape (3, 3).
    """
    w, x, y, z = q
    R[0, 0], R[0, 1], R[0, 2] = 1 - 2 * (y * y + z * z), 2 * (x * y - w * z), 2 * (x * z + w * y)
    R[1, 0], R[1, 1], R[1, 2] = 2 * (x * y + w * z), 1 - 2 * (x * x + z * z), 2 * (y * z - w * x)
    R[2, 0], R[2, 1], R[2, 2] = 2 * (x * z - w * y), 2 * (y * z + w * x), 1 - 2 * (x * x + y * y)


@inlined
def rotate(q, w, dt):
    """Integrate an orientation quaternion over one step at constant angular velocity.

    Args:
        q: Unit quaternion (w, x, y, z), updated in place, shape (4,).
        w: Angular velocity in the world frame, shape (3,) [rad/s].
        dt: Length of the step [s].
    """
    angle = np.sqrt(w[0] ** 2 + w[1] ** 2 + w[2] ** 2) * dt
    half = 0.5 * angle
    s = 0.5 * dt * (1 - half * half / 6) if angle < 1e-4 else np.sin(half) / angle * dt
    a, b, c, d = np.cos(half), s * w[0], s * w[1], s * w[2]
    q0, q1, q2, q3 = q
    q[0] = a * q0 - b * q1 - c * q2 - d * q3
    q[1] = a * q1 + b * q0 + c * q3 - d * q2
    q[2] = a * q2 - b * q3 + c * q0 + d * q1
    q[3] = a * q3 + b * q2 - c * q1 + d * q0
    size = np.sqrt(q[0] ** 2 + q[1] ** 2 + q[2] ** 2 + q[3] ** 2)
    for i in range(4):
        q[i] /= size


@inlined
def lowest_point(theta, down_x, down_z, r, toe_cos, toe_sin):
    """Find a leg's lowest point in its plane, from the hip, with its state.

    Args:
        theta: Leg angle: direction from the hip to the arc's centre [rad].
        down_x: Component of "down", into the ground, along the body's x axis [-].
        down_z: Component of "down" along the body's z axis [-].
        r: Radius of the arc [m].
        toe_cos: Cosine of the arc's angle beyond a half circle [-].
        toe_sin: Its sine [-].

    Returns:
        x and z from the hip in the body frame [m], and HIP, ROLLING or TOE.
    """
    c, s = np.cos(theta), np.sin(theta)
    size = np.sqrt(down_x**2 + down_z**2)
    dx, dz = down_x / size, down_z / size
    # phi is the angle back along the arc from the point opposite the hip to the bottom; the arc
    # runs from the toe, as far on the other side as the arc is more than a half circle, to pi.
    cos_phi = dx * c - dz * s
    sin_phi = -(dx * s + dz * c)
    if toe_sin >= 0:
        on_arc = sin_phi >= 0 or cos_phi >= toe_cos
    else:
        on_arc = sin_phi >= 0 and cos_phi <= toe_cos
    if on_arc:
        return r * (c + dx), r * (-s + dz), ROLLING
    # The hip is the arc's other end, at the origin.
    toe_x = r * (c + c * toe_cos + s * toe_sin)
    toe_z = -r * (s + s * toe_cos - c * toe_sin)
    if toe_x * dx + toe_z * dz >= 0:
        return toe_x, toe_z, TOE
    return 0.0, 0.0, HIP


@inlined
def ground_at(ground, x, y):
    """Interpolate height and unit normal of the ground at a place, bilinearly.

    Args:
        ground: The ground.
        x: x of the place [m].
        y: y of the place [m].

    Returns:
        Height [m] and the normal's components nx, ny, nz [-].
    """
    height = ground.height
    if height.size == 1:
        return height[0, 0], 0.0, 0.0, 1.0
    m, n = height.shape
    at_x, at_y = (x - ground.x) / ground.step, (y - ground.y) / ground.step
    fx = min(max(at_x, 0.0), m - 1.000001)  # within the last cell, for its far neighbours
    fy = min(max(at_y, 0.0), n - 1.000001)
    i, j = int(fx), int(fy)
    a, b = fx - i, fy - j
    h00, h10, h01, h11 = height[i, j], height[i + 1, j], height[i, j + 1], height[i + 1, j + 1]
    h = (1 - a) * ((1 - b) * h00 + b * h01) + a * ((1 - b) * h10 + b * h11)
    sx = ((1 - b) * (h10 - h00) + b * (h11 - h01)) / ground.step
    sy = ((1 - a) * (h01 - h00) + a * (h11 - h10)) / ground.step
    if at_x < 0 or at_x > m - 1:  # beyond the edge its height continues, with zero slope
        sx = 0.0
    if at_y < 0 or at_y > n - 1:
        sy = 0.0
    size = np.sqrt(1 + sx * sx + sy * sy)
    return h, -sx / size, -sy / size, 1 / size


@inlined
def plane_under(ground, x, y, reach):
    """Compute the unit normal of the mean plane of the ground within reach of a place.

    A leg stands on what its arc spans. The normal at a single point would tilt the leg at every
    edge of the ground.

    Args:
        ground: The ground.
        x: x of the place [m].
        y: y of the place [m].
        reach: Distance to either side over which slopes are taken [m].

    Returns:
        Components nx, ny, nz of the normal [-].
    """
    if ground.height.size == 1:
        return 0.0, 0.0, 1.0
    sx = ground_at(ground, x + reach, y)[0] - ground_at(ground, x - reach, y)[0]
    sy = ground_at(ground, x, y + reach)[0] - ground_at(ground, x, y - reach)[0]
    sx, sy = sx / (2 * reach), sy / (2 * reach)
    size = np.sqrt(1 + sx * sx + sy * sy)
    return -sx / size, -sy / size, 1 / size


@inlined
def table_value(table, load, x):
    """Interpolate traction over load in a table; see `TractionTable`.

    Args:
        table: The table.
        load: Normal force, positive [N].
        x: Slip ratio, or slip velocity over `speed_scale`; not negative [-].

    Returns:
        Traction over load [-].
    """
    w = np.arcsinh(x / table.scale)
    place = min(w / table.step, table.phi.shape[1] - 1.000001)
    j = int(place)
    a = place - j
    row, b = load_row(table, load)
    value = hermite(table.phi[row], table.slope[row], j, a, table.step)
    if b > 0:
        above = hermite(table.phi[row + 1], table.slope[row + 1], j, a, table.step)
        value += b * (above - value)
    return value


@inlined
def load_row(table, load):
    """Find the table's row below a load, and the load's interpolation weight.

    Args:
        table: The table.
        load: Normal force, positive [N].

    Returns:
        Index of the row, and weight of the next row, from 0 to 1 [-].
    """
    m = len(table.log_load)
    if m == 1:
        return 0, 0.0
    first = table.log_load[0]
    place = max((np.log(load) - first) / (table.log_load[1] - first), 0.0)
    row = min(int(place), m - 2)
    return row, min(place - row, 1.0)


@inlined
def hermite(phi, slope, j, a, step):
    """Interpolate between columns j and j + 1 of a table's row by a cubic Hermite polynomial.

    Args:
        phi: Values of the columns, shape (n,).
        slope: Their derivatives, shape (n,).
        j: Index of the column to the left.
        a: Position between the two columns, from 0 to 1 [-].
        step: Distance of the columns.
    """
    p0, p1, m0, m1 = phi[j], phi[j + 1], slope[j] * step, slope[j + 1] * step
    d = p1 - p0
    return p0 + a * (m0 + a * (3 * d - 2 * m0 - m1 + a * (m0 + m1 - 2 * d)))


@inlined
def traction_secant(table, state, load, slip_speed, flow_speed):
    """Compute traction over slip velocity of one contact [N s/m].

    Args:
        table: The tabulated law.
        state: ROLLING, or a point that does not roll.
        load: Normal force [N].
        slip_speed: Speed of the material contact point over the ground [m/s].
        flow_speed: Speed at which the leg's arc passes the contact [m/s].
    """
    v0 = table.speed_scale  # also keeps finite the slip ratio of a leg that does not turn
    if table.by_velocity or state != ROLLING:
        return load * toe_traction(table, load) / np.sqrt(slip_speed**2 + v0**2)
    flow = np.sqrt(flow_speed**2 + v0**2)
    x = max(slip_speed / flow, 1e-9)  # the secant's limit at no slip is the law's slope
    return load * table_value(table, load, x) / (x * flow)


@inlined
def toe_traction(table, load):
    """Compute the largest traction over load of a leg on its toe [-].

    Args:
        table: The slip law.
        load: Normal force, positive [N].
    """
    row, b = load_row(table, load)
    value = table.toe[row]
    if b > 0:
        value += b * (table.toe[row + 1] - value)
    return value


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


@inlined
def find_contacts(body, ground, p, R, theta, speed, place, velocity, normal, gap, state, flow):
    """Find the potential contact of each leg and body corner, and its distance from the ground.

    Args:
        body: Robot as arrays; see `Body`.
        ground: The ground.
        p: Position of the body, shape (3,) [m].
        R: Its rotation, body to world, shape (3, 3).
        theta: Leg angles at the end of the step, shape (6,) [rad].
        speed: Leg speeds in the step, shape (6,) [rad/s].
        place: Filled: contact from the body's centre, world frame, shape (14, 3) [m].
        velocity: Filled: velocity of the material point relative to the body, world frame,
            shape (14, 3) [m/s].
        normal: Filled: normal of the ground, shape (14, 3) [-].
        gap: Filled: distance over the ground, negative below it, shape (14,) [m].
        state: Filled: HIP, ROLLING or TOE, shape (14,).
        flow: Filled: arc radius where a leg rolls, shape (14,) [m].

    Returns:
        Number of contacts computed: the corners only where the body comes near the ground.
    """
    for i in range(N_LEGS):
        hip = body.hips[i]
        _to_world(R, hip[0], hip[1], hip[2], place[i])
        n_x, n_y, n_z = plane_under(ground, p[0] + place[i, 0], p[1] + place[i, 1], body.leg_radius)
        down_x = -(R[0, 0] * n_x + R[1, 0] * n_y + R[2, 0] * n_z)
        down_z = -(R[0, 2] * n_x + R[1, 2] * n_y + R[2, 2] * n_z)
        x, z, state[i] = lowest_point(
            theta[i], down_x, down_z, body.leg_radius, body.toe_cos, body.toe_sin
        )
        _to_world(R, hip[0] + x, hip[1], hip[2] + z, place[i])
        _to_world(R, speed[i] * z, 0.0, -speed[i] * x, velocity[i])  # speed about y, times (x, z)
        flow[i] = body.leg_radius if state[i] == ROLLING else 0.0
        gap[i] = _gap(ground, p, place[i], normal[i])
    half = body.half_size
    reach = abs(R[2, 0]) * half[0] + abs(R[2, 1]) * half[1] + abs(R[2, 2]) * half[2]
    if p[2] - reach > ground.highest + NEAR:
        return N_LEGS
    for i in range(8):
        k = N_LEGS + i
        sx, sy, sz = 1.0 - 2 * (i & 1), 1.0 - (i & 2), 1.0 - (i & 4) / 2
        _to_world(R, sx * half[0], sy * half[1], sz * half[2], place[k])
        velocity[k, :] = 0.0
        state[k], flow[k] = TOE, 0.0
        gap[k] = _gap(ground, p, place[k], normal[k])
    return N_CONTACTS


@inlined
def _to_world(R, x, y, z, out):
    for a in range(3):
        out[a] = R[a, 0] * x + R[a, 1] * y + R[a, 2] * z


@inlined
def _gap(ground, p, place, normal):
    h, normal[0], normal[1], normal[2] = ground_at(ground, p[0] + place[0], p[1] + place[1])
    return (p[2] + place[2] - h) * normal[2]


@inlined
def point_velocity(v, w, place, velocity, out):
    """Compute the velocity of a material contact point from those of body and leg.

    Args:
        v: Velocity of the body, shape (3,) [m/s].
        w: Angular velocity of the body in the world frame, shape (3,) [rad/s].
        place: Contact from the body's centre, world frame, shape (3,) [m].
        velocity: Velocity of the point relative to the body, world frame, shape (3,) [m/s].
        out: Filled: velocity of the point, shape (3,) [m/s].
    """
    out[0] = v[0] + w[1] * place[2] - w[2] * place[1] + velocity[0]
    out[1] = v[1] + w[2] * place[0] - w[0] * place[2] + velocity[1]
    out[2] = v[2] + w[0] * place[1] - w[1] * place[0] + velocity[2]


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
