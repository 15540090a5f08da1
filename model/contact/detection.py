# SPDX-License-Identifier: MIT
"""Contact states of legs that turn under a rigid body, step by step, section 3-5-2.

The body stays on the legs that `model.contact.events` finds; its height, roll and pitch follow from
them, as in the thesis's section 5-5 on the tetrapod. Nothing here has mass or slips.
"""

from dataclasses import dataclass
from functools import partial
from typing import Literal, Protocol

import numpy as np
from numpy.typing import NDArray

from model.arrays import Array
from model.compiled import compiled
from model.contact.events import Contact, next_stance
from model.contact.polygon import depth_in_triangle
from model.contact.stance import ON_GROUND, Stance, on_three_legs, resting_stance, stand
from model.errors import DomainError
from model.robot import N_LEGS, Robot

Detection = Literal["events", "balanced"]
DETECTIONS: tuple[Detection, ...] = ("events", "balanced")
"""When the centre of mass is tested against the contact polygon: at touchdowns, or every step."""


@dataclass(frozen=True)
class RigidContacts:
    """Contacts and orientation of a body on rigid legs.

    Attributes:
        contact: Which legs are on the ground, shape (n, 6).
        legs: Indices of the three legs that the body stands on, shape (n, 3).
        height: Height of the body's centre, shape (n,) [m].
        roll: Roll, R = Rz(yaw) Ry(pitch) Rx(roll), shape (n,) [rad].
        pitch: Pitch, shape (n,) [rad].
        ended: Why the detection ended before the last angles; empty if it did not.
    """

    contact: NDArray[np.bool_]
    legs: NDArray[np.intp]
    height: Array
    roll: Array
    pitch: Array
    ended: str = ""

    def __len__(self) -> int:
        """Return the number of instants n."""
        return len(self.height)


class Footing(Protocol):
    """How a rigid body stands on its legs at each of n instants."""

    def stand(self, instant: int, legs: NDArray[np.intp]) -> Stance:
        """Return the stance on three legs; raise `DomainError` if they lie on a line."""
        ...

    def rest(self, instant: int) -> Stance:
        """Return the stance in which the robot rests; raise `DomainError` if there is none."""
        ...

    def stay(
        self, instant: int, three: NDArray[np.intp], balanced: bool, up: Array, height: Array
    ) -> int:
        """Keep the body on three legs from an instant on until something else happens.

        Args:
            instant: The first instant.
            three: Indices of the legs, shape (3,).
            balanced: Whether to stop when the centre of mass leaves the legs' triangle.
            up: Filled: vertical direction in the body frame, a row an instant, shape (k, 3) [-].
            height: Filled: height of the body's centre, shape (k,) [m].

        Returns:
            Number of instants before another leg reaches the ground, the three legs come to lie on
            a line, or the centre of mass leaves their triangle.
        """
        ...


@dataclass(frozen=True)
class FlatFooting:
    """A rigid body on its legs on flat, level ground.

    Attributes:
        robot: The robot; its leg offsets are not added.
        theta: Leg angles at the instants, shape (n, 6) [rad].
    """

    robot: Robot
    theta: Array

    def stand(self, instant: int, legs: NDArray[np.intp]) -> Stance:
        """Return the stance on three legs; raise `DomainError` if they lie on a line."""
        return stand(self.robot, self.theta[instant], legs=legs)

    def rest(self, instant: int) -> Stance:
        """Return the stance in which the robot rests; raise `DomainError` if there is none."""
        return resting_stance(self.robot, self.theta[instant])

    def stay(
        self, instant: int, three: NDArray[np.intp], balanced: bool, up: Array, height: Array
    ) -> int:
        """Keep the body on three legs; see `Footing`."""
        robot = self.robot
        return _stay(
            self.theta[instant:], robot.hips, robot.leg_radius, robot.toe_beyond, three, balanced,
            up, height,
        )  # fmt: skip


