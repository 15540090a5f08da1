# SPDX-License-Identifier: MIT
"""Touchdown and lift-off by a search over contact states, section 3-5-2."""

from contextlib import suppress
from itertools import combinations

import numpy as np
from numpy.typing import NDArray

from model.contact.stance import ON_GROUND, TRIPLES, Stance, stand
from model.errors import DomainError
from model.robot import N_LEGS, Robot
from model.slip.law import Array

Contact = tuple[int, ...]


def next_stance(
    robot: Robot, theta: Array, *, contact: Contact, always_balanced: bool = False
) -> Stance:
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
        always_balanced: If the centre of mass is outside the triangle so found, touchdown or not,
            let the robot topple: choose in the same way among all triples of legs. The thesis's
            text describes both; its sequence, Eq. (3-33), is computed without.

    Returns:
        The stance; `Stance.standing` is the new contact state.

    Raises:
        DomainError: All legs of `contact` lie on one line or are fewer than three, or no three of
            the legs to choose from leave every other leg on or above the ground.
    """
    before = _widest(robot, theta, contact)
    touched = np.flatnonzero(_touchdowns(before, contact))
    stance = before
    if len(touched):
        stance = _best(robot, theta, [t for t in TRIPLES if np.isin(touched, t).any()])
    if always_balanced and stance.depth < 0:
        return _best(robot, theta, list(TRIPLES))
    return stance


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
    return bool(np.all(stance.clearance[list(contact)] >= -ON_GROUND))


def _touchdowns(stance: Stance, contact: Contact) -> NDArray[np.bool_]:
    """Return which legs outside `contact` are on or below the ground of a stance, shape (6,)."""
    flying = np.ones(N_LEGS, dtype=bool)
    flying[list(contact)] = False
    return flying & (stance.clearance <= 0)


def _best(robot: Robot, theta: Array, triples: list[NDArray[np.intp]]) -> Stance:
    """Select the most level feasible stance that holds the robot, else that nearest to holding.

    Feasible: no leg is below the ground; raise `DomainError` if no triple is. Holds: the centre of
    mass is inside the triangle.
    """
    feasible = [stance for stance in _stances(robot, theta, triples) if stance.feasible]
    if not feasible:
        angles = ", ".join(f"{angle:.4g}" for angle in theta)
        raise DomainError(
            f"at leg angles {angles} rad no three of the legs to choose from keep the others on or "
            "above the ground; start from legs that can hold the robot, or take shorter steps"
        )
    holding = [stance for stance in feasible if stance.depth >= -ON_GROUND]
    if holding:
        return max(holding, key=lambda stance: stance.up[2])  # the most level
    return max(feasible, key=lambda stance: stance.depth)


def _stances(robot: Robot, theta: Array, triples: list[NDArray[np.intp]]) -> list[Stance]:
    """Stand on each triple of legs whose feet span a triangle seen from above."""
    stances = []
    for three in triples:
        with suppress(DomainError):  # the feet lie on one line
            stances.append(stand(robot, theta, legs=three))
    return stances
