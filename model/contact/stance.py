# SPDX-License-Identifier: MIT
"""Static stance of the robot on three legs, and the choice of the three on which it rests."""

from dataclasses import dataclass
from itertools import combinations

import numpy as np
from numpy.typing import NDArray

from model.arrays import Array
from model.compiled import compiled
from model.contact.polygon import depth_in_triangle
from model.errors import DomainError
from model.leg import contact_angle, contact_in_body, lowest_angle
from model.robot import N_LEGS, Robot

TRIPLES = np.array(list(combinations(range(N_LEGS), 3)))
ON_GROUND = 1e-9  # tolerance: clearance of a leg that stands, depth of a mass on an edge [m]

_TURNS = 60  # rounds of finding contact points and the plane through them
_SETTLED = 1e-14


@dataclass(frozen=True)
class Stance:
    """The robot standing on three legs, at rest; its centre of mass is the body's centre.

    Attributes:
        legs: Indices of the three legs, shape (3,).
        up: Vertical direction in the body frame, shape (3,) [-].
        height: Height of the body's centre above the ground [m].
        points: Lowest point of every leg in the body frame, shape (6, 3) [m].
        clearance: Height of every leg's lowest point above the ground plane through the three legs'
            points; negative below it, shape (6,) [m].
        depth: Distance of the centre of mass inside the three legs' triangle seen from above;
            negative outside [m].
        level: Cosine of the angle between the body and the plane of the ground below it [-].
        tolerance: Distance to the ground within which a leg stands, and of a mass to the edge of
            the triangle within which that holds it [m].
    """

    legs: NDArray[np.intp]
    up: Array
    height: float
    points: Array
    clearance: Array
    depth: float
    level: float
    tolerance: float = ON_GROUND

    @property
    def roll(self) -> float:
        """Roll of the body, in R = Rz(yaw) Ry(pitch) Rx(roll) [rad]."""
        return float(np.arctan2(self.up[1], self.up[2]))

    @property
    def pitch(self) -> float:
        """Pitch of the body, in R = Rz(yaw) Ry(pitch) Rx(roll) [rad]."""
        return float(-np.arcsin(self.up[0]))

    @property
    def standing(self) -> NDArray[np.bool_]:
        """Whether each leg is within `tolerance` of the ground, as the three are, shape (6,)."""
        stands = np.abs(self.clearance) <= self.tolerance
        stands[self.legs] = True
        return stands

    @property
    def feasible(self) -> bool:
        """Whether no leg is below the ground by more than `tolerance`."""
        return bool(np.all(self.clearance >= -self.tolerance))

    @property
    def holds(self) -> bool:
        """Whether the centre of mass is inside the three legs' triangle or on its edge."""
        return self.depth >= -self.tolerance


def stand(robot: Robot, theta: Array, *, legs: NDArray[np.intp] | tuple[int, ...]) -> Stance:
    """Compute the stance in which three given legs touch the ground, step 3 of section 3-5-2.

    Args:
        robot: The robot.
        theta: Leg angles, shape (6,) [rad].
        legs: Indices of three legs that do not lie on one line.

    Returns:
        The stance; other legs may be below the ground, the centre of mass outside the triangle.

    Raises:
        DomainError: The three legs' lowest points lie on one line seen from above.
    """
    three = np.asarray(legs, dtype=np.intp)
    points, up, seen = np.empty((N_LEGS, 3)), np.empty(3), np.empty((N_LEGS, 2))
    if not on_three_legs(
        theta, robot.hips, robot.leg_radius, robot.toe_beyond, three, points, up, seen
    ):
        numbers = ", ".join(str(leg + 1) for leg in three)
        raise DomainError(f"legs {numbers} lie on one line seen from above; expected a triangle")
    levels = points @ up
    height = -float(levels[three].mean())
    depth = float(depth_in_triangle(np.zeros(2), seen[three]))
    return Stance(three, up, height, points, levels + height, depth, float(up[2]))


def resting_stance(robot: Robot, theta: Array) -> Stance:
    """Find the three legs on which the robot rests, its centre of mass inside their triangle.

    No leg is below the ground. Of several such stances the most level one is returned; another may
    lie on its nose.

    Args:
        robot: The robot.
        theta: Leg angles, shape (6,) [rad].

    Raises:
        DomainError: No three legs have the centre of mass inside their triangle and every other
            leg on or above the ground.
    """
    three = np.empty(3, np.intp)
    rest(theta, robot.hips, robot.leg_radius, robot.toe_beyond, three)
    stance = stand(robot, theta, legs=three) if three[0] >= 0 else None
    if stance is None or not stance.holds:
        angles = ", ".join(f"{angle:.4g}" for angle in theta)
        raise DomainError(
            f"at leg angles {angles} rad no three legs hold the robot; check angles, hips and arc"
        )
    return stance


@compiled
def lowest_points(theta, hips, radius, toe_beyond, up, points):
    """Compute every leg's lowest point in the body frame.

    Args:
        theta: Leg angles, shape (6,) [rad].
        hips: Hip positions in the body frame, shape (6, 3) [m].
        radius: Radius of the legs' arcs [m].
        toe_beyond: Angle of the arcs beyond a half circle [rad].
        up: Vertical direction in the body frame, shape (3,) [-].
        points: Filled: the lowest points, shape (6, 3) [m].
    """
    roll, pitch = np.arctan2(up[1], up[2]), -np.arcsin(up[0])
    for leg in range(6):
        phi = lowest_angle(theta[leg], roll, pitch)
        x, z = contact_in_body(theta[leg], contact_angle(phi, toe_beyond), radius)
        points[leg, 0], points[leg, 1] = hips[leg, 0] + x, hips[leg, 1]
        points[leg, 2] = hips[leg, 2] + z


