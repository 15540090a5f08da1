# SPDX-License-Identifier: MIT
"""Where the legs' arcs and the body's corners come nearest to a map of heights, compiled.

An arc is searched point by point against the heights, so that a leg may stand on an edge, on a
slope or on two places at once. Nothing here comes from `model.walk`, whose contacts it judges.
"""

from typing import NamedTuple

import numba
import numpy as np

from model.arrays import Array
from model.robot import N_LEGS, Robot

N_CORNERS = 8
PER_LEG = 2  # places at which a leg may touch at once: toe and arc, or arc and edge
N_SLOTS = N_CORNERS + N_LEGS * PER_LEG
SAMPLES = 49  # of an arc; 3.8 degrees apart on a half circle
NEAR = 0.002  # m above the ground; above it no contact is made
REFINEMENTS = 20  # golden sections between samples, to 1e-5 rad
GOLDEN = 0.5 * (np.sqrt(5.0) - 1.0)


class Heights(NamedTuple):
    """Height of the ground: a plane and a map on a square grid, added up.

    The map is bilinear between its points and constant beyond its edge.

    Attributes:
        x: x of the map's first row [m].
        y: y of its first column [m].
        step: Distance of rows and of columns [m].
        z: Heights, rows along x, columns along y, shape (m, n); one height is that of flat
            ground [m].
        highest: Largest height of the map over the plane [m].
        rise_x: Rise of the plane for each metre of x [-].
        rise_y: The same of y [-].
    """

    x: float
    y: float
    step: float
    z: Array
    highest: float
    rise_x: float = 0.0
    rise_y: float = 0.0


FLAT = Heights(0.0, 0.0, 1.0, np.zeros((1, 1)), 0.0)


class Shape(NamedTuple):
    """What of a robot touches the ground, in its body's frame.

    Attributes:
        hips: Hips, shape (6, 3) [m].
        corners: Corners of the body, shape (8, 3) [m].
        radius: Radius of the arcs [m].
        phi: Sampled angles of an arc about its centre, from the toe to the hip, where it is pi,
            shape (n,) [rad].
        cos: Their cosines.
        sin: Their sines.
    """

    hips: Array
    corners: Array
    radius: float
    phi: Array
    cos: Array
    sin: Array


class Places(NamedTuple):
    """Where contacts may be; rows are corners, then `PER_LEG` rows a leg.

    Attributes:
        local: The point in the frame of its corner's or leg's body, shape (20, 3) [m].
        point: The point in the world, shape (20, 3) [m].
        ground: The ground under it, shape (20, 3) [m].
        normal: Direction of the normal force, shape (20, 3) [-].
        near: Whether it is near the ground; else the rest of its row is old, shape (20,).
    """

    local: Array
    point: Array
    ground: Array
    normal: Array
    near: Array


def shape_of(robot: Robot) -> Shape:
    """Return what of a robot touches the ground."""
    half = 0.5 * np.array(robot.body_size)
    signs = np.array([[x, y, z] for x in (-1, 1) for y in (-1, 1) for z in (-1, 1)], dtype=float)
    phi = np.linspace(-robot.toe_beyond, np.pi, SAMPLES)
    return Shape(robot.hips, signs * half, robot.leg_radius, phi, np.cos(phi), np.sin(phi))


def no_places() -> Places:
    """Return places none of which is near the ground."""
    local, point, ground, normal = np.zeros((4, N_SLOTS, 3))
    return Places(local, point, ground, normal, np.zeros(N_SLOTS, dtype=bool))


@numba.njit(cache=True)
def _cell(heights, x, y):
    """Return row and column of the grid's cell at a place, and how far into it the place is [-]."""
    m, n = heights.z.shape
    at_x = (x - heights.x) / heights.step
    at_y = (y - heights.y) / heights.step
    i = min(max(int(np.floor(at_x)), 0), m - 2)
    j = min(max(int(np.floor(at_y)), 0), n - 2)
    return i, j, at_x - i, at_y - j


