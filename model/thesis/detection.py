# SPDX-License-Identifier: MIT
"""Contact states of legs that turn under a rigid body, by a search at touchdowns, section 3-5-2.

Height, roll and pitch of the body follow from the legs on the ground, as in the thesis's section
5-5 on the tetrapod. Nothing here has mass or slips.
"""

from contextlib import suppress
from dataclasses import dataclass
from itertools import combinations

import numpy as np
from numpy.typing import NDArray

from model.arrays import Array
from model.compiled import compiled
from model.contact.stance import (
    ON_GROUND,
    TRIPLES,
    Stance,
    on_three_legs,
    resting_stance,
    stand,
)
from model.errors import DomainError
from model.robot import N_LEGS, Robot

Contact = tuple[int, ...]


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


def detect_contacts(
    robot: Robot,
    theta: Array,
    *,
    start: Contact | None = None,
) -> RigidContacts:
    """Turn the legs and keep a rigid body on them, by the contact detection of section 3-5-2.

    The centre of mass is tested when a leg touches down, as Eq. (3-33) is computed; by the text of
    3-5-1 the robot topples whenever it leaves the contact polygon.

    A contact is found at the first instant at which it is there. Angles between the instants are
    not looked at, so that longer steps make roll and pitch jump where contacts change, as in
    Fig. 5-23.

    Args:
        robot: The robot; its leg offsets are not added.
        theta: Leg angles at n instants, shape (n, 6) [rad].
        start: Indices of the legs on the ground at the start, three or more; None for those on
            which the robot rests.

    Returns:
        The contacts; of fewer than n instants if no contact state fits at one of them.

    Raises:
        DomainError: No three legs hold the robot at the start.
    """
    before = start if start is not None else _on_ground(resting_stance(robot, theta[0]))
    n = len(theta)
    up, height = np.zeros((n, 3)), np.zeros(n)
    contact, legs = np.zeros((n, N_LEGS), dtype=bool), np.zeros((n, 3), dtype=np.intp)
    done, ended = 0, ""
    while done < n:
        if len(before) == 3:
            three = np.array(before, dtype=np.intp)
            stayed = _stay(
                theta[done:], robot.hips, robot.leg_radius, robot.toe_beyond, three, up[done:],
                height[done:],
            )  # fmt: skip
            legs[done : done + stayed] = three
            contact[done : done + stayed, list(before)] = True
            done += stayed
            if done == n:
                break
        try:
            stance = next_stance(robot, theta[done], contact=before)
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


def next_stance(robot: Robot, theta: Array, *, contact: Contact) -> Stance:
    """Find the stance on three legs after the legs have turned, from the contact state before.

    A leg in flight that would be on or below the ground touches down, Eq. (3-27). The new stance
    includes such a leg, leaves no leg below the ground and has the centre of mass inside its
    triangle, the most level if several do, the nearest to it if none does. If no leg touches down,
    the robot stays on three legs of `contact`, those with the centre of mass deepest inside. Legs
    that then do not reach the ground lift off.

    Args:
        robot: The robot.
        theta: Leg angles after the step, shape (6,) [rad].
        contact: Indices of the legs that touched the ground before, three or more.

    Returns:
        The stance; `Stance.standing` is the new contact state.

    Raises:
        DomainError: All legs of `contact` lie on one line or are fewer than three, or no three of
            the legs to choose from leave every other leg on or above the ground.
    """
    before = _widest(robot, theta, contact)
    touched = np.flatnonzero(_touchdowns(before, contact))
    if not len(touched):
        return before
    return _best_stance(robot, theta, [three for three in TRIPLES if np.isin(touched, three).any()])


def _best_stance(robot: Robot, theta: Array, triples: list[NDArray[np.intp]]) -> Stance:
    """Select the most level feasible stance that holds the robot, else that nearest to holding.

    Raise `DomainError` if on every triple of legs to choose from another leg is below the ground.
    """
    feasible = [stance for stance in _stances(robot, theta, triples) if stance.feasible]
    if not feasible:
        angles = ", ".join(f"{angle:.4g}" for angle in theta)
        raise DomainError(
            f"at leg angles {angles} rad no three of the legs to choose from keep the others on or "
            "above the ground; start from legs that can hold the robot, or take shorter steps"
        )
    holding = [stance for stance in feasible if stance.holds]
    if holding:
        return max(holding, key=lambda stance: stance.level)
    return max(feasible, key=lambda stance: stance.depth)


def _widest(robot: Robot, theta: Array, contact: Contact) -> Stance:
    """Stand on the three contact legs with the centre of mass deepest inside their triangle.

    Triples that leave every contact leg on or above the ground go first. Raise `DomainError` if the
    contact legs lie on one line.
    """
    stances = _stances(robot, theta, [np.array(three) for three in combinations(contact, 3)])
    if not stances:
        numbers = ", ".join(str(leg + 1) for leg in contact)
        raise DomainError(
            f"legs {numbers} lie on one line seen from above; expected three that span a triangle"
        )
    return max(stances, key=lambda stance: (_above_ground(stance, contact), stance.depth))


def _above_ground(stance: Stance, contact: Contact) -> bool:
    """Return whether no leg of `contact` is below the ground of a stance."""
    return bool(np.all(stance.clearance[list(contact)] >= -stance.tolerance))


def _touchdowns(stance: Stance, contact: Contact) -> NDArray[np.bool_]:
    """Return which legs outside `contact` are on or below the ground of a stance, shape (6,)."""
    flying = np.ones(N_LEGS, dtype=bool)
    flying[list(contact)] = False
    return flying & (stance.clearance <= 0)


def _stances(robot: Robot, theta: Array, triples: list[NDArray[np.intp]]) -> list[Stance]:
    """Stand on each triple of legs; leave out those whose feet lie on one line seen from above."""
    stances = []
    for three in triples:
        with suppress(DomainError):  # the feet lie on one line
            stances.append(stand(robot, theta, legs=three))
    return stances


@compiled
def _stay(theta, hips, radius, toe_beyond, three, up, height):
    """Keep the body on three legs until something else happens.

    Args:
        theta: Leg angles, shape (n, 6) [rad].
        hips: Hip positions in the body frame, shape (6, 3) [m].
        radius: Radius of the legs' arcs [m].
        toe_beyond: Angle of the arcs beyond a half circle [rad].
        three: Indices of the three legs on the ground, shape (3,).
        up: Filled: vertical direction in the body frame, shape (n, 3) [-].
        height: Filled: height of the body's centre above the ground, shape (n,) [m].

    Returns:
        Number of instants before another leg comes within `ON_GROUND` of the ground, or the three
        legs come to lie on a line.
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
        height[k] = -ground
    return len(theta)