def detect_contacts(
    robot: Robot,
    theta: Array,
    *,
    start: Contact | None = None,
    detection: Detection = "events",
    footing: Footing | None = None,
) -> RigidContacts:
    """Turn the legs and keep a rigid body on them, by the contact detection of section 3-5-2.

    A contact is found at the first instant at which it is there. Angles between the instants are
    not looked at, so that longer steps make roll and pitch jump where contacts change, as in
    Fig. 5-23.

    Args:
        robot: The robot; its leg offsets are not added.
        theta: Leg angles at n instants, shape (n, 6) [rad].
        start: Indices of the legs on the ground at the start, three or more; None for those on
            which the robot rests.
        detection: "events", as Eq. (3-33) is computed: the centre of mass is tested when a leg
            touches down. "balanced", as the text of 3-5-1 says: it is tested at every instant, and
            the robot topples when the centre of mass leaves the contact polygon.
        footing: How the body stands on its legs; None for flat, level ground.

    Returns:
        The contacts; of fewer than n instants if no contact state fits at one of them.

    Raises:
        DomainError: No three legs hold the robot at the start, or the detection is unknown.
    """
    if detection not in DETECTIONS:
        raise DomainError(f"detection is '{detection}'; expected {' or '.join(DETECTIONS)}")
    balanced = detection == "balanced"
    footing = footing or FlatFooting(robot, theta)
    before = start if start is not None else _on_ground(footing.rest(0))
    n = len(theta)
    up, height = np.zeros((n, 3)), np.zeros(n)
    contact, legs = np.zeros((n, N_LEGS), dtype=bool), np.zeros((n, 3), dtype=np.intp)
    done, ended = 0, ""
    while done < n:
        if len(before) == 3:
            three = np.array(before, dtype=np.intp)
            stayed = footing.stay(done, three, balanced, up[done:], height[done:])
            legs[done : done + stayed] = three
            contact[done : done + stayed, list(before)] = True
            done += stayed
            if done == n:
                break
        try:
            stance = next_stance(
                robot, theta[done], contact=before, always_balanced=balanced,
                stand_on=partial(footing.stand, done),
            )  # fmt: skip
        except DomainError as error:
            ended = str(error)
            break
        before = _on_ground(stance)
        up[done], height[done], legs[done] = stance.up, stance.height, stance.legs
        contact[done] = stance.standing
        done += 1
    roll, pitch = np.arctan2(up[:done, 1], up[:done, 2]), -np.arcsin(up[:done, 0])
    return RigidContacts(contact[:done], legs[:done], height[:done], roll, pitch, ended)


def _on_ground(stance: Stance) -> Contact:
    """Return the indices of the legs that touch the ground in a stance."""
    return tuple(int(leg) for leg in np.flatnonzero(stance.standing))


@compiled
def _stay(theta, hips, radius, toe_beyond, three, balanced, up, height):
    """Keep the body on three legs until something else happens.

    Args:
        theta: Leg angles, shape (n, 6) [rad].
        hips: Hip positions in the body frame, shape (6, 3) [m].
        radius: Radius of the legs' arcs [m].
        toe_beyond: Angle of the arcs beyond a half circle [rad].
        three: Indices of the three legs on the ground, shape (3,).
        balanced: Whether to stop when the centre of mass leaves the legs' triangle.
        up: Filled: vertical direction in the body frame, shape (n, 3) [-].
        height: Filled: height of the body's centre above the ground, shape (n,) [m].

    Returns:
        Number of instants before another leg comes within `ON_GROUND` of the ground, the three
        legs come to lie on a line, or the centre of mass leaves their triangle.
    """
    points, seen, level = np.empty((6, 3)), np.empty((6, 2)), np.empty(6)
    for k in range(len(theta)):
        if not on_three_legs(theta[k], hips, radius, toe_beyond, three, points, up[k], seen):
            return k
        for leg in range(6):
            x, y, z = points[leg]
            level[leg] = up[k, 0] * x + up[k, 1] * y + up[k, 2] * z
        ground = (level[three[0]] + level[three[1]] + level[three[2]]) / 3
        for leg in range(6):
            stands = leg == three[0] or leg == three[1] or leg == three[2]
            if not stands and level[leg] <= ground + ON_GROUND:
                return k
        if balanced and depth_in_triangle(np.zeros(2), seen[three]) < 0:
            return k
        height[k] = -ground
    return len(theta)