@numba.njit(cache=True)
def height_at(heights, x, y):
    """Return the ground's height at a place [m]."""
    height = heights.rise_x * x + heights.rise_y * y
    if heights.z.size == 1:
        return height + heights.z[0, 0]
    i, j, a, b = _cell(heights, x, y)
    a, b, z = min(max(a, 0.0), 1.0), min(max(b, 0.0), 1.0), heights.z
    before = z[i, j] + b * (z[i, j + 1] - z[i, j])
    after = z[i + 1, j] + b * (z[i + 1, j + 1] - z[i + 1, j])
    return height + before + a * (after - before)


@numba.njit(cache=True)
def normal_at(heights, x, y):
    """Return the x, y and z of the ground's unit normal at a place [-]."""
    slope_x, slope_y = heights.rise_x, heights.rise_y
    if heights.z.size > 1:
        i, j, a, b = _cell(heights, x, y)
        z, in_x, in_y = heights.z, min(max(a, 0.0), 1.0), min(max(b, 0.0), 1.0)
        if a == in_x:
            along = (1 - in_y) * (z[i + 1, j] - z[i, j]) + in_y * (z[i + 1, j + 1] - z[i, j + 1])
            slope_x += along / heights.step
        if b == in_y:
            along = (1 - in_x) * (z[i, j + 1] - z[i, j]) + in_x * (z[i + 1, j + 1] - z[i + 1, j])
            slope_y += along / heights.step
    size = np.sqrt(1.0 + slope_x**2 + slope_y**2)
    return -slope_x / size, -slope_y / size, 1.0 / size


@numba.njit(cache=True)
def _clearance(cos, sin, heights, arc):
    """Return the height above the ground [m] of an arc's point, at an angle's cosine and sine."""
    x = arc[0] + cos * arc[3] - sin * arc[6]
    y = arc[1] + cos * arc[4] - sin * arc[7]
    return arc[2] + cos * arc[5] - sin * arc[8] - height_at(heights, x, y)


@numba.njit(cache=True)
def _lowest_between(low, high, heights, arc):
    """Return the arc's angle of least clearance between two angles, by golden section [rad]."""
    first, last = low, high
    a, b = high - GOLDEN * (high - low), low + GOLDEN * (high - low)
    at_a = _clearance(np.cos(a), np.sin(a), heights, arc)
    at_b = _clearance(np.cos(b), np.sin(b), heights, arc)
    for _ in range(REFINEMENTS):
        if at_a < at_b:
            high, b, at_b = b, a, at_a
            a = high - GOLDEN * (high - low)
            at_a = _clearance(np.cos(a), np.sin(a), heights, arc)
        else:
            low, a, at_a = a, b, at_b
            b = low + GOLDEN * (high - low)
            at_b = _clearance(np.cos(b), np.sin(b), heights, arc)
    best = 0.5 * (low + high)
    least = _clearance(np.cos(best), np.sin(best), heights, arc)
    for end in (first, last):  # toe and hip are ends, which sections only approach
        at_end = _clearance(np.cos(end), np.sin(end), heights, arc)
        if at_end <= least:
            best, least = end, at_end
    return best


@numba.njit(cache=True)
def _touch(slot, phi, is_end, heights, radius, arc, places):
    """Fill a row of `places` for the arc's point at an angle.

    The normal is the ground's; inside the arc, less its part along the arc, so that a leg that
    rolls over an edge is pushed towards the arc's centre.
    """
    point, normal = places.point[slot], places.normal[slot]
    c, s = np.cos(phi), np.sin(phi)
    for a in range(3):
        point[a] = arc[a] + c * arc[3 + a] - s * arc[6 + a]
    normal[0], normal[1], normal[2] = normal_at(heights, point[0], point[1])
    places.ground[slot, :2] = point[:2]
    places.ground[slot, 2] = height_at(heights, point[0], point[1])
    places.local[slot, 0], places.local[slot, 2] = radius * (1.0 + c), -radius * s
    places.near[slot] = True
    if is_end:
        return
    along = 0.0
    for a in range(3):
        along -= normal[a] * (s * arc[3 + a] + c * arc[6 + a]) / radius
    size = np.sqrt(1.0 - along**2)
    for a in range(3):
        normal[a] = (normal[a] + along * (s * arc[3 + a] + c * arc[6 + a]) / radius) / size