@compiled
def plane_normal(points, legs, up):
    """Compute the upward unit normal of the plane through three legs' points.

    Args:
        points: Lowest point of each leg in the body frame, shape (6, 3) [m].
        legs: Indices of the three legs, shape (3,).
        up: Overwritten with the normal, shape (3,) [-]; kept when infinity is returned.

    Returns:
        Largest change of a component of `up` [-]; infinity when the points lie on a line seen from
        above.
    """
    a, b, c = points[legs[0]], points[legs[1]], points[legs[2]]
    u0, u1, u2 = b[0] - a[0], b[1] - a[1], b[2] - a[2]
    v0, v1, v2 = c[0] - a[0], c[1] - a[1], c[2] - a[2]
    n0, n1, n2 = u1 * v2 - u2 * v1, u2 * v0 - u0 * v2, u0 * v1 - u1 * v0
    size = np.sqrt(n0 * n0 + n1 * n1 + n2 * n2)
    if abs(n2) < 1e-9:  # seen from above on a line
        return np.inf
    size = size if n2 > 0 else -size
    turned = max(abs(n0 / size - up[0]), abs(n1 / size - up[1]), abs(n2 / size - up[2]))
    up[0], up[1], up[2] = n0 / size, n1 / size, n2 / size
    return turned


@compiled
def seen_from_above(points, up, seen):
    """Project points along the vertical to x along the heading and y to the left, from the centre.

    Args:
        points: Points in the body frame, shape (6, 3) [m].
        up: Vertical direction in the body frame, shape (3,) [-].
        seen: Filled: the projected points, shape (6, 2) [m].
    """
    size = np.sqrt(1 - up[0] ** 2)
    # Heading: the body's x axis made level. Left: across it, up x heading.
    h0, h1, h2 = size, -up[0] * up[1] / size, -up[0] * up[2] / size
    l1, l2 = up[2] / size, -up[1] / size
    for leg in range(6):
        x, y, z = points[leg]
        seen[leg, 0] = h0 * x + h1 * y + h2 * z
        seen[leg, 1] = l1 * y + l2 * z


@compiled
def on_three_legs(theta, hips, radius, toe_beyond, legs, points, up, seen):
    """Compute the orientation of the body that stands on three given legs.

    A turn of the body moves the lowest points along arcs that are level there. Fixed-point
    iteration between the points and the plane through them therefore converges in a few rounds; it
    stops after 60, converged or not.

    Args:
        theta: Leg angles, shape (6,) [rad].
        hips: Hip positions in the body frame, shape (6, 3) [m].
        radius: Radius of the legs' arcs [m].
        toe_beyond: Angle of the arcs beyond a half circle [rad].
        legs: Indices of the three legs, shape (3,).
        points: Filled: lowest point of every leg in the body frame, shape (6, 3) [m].
        up: Filled: vertical direction in the body frame, shape (3,) [-].
        seen: Filled: the points seen from above, shape (6, 2) [m].

    Returns:
        False when the three legs' points lie on a line seen from above, else True.
    """
    up[0], up[1], up[2] = 0.0, 0.0, 1.0
    for _ in range(_TURNS):
        lowest_points(theta, hips, radius, toe_beyond, up, points)
        turned = plane_normal(points, legs, up)
        if turned == np.inf:
            return False
        if turned < _SETTLED:
            break
    seen_from_above(points, up, seen)
    return True


@compiled
def holds(theta, hips, radius, toe_beyond, legs, points, up, seen):
    """Compute the static stability margin on three legs: how far inside the centre of mass is.

    Args:
        theta: Leg angles, shape (6,) [rad].
        hips: Hip positions in the body frame, shape (6, 3) [m].
        radius: Radius of the legs' arcs [m].
        toe_beyond: Angle of the arcs beyond a half circle [rad].
        legs: Indices of the three legs, shape (3,).
        points: Filled: lowest point of every leg in the body frame, shape (6, 3) [m].
        up: Filled: vertical direction in the body frame, shape (3,) [-].
        seen: Filled: the points seen from above, shape (6, 2) [m].

    Returns:
        Distance of the centre of mass inside the legs' triangle, negative outside [m]; minus
        infinity when the legs lie on a line or another leg would be below the ground.
    """
    if not on_three_legs(theta, hips, radius, toe_beyond, legs, points, up, seen):
        return -np.inf
    ground = points[legs[0], 0] * up[0] + points[legs[0], 1] * up[1] + points[legs[0], 2] * up[2]
    for leg in range(6):
        level = points[leg, 0] * up[0] + points[leg, 1] * up[1] + points[leg, 2] * up[2]
        if level < ground - ON_GROUND:
            return -np.inf
    return depth_in_triangle(np.zeros(2), seen[legs])


@compiled
def rest(theta, hips, radius, toe_beyond, legs):
    """Find the three legs on which the robot rests: the most level of the stable stances.

    Args:
        theta: Leg angles, shape (6,) [rad].
        hips: Hip positions in the body frame, shape (6, 3) [m].
        radius: Radius of the legs' arcs [m].
        toe_beyond: Angle of the arcs beyond a half circle [rad].
        legs: Filled: indices of the legs, shape (3,); -1 when no three hold the centre of mass
            inside their triangle with every other leg on or above the ground.
    """
    points, up, seen = np.empty((6, 3)), np.empty(3), np.empty((6, 2))
    legs[:] = -1
    most_level = -np.inf
    for triple in TRIPLES:
        depth = holds(theta, hips, radius, toe_beyond, triple, points, up, seen)
        if depth >= -ON_GROUND and up[2] > most_level:
            most_level = up[2]
            legs[:] = triple
