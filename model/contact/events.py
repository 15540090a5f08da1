# SPDX-License-Identifier: MIT
"""Touchdown and lift-off by a search over contact states, section 3-5-2."""

from collections.abc import Callable
from contextlib import suppress
from itertools import combinations

import numpy as np
from numpy.typing import NDArray

from model.arrays import Array
from model.contact.stance import TRIPLES, Stance, stand
from model.errors import DomainError
from model.robot import N_LEGS, Robot

Contact = tuple[int, ...]
StandOn = Callable[[NDArray[np.intp]], Stance]
"""Computes the stance on three legs; raises `DomainError` if they lie on a line."""


def next_stance(
    robot: Robot,
    theta: Array,
    *,
    contact: Contact,
    always_balanced: bool = False,
    stand_on: StandOn | None = None,
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
        stand_on: How the robot stands on three legs at these angles; None for flat, level ground.

    Returns:
        The stance; `Stance.standing` is the new contact state.

    Raises:
        DomainError: All legs of `contact` lie on one line or are fewer than three, or no three of
            the legs to choose from leave every other leg on or above the ground.
    """
    stand_on = stand_on or _on_flat_ground(robot, theta)
    before = _widest(stand_on, contact)
    touched = np.flatnonzero(_touchdowns(before, contact))
    stance = before
    if len(touched):
        stance = best_stance(
            stand_on, theta, [three for three in TRIPLES if np.isin(touched, three).any()]
        )
    if always_balanced and stance.depth < 0:
        return best_stance(stand_on, theta, list(TRIPLES))
    return stance


def best_stance(stand_on: StandOn, theta: Array, triples: list[NDArray[np.intp]]) -> Stance:
    """Select the most level feasible stance that holds the robot, else that nearest to holding.

    Args:
        stand_on: How the robot stands on three legs.
        theta: Leg angles, for the message of an error, shape (6,) [rad].
        triples: The triples of legs to choose from.

    Raises:
        DomainError: On every triple another leg is below the ground.
    """
    feasible = [stance for stance in _stances(stand_on, triples) if stance.feasible]
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


def _on_flat_ground(robot: Robot, theta: Array) -> StandOn:
    """Return how a robot stands on three legs on flat, level ground."""

    def stand_on(legs: NDArray[np.intp]) -> Stance:
        """Return the stance on three legs."""
        return stand(robot, theta, legs=legs)

    return stand_on


def _widest(stand_on: StandOn, contact: Contact) -> Stance:
    """Stand on the three contact legs with the centre of mass deepest inside their triangle.

    Triples that leave every contact leg on or above the ground go first. Raise `DomainError` if the
    contact legs lie on one line.
    """
    stances = _stances(stand_on, [np.array(three) for three in combinations(contact, 3)])
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


def _stances(stand_on: StandOn, triples: list[NDArray[np.intp]]) -> list[Stance]:
    """Stand on each triple of legs whose feet span a triangle seen from above."""
    stances = []
    for three in triples:
        with suppress(DomainError):  # the feet lie on one line
            stances.append(stand_on(three))
    return stances
