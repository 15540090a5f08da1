# SPDX-License-Identifier: MIT
"""A rigid body on its legs on the ground of a walk: contact detection of 3-5-2 on uneven ground.

The thesis detects contacts on flat, level ground. Here the body has the place and heading of a
walked path, and stands on three legs there: its height, roll and pitch are such that the point of
each of these legs that is deepest below the ground, or nearest above it, touches it
(`model.walk.deepest_point`; on a plane the lowest point towards it). The contact polygon and the
centre of mass are seen from above, so that on a slope it is nearer to the lower legs. The body
itself touches nothing.

At the edge of a step a leg may stand on either side of it, with the body tilted more or less. Of
such orientations that nearest to the walked path's is found, from which the search begins.
"""

from dataclasses import dataclass
from functools import cached_property, partial

import numpy as np
from numpy.typing import NDArray

from model.arrays import Array
from model.compiled import compiled
from model.contact.detection import Footing
from model.contact.events import best_stance
from model.contact.polygon import depth_in_triangle
from model.contact.stance import ON_GROUND, TRIPLES, Stance
from model.errors import DomainError
from model.robot import Robot
from model.walk.arrays import Body, Work, body_arrays, new_work
from model.walk.contact_points import find_contacts
from model.walk.ground import Ground, heights_on, is_even

TOUCHES = 1e-6  # m; contacts on uneven ground are found to within less
_LEAST_LEVEL = 0.5  # cosine of the angle to the ground, beyond which the body lies on its side
_ROUNDS = 60  # of finding contact points and the plane through them
_SETTLED = 1e-12, 1e-7  # change of a component of "up" in a round: on a plane, on uneven ground


@dataclass(frozen=True)
class GroundFooting(Footing):
    """A rigid body on its legs on a ground, along a walked path.

    Attributes:
        robot: The robot; its leg offsets are not added.
        theta: Leg angles at the instants, shape (n, 6) [rad].
        pose: The walked path's x, y, z [m], roll, pitch and yaw [rad], shape (n, 6): place and
            heading are kept, and a stance is sought from the others.
        ground: The ground.
    """

    robot: Robot
    theta: Array
    pose: Array
    ground: Ground

    @cached_property
    def _body(self) -> Body:
        return body_arrays(self.robot)

    @cached_property
    def _work(self) -> Work:
        return new_work()

    @property
    def _tolerance(self) -> float:
        return ON_GROUND if is_even(self.ground) else TOUCHES

    def stand(self, instant: int, legs: NDArray[np.intp]) -> Stance:
        """Return the stance on three legs.

        Args:
            instant: The instant.
            legs: Indices of the legs, shape (3,).

        Raises:
            DomainError: The legs lie on a line, or the body would lie on its side.
        """
        work, up, over = self._work, np.empty(3), np.empty(6)
        z = _stand(
            self._body, self.ground, self.pose[instant], self.theta[instant], legs, up, over, work
        )
        if not np.isfinite(z):
            numbers = ", ".join(str(leg + 1) for leg in legs)
            raise DomainError(f"legs {numbers} lie on one line seen from above")
        level = float(work.R[:, 2] @ self._normal_below(instant))
        if level < _LEAST_LEVEL:
            raise DomainError("the body would lie on its side")
        points = work.place[:6]
        return Stance(
            legs=np.asarray(legs),
            up=up,
            height=z,
            points=points @ work.R,
            clearance=over.copy(),
            depth=float(depth_in_triangle(np.zeros(2), points[legs, :2])),
            level=level,
            tolerance=self._tolerance,
        )

    def _normal_below(self, instant: int) -> Array:
        """Return the unit normal of the plane nearest to the ground below the hips, shape (3,)."""
        pose, hips = self.pose[instant], self.robot.hips
        c, s = np.cos(pose[5]), np.sin(pose[5])
        x = pose[0] + c * hips[:, 0] - s * hips[:, 1]
        y = pose[1] + s * hips[:, 0] + c * hips[:, 1]
        height = np.diag(heights_on(self.ground, x, y))
        slope = np.linalg.lstsq(np.column_stack([x, y, np.ones(6)]), height, rcond=None)[0]
        normal = np.array([-slope[0], -slope[1], 1.0])
        return normal / np.linalg.norm(normal)

    def rest(self, instant: int) -> Stance:
        """Return the most level stance; raise `DomainError` if no three legs hold the robot."""
        stance = best_stance(partial(self.stand, instant), self.theta[instant], list(TRIPLES))
        if not stance.holds:
            raise DomainError(
                "no three legs hold the robot on the ground where it starts; check angles, hips "
                "and arc, or let it start elsewhere"
            )
        return stance

    def stay(
        self, instant: int, three: NDArray[np.intp], balanced: bool, up: Array, height: Array
    ) -> int:
        """Keep the body on three legs; see `Footing`."""
        return _stay(
            self._body, self.ground, self.pose[instant:], self.theta[instant:], three, balanced,
            self._tolerance, up, height, self._work,
        )  # fmt: skip


