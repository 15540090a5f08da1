# SPDX-License-Identifier: MIT
"""Points at which legs and body may touch the ground, their gaps and velocities, compiled."""

import numpy as np

from model.compiled import inlined
from model.leg import HIP, ROLLING, TOE
from model.robot import N_LEGS
from model.walk.arrays import N_CONTACTS
from model.walk.deepest_point import deepest_point
from model.walk.ground import ground_at, is_even

NEAR = 0.01  # height over the ground below which the body's corners are computed [m]


@inlined
def lowest_point(theta, down_x, down_z, r, toe_cos, toe_sin):
    """Compute a leg's lowest point in its plane, from the hip, and whether it rolls.

    Args:
        theta: Leg angle: direction from the hip to the arc's centre [rad].
        down_x: Component of "down", into the ground, along the body's x axis [-].
        down_z: Component of "down" along the body's z axis [-].
        r: Radius of the arc [m].
        toe_cos: Cosine of the arc's angle beyond a half circle [-].
        toe_sin: Sine of that angle [-].

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
def find_contacts(body, ground, p, R, theta, speed, place, velocity, normal, gap, state, flow):
    """Compute the contact of each leg, the body's corners, and their gaps to the ground.

    On a plane a leg's contact is its lowest point towards the plane, on other ground the point of
    its arc that is deepest below the ground or nearest to it (`deepest_point`).

    Args:
        body: Robot as arrays; see `Body`.
        ground: The ground.
        p: Position of the body, shape (3,) [m].
        R: Rotation of the body, body to world, shape (3, 3).
        theta: Leg angles at the end of the step, shape (6,) [rad].
        speed: Leg speeds in the step, shape (6,) [rad/s].
        place: Filled: contact from the body's centre, world frame, shape (14, 3) [m].
        velocity: Filled: velocity of each material contact point relative to the body, world
            frame, shape (14, 3) [m/s].
        normal: Filled: normal of the ground, shape (14, 3) [-].
        gap: Filled: distance over the ground, negative below it, shape (14,) [m].
        state: Filled: HIP, ROLLING or TOE, for corners TOE, shape (14,).
        flow: Filled: arc radius where a leg rolls, else zero, shape (14,) [m].

    Returns:
        Number of contacts computed: 14, or 6 if every corner is more than `NEAR` above the highest
        ground; the rows of the corners are then left as they are.
    """
    # normal of the ground's plane, and "down" along the body's axes
    up = 1 / np.sqrt(1 + ground.slope_x**2 + ground.slope_y**2)
    m_x, m_y = -ground.slope_x * up, -ground.slope_y * up
    down_x = -(R[0, 0] * m_x + R[1, 0] * m_y + R[2, 0] * up)
    down_y = -(R[0, 1] * m_x + R[1, 1] * m_y + R[2, 1] * up)
    down_z = -(R[0, 2] * m_x + R[1, 2] * m_y + R[2, 2] * up)
    even = is_even(ground)
    over_plane = p[2] * up + p[0] * m_x + p[1] * m_y
    for i in range(N_LEGS):
        hip = body.hips[i]
        if even:
            x, z, state[i] = lowest_point(
                theta[i], down_x, down_z, body.leg_radius, body.toe_cos, body.toe_sin
            )
            gap[i] = over_plane - ground.height[0, 0] * up
            gap[i] -= (hip[0] + x) * down_x + hip[1] * down_y + (hip[2] + z) * down_z
            normal[i, 0], normal[i, 1], normal[i, 2] = m_x, m_y, up
        else:
            x, z, state[i], gap[i] = deepest_point(
                body, ground, p, R, hip, theta[i], down_x, down_z, normal[i]
            )
        _to_world(R, hip[0] + x, hip[1], hip[2] + z, place[i])
        _to_world(R, speed[i] * z, 0.0, -speed[i] * x, velocity[i])  # speed about y, times (x, z)
        flow[i] = body.leg_radius if state[i] == ROLLING else 0.0
    half = body.half_size
    reach = abs(down_x) * half[0] + abs(down_y) * half[1] + abs(down_z) * half[2]
    if over_plane - reach > ground.highest * up + NEAR:
        return N_LEGS
    for i in range(8):
        k = N_LEGS + i  # the bits of i are the corner's signs: 0 for plus
        sx, sy, sz = 1.0 - 2 * (i & 1), 1.0 - (i & 2), 1.0 - (i & 4) / 2
        _to_world(R, sx * half[0], sy * half[1], sz * half[2], place[k])
        velocity[k, :] = 0.0
        state[k], flow[k] = TOE, 0.0
        gap[k] = _gap(ground, p, place[k], normal[k])
    return N_CONTACTS


@inlined
def _to_world(R, x, y, z, out):
    """Rotate the body vector (x, y, z) to the world frame by R and fill `out` with it."""
    for a in range(3):
        out[a] = R[a, 0] * x + R[a, 1] * y + R[a, 2] * z


@inlined
def _gap(ground, p, place, normal):
    """Return a contact's distance over the ground along its normal [m], and fill `normal`."""
    h, normal[0], normal[1], normal[2] = ground_at(ground, p[0] + place[0], p[1] + place[1])
    return (p[2] + place[2] - h) * normal[2]


@inlined
def point_velocity(v, w, place, velocity, out):
    """Compute the world velocity of a material contact point from motion of body and leg.

    Args:
        v: Velocity of the body, shape (3,) [m/s].
        w: Angular velocity of the body in the world frame, shape (3,) [rad/s].
        place: Contact from the body's centre, world frame, shape (3,) [m].
        velocity: Velocity of the point relative to the body, world frame, shape (3,) [m/s].
        out: Filled: velocity of the point in the world frame, shape (3,) [m/s].
    """
    out[0] = v[0] + w[1] * place[2] - w[2] * place[1] + velocity[0]
    out[1] = v[1] + w[2] * place[0] - w[0] * place[2] + velocity[1]
    out[2] = v[2] + w[0] * place[1] - w[1] * place[0] + velocity[2]
