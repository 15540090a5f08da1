# SPDX-License-Identifier: MIT
r"""Where a leg touches uneven ground: the point of its arc that is deepest below it, compiled.

Points of the circle of the arc lie in the leg's plane in the direction psi from its centre,

.. math::
    q(\psi) = c + r\,(\cos\psi\; e_x - \sin\psi\; e_z),

with the body's axes e_x, e_z. Depth is vertical, the ground's height at q less that of q. On the
arc it is largest where the arc and the ground have a common tangent, at an edge of the ground, or
at an end of the arc. It is therefore computed at both ends, and at angles so close that no cell of
the grid is left out; around the best of these it is refined.

A leg that rolls has the normal that is square to the arc and to the ground across the leg. An end
of the arc has the normal of the ground.
"""

import numpy as np

from model.compiled import borrowing, inlined
from model.leg import HIP, ROLLING, TOE
from model.walk.ground import height_and_slopes

WINDOW = np.radians(75.0)  # to either side of the point lowest over the plane: steeper is no ground
SPACING = np.radians(2.0), np.radians(10.0)  # least and largest angle between points of the arc
REFINED = 12  # halvings (golden section) between neighbouring points: below a micrometre of depth
FAR = 0.005  # m over the ground from which on a point is not refined
GOLDEN = 0.5 * (np.sqrt(5.0) - 1.0)


@borrowing  # not inlined: flat ground, which does not need it, stays as fast as it is without
def deepest_point(body, ground, p, R, hip, theta, down_x, down_z, normal):
    """Find the point of a leg's arc that is deepest below the ground, or nearest above it.

    Args:
        body: Robot as arrays; see `Body`.
        ground: The ground.
        p: Position of the body, shape (3,) [m].
        R: Rotation of the body, body to world, shape (3, 3).
        hip: Hip in the body frame, shape (3,) [m].
        theta: Leg angle [rad].
        down_x: Component of "down", into the ground's plane, along the body's x axis [-].
        down_z: Component of "down" along the body's z axis [-].
        normal: Filled: normal of the contact, shape (3,) [-].

    Returns:
        x and z from the hip in the body frame [m], HIP, ROLLING or TOE, and the distance over the
        ground along the normal, negative below it [m].
    """
    r, beyond = body.leg_radius, np.arctan2(body.toe_sin, body.toe_cos)
    arc = np.pi + beyond
    toe = theta - beyond
    centre_x, centre_z = hip[0] + r * np.cos(theta), hip[2] - r * np.sin(theta)
    y = hip[1]
    state, best = HIP, theta + np.pi
    deepest = _depth(ground, p, R, centre_x, y, centre_z, r, best)
    depth = _depth(ground, p, R, centre_x, y, centre_z, r, toe)
    if depth > deepest:
        state, best, deepest = TOE, toe, depth
    middle = np.arctan2(-down_z, down_x)
    spacing = min(max(ground.step / r, SPACING[0]), SPACING[1])
    count = int(np.ceil(WINDOW / spacing))
    for k in range(-count, count + 1):
        psi = middle + k * spacing
        if (psi - toe) % (2 * np.pi) <= arc:
            depth = _depth(ground, p, R, centre_x, y, centre_z, r, psi)
            if depth > deepest:
                state, best, deepest = ROLLING, psi, depth
    if deepest > -FAR:
        from_toe = 0.0 if state == TOE else arc if state == HIP else (best - toe) % (2 * np.pi)
        low, high = best - min(spacing, from_toe), best + min(spacing, arc - from_toe)
        psi, depth = _refined(ground, p, R, centre_x, y, centre_z, r, low, high)
        if depth > deepest:
            state, best, deepest = ROLLING, psi, depth
    c, s = np.cos(best), np.sin(best)
    x, z = centre_x + r * c, centre_z - r * s
    _contact_normal(ground, p, R, x, y, z, c, s, state == ROLLING, normal)
    return x - hip[0], z - hip[2], state, -deepest * normal[2]


@inlined
def _depth(ground, p, R, centre_x, y, centre_z, r, psi):
    """Return how far the circle's point in direction psi is below the ground, vertically [m]."""
    x, z = centre_x + r * np.cos(psi), centre_z - r * np.sin(psi)
    at_x = p[0] + R[0, 0] * x + R[0, 1] * y + R[0, 2] * z
    at_y = p[1] + R[1, 0] * x + R[1, 1] * y + R[1, 2] * z
    height = p[2] + R[2, 0] * x + R[2, 1] * y + R[2, 2] * z
    return height_and_slopes(ground, at_x, at_y)[0] - height


@inlined
def _refined(ground, p, R, centre_x, y, centre_z, r, low, high):
    """Return direction and depth of the deepest point between two directions by golden section."""
    span = high - low
    right = low + GOLDEN * span
    left = high - GOLDEN * span
    at_left = _depth(ground, p, R, centre_x, y, centre_z, r, left)
    at_right = _depth(ground, p, R, centre_x, y, centre_z, r, right)
    for _ in range(REFINED):
        if at_left > at_right:
            high, right, at_right = right, left, at_left
            left = high - GOLDEN * (high - low)
            at_left = _depth(ground, p, R, centre_x, y, centre_z, r, left)
        else:
            low, left, at_left = left, right, at_right
            right = low + GOLDEN * (high - low)
            at_right = _depth(ground, p, R, centre_x, y, centre_z, r, right)
    if at_left > at_right:
        return left, at_left
    return right, at_right


@inlined
def _contact_normal(ground, p, R, x, y, z, c, s, rolls, normal):
    """Fill `normal` with the unit normal of a contact at body coordinates x, y, z.

    Args:
        ground: The ground.
        p: Position of the body, shape (3,) [m].
        R: Rotation of the body, body to world, shape (3, 3).
        x: x of the contact in the body frame [m].
        y: y of the contact in the body frame [m].
        z: z of the contact in the body frame [m].
        c: Cosine of the contact's direction psi from the arc's centre [-].
        s: Sine of psi [-].
        rolls: Whether the contact is within the arc; an end of it has the ground's normal.
        normal: Filled, shape (3,) [-].
    """
    at_x = p[0] + R[0, 0] * x + R[0, 1] * y + R[0, 2] * z
    at_y = p[1] + R[1, 0] * x + R[1, 1] * y + R[1, 2] * z
    _, sx, sy = height_and_slopes(ground, at_x, at_y)
    normal[0], normal[1], normal[2] = -sx, -sy, 1.0
    if rolls:
        # along the arc, then along the ground across the leg
        tx, ty = -s * R[0, 0] - c * R[0, 2], -s * R[1, 0] - c * R[1, 2]
        tz = -s * R[2, 0] - c * R[2, 2]
        ux, uy = R[0, 1], R[1, 1]
        uz = sx * ux + sy * uy
        nx, ny, nz = uy * tz - uz * ty, uz * tx - ux * tz, ux * ty - uy * tx
        if abs(nz) > 1e-6:
            sign = 1.0 if nz > 0 else -1.0
            normal[0], normal[1], normal[2] = sign * nx, sign * ny, sign * nz
    size = np.sqrt(normal[0] ** 2 + normal[1] ** 2 + normal[2] ** 2)
    for a in range(3):
        normal[a] /= size