@compiled
def _stand(body, ground, pose, theta, legs, up, over, work):
    """Compute height and orientation of the body that stands on three given legs.

    A turn of the body moves the contacts little, so that fixed-point iteration between them and the
    plane through their heights over the ground converges in a few rounds. At the edge of a step it
    may not; it stops after 60 rounds.

    Args:
        body: The robot.
        ground: The ground.
        pose: x, y, z [m], roll, pitch and yaw [rad], from which the stance is sought, shape (6,).
        theta: Leg angles, shape (6,) [rad].
        legs: Indices of the three legs, shape (3,).
        up: Filled: vertical direction in the body frame, shape (3,) [-].
        over: Filled: height of each leg's contact over the ground, shape (6,) [m].
        work: Work arrays; R and place are left as those of the last round.

    Returns:
        Height of the body's centre [m]; NaN when the contacts lie on a line seen from above.
    """
    settled = _SETTLED[0] if is_even(ground) else _SETTLED[1]
    work.v[0], work.v[1], work.v[2] = pose[0], pose[1], pose[2]
    up[0], up[1] = -np.sin(pose[4]), np.cos(pose[4]) * np.sin(pose[3])
    up[2] = np.cos(pose[4]) * np.cos(pose[3])
    work.velocity[:6] = 0.0
    a, b, c = legs[0], legs[1], legs[2]
    at = work.place
    for _ in range(_ROUNDS):
        _rotation(up, pose[5], work.R)
        find_contacts(
            body, ground, work.v, work.R, theta, work.b, at, work.velocity, work.normal, work.gap,
            work.kind, work.flow,
        )  # fmt: skip
        for leg in range(6):
            over[leg] = work.gap[leg] / work.normal[leg, 2]
        sunk = (over[a] + over[b] + over[c]) / 3
        work.v[2] -= sunk
        for leg in range(6):
            over[leg] -= sunk
        u0, u1, u2 = at[b, 0] - at[a, 0], at[b, 1] - at[a, 1], over[b] - over[a]
        v0, v1, v2 = at[c, 0] - at[a, 0], at[c, 1] - at[a, 1], over[c] - over[a]
        n0, n1, n2 = u1 * v2 - u2 * v1, u2 * v0 - u0 * v2, u0 * v1 - u1 * v0
        if abs(n2) < 1e-9:
            return np.nan
        size = np.sqrt(n0 * n0 + n1 * n1 + n2 * n2) * np.sign(n2)
        turned = 0.0
        for i in range(3):
            turn = (work.R[0, i] * n0 + work.R[1, i] * n1 + work.R[2, i] * n2) / size - up[i]
            up[i] += turn
            turned = max(turned, abs(turn))
        if turned < settled and abs(sunk) < settled:
            break
    return work.v[2]


@compiled
def _rotation(up, yaw, R):
    """Fill R, body to world, from the vertical direction in the body frame and the yaw [rad]."""
    size = np.sqrt(1 - up[0] ** 2)
    c, s = np.cos(yaw), np.sin(yaw)
    forward = (size, -up[0] * up[1] / size, -up[0] * up[2] / size)
    left = (0.0, up[2] / size, -up[1] / size)
    for i in range(3):
        R[0, i] = c * forward[i] - s * left[i]
        R[1, i] = s * forward[i] + c * left[i]
        R[2, i] = up[i]


@compiled
def _stay(body, ground, pose, theta, three, balanced, tolerance, up, height, work):
    """Keep the body on three legs until something else happens; see `Footing.stay`.

    Args:
        body: The robot.
        ground: The ground.
        pose: x, y, z [m], roll, pitch and yaw [rad], from which stances are sought, (n, 6).
        theta: Leg angles, shape (n, 6) [rad].
        three: Indices of the three legs on the ground, shape (3,).
        balanced: Whether to stop when the centre of mass leaves the legs' triangle.
        tolerance: Distance to the ground within which a leg stands [m].
        up: Filled: vertical direction in the body frame, shape (n, 3) [-].
        height: Filled: height of the body's centre, shape (n,) [m].
        work: Work arrays.

    Returns:
        Number of instants before a change.
    """
    over = np.empty(6)
    for k in range(len(theta)):
        height[k] = _stand(body, ground, pose[k], theta[k], three, up[k], over, work)
        if np.isnan(height[k]):
            return k
        for leg in range(6):
            stands = leg == three[0] or leg == three[1] or leg == three[2]
            if not stands and over[leg] <= tolerance:
                return k
        if balanced and depth_in_triangle(np.zeros(2), work.place[three][:, :2]) < -tolerance:
            return k
    return len(theta)