@numba.njit(cache=True)
def turn_into(rotation, vector, out):
    """Fill the first three of `out` with a vector turned by a rotation."""
    for a in range(3):
        out[a] = (
            rotation[a, 0] * vector[0] + rotation[a, 1] * vector[1] + rotation[a, 2] * vector[2]
        )


@numba.njit(cache=True)
def find_places(p, rotation, theta, shape, heights, places, scratch):
    """Find where legs and corners are near the ground.

    Args:
        p: Position of the body, shape (3,) [m].
        rotation: Rotation from body to world, shape (3, 3).
        theta: Leg angles, shape (6,) [rad].
        shape: What touches the ground.
        heights: The ground.
        places: Filled.
        scratch: Overwritten, shape (n of `shape.phi`,).
    """
    places.near[:] = False
    arc = np.empty(9)  # centre, and the axes through and beside the hip, as long as the radius
    for k in range(N_CORNERS):
        point = places.point[k]
        turn_into(rotation, shape.corners[k], point)
        point += p
        height = height_at(heights, point[0], point[1])
        if point[2] - height < NEAR:
            normal = places.normal[k]
            normal[0], normal[1], normal[2] = normal_at(heights, point[0], point[1])
            places.local[k] = shape.corners[k]
            places.ground[k, :2] = point[:2]
            places.ground[k, 2] = height
            places.near[k] = True
    for leg in range(N_LEGS):
        c, s = np.cos(theta[leg]), np.sin(theta[leg])
        turn_into(rotation, shape.hips[leg], arc)
        for a in range(3):
            arc[3 + a] = shape.radius * (c * rotation[a, 0] - s * rotation[a, 2])
            arc[6 + a] = shape.radius * (s * rotation[a, 0] + c * rotation[a, 2])
            arc[a] += p[a] + arc[3 + a]
        over = arc[2] - heights.rise_x * arc[0] - heights.rise_y * arc[1] - heights.highest
        if over > shape.radius * np.sqrt(1.0 + heights.rise_x**2 + heights.rise_y**2) + NEAR:
            continue
        _find_on_leg(leg, arc, shape, heights, places, scratch)


@numba.njit(cache=True)
def _find_on_leg(leg, arc, shape, heights, places, scratch):
    """Fill a leg's rows of `places`: its places of least clearance, at most `PER_LEG`."""
    n, r = len(shape.phi), shape.radius
    for j in range(n):
        scratch[j] = _clearance(shape.cos[j], shape.sin[j], heights, arc)
    taken = -1
    for k in range(PER_LEG):
        lowest = _lowest_sample(scratch, taken)
        if lowest < 0:
            return
        low, high = shape.phi[max(lowest - 1, 0)], shape.phi[min(lowest + 1, n - 1)]
        phi = _lowest_between(low, high, heights, arc)
        is_end = phi == shape.phi[0] or phi == shape.phi[-1]
        slot = N_CORNERS + leg * PER_LEG + k
        _touch(slot, phi, is_end, heights, r, arc, places)
        taken = lowest


@numba.njit(cache=True)
def _lowest_sample(clearance, taken):
    """Return the lowest local minimum near the ground that is not yet taken, -1 without one."""
    n, lowest = len(clearance), -1
    for j in range(n):
        if j == taken or clearance[j] >= NEAR:
            continue
        before = j == 0 or clearance[j] <= clearance[j - 1]
        after = j == n - 1 or clearance[j] < clearance[j + 1]
        if before and after and (lowest < 0 or clearance[j] < clearance[lowest]):
            lowest = j
    return lowest
