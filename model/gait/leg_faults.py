# SPDX-License-Identifier: MIT
"""Suspect a wrong sign, zero or order of measured leg angles, from the gait that they show.

The rules hold for every gait of this package, forwards, backwards and on the spot: a leg is slowest
on the ground, where its angle is about pi/2; the legs of one side turn the same way; and the rules
of `model.gait.leg_order`. Angles that break one are possible, but a wrong column map is likelier.
"""

from dataclasses import dataclass
from typing import Final, TypeAlias

import numpy as np
from numpy.typing import NDArray

from model.arrays import Array
from model.gait.leg_motion import CLEAR, LegMotion
from model.gait.leg_order import SIDE, OrderFault, order_fault

_DOWN: Final = np.pi / 2
_FARTHEST: Final = np.radians(35)  # middle of a stance from straight down
_QUARTER: Final = np.radians(15)  # from a multiple of 90 degrees
Legs: TypeAlias = NDArray[np.bool_]


@dataclass(frozen=True)
class SignFault:
    """Legs that pass straight up where they are slow, and turn backwards.

    Attributes:
        legs: Numbers of the legs.
    """

    legs: tuple[int, ...]


@dataclass(frozen=True)
class DirectionFault:
    """Legs that turn against the other legs of their side, once signs are repaired.

    Attributes:
        legs: Numbers of the legs.
    """

    legs: tuple[int, ...]


@dataclass(frozen=True)
class ZeroFault:
    """Legs whose angle is not about pi/2 in the middle of their stance.

    Attributes:
        legs: Numbers of the legs.
        found: Angle in the middle of their stance, of each of these legs, shape (k,) [rad].
        offset: What is to be added to their angle, in [-pi, pi), shape (k,) [rad].
        reversed: Those of the legs whose sign is to be changed before, if they walk forward.
    """

    legs: tuple[int, ...]
    found: Array
    offset: Array
    reversed: tuple[int, ...] = ()


LegFault: TypeAlias = SignFault | DirectionFault | ZeroFault | OrderFault


def leg_faults(motion: LegMotion) -> list[LegFault]:
    """Return what is suspected of the angles of a walk; empty where they agree with all rules.

    Args:
        motion: How the legs turned, with the signs and zeros that are to be judged.
    """
    mirrored = _mirrored(motion)
    zero = _zero_fault(motion, mirrored)
    direction = np.where(mirrored, -motion.direction, motion.direction)
    order = order_fault(motion, direction)
    against = motion.turning & (direction != 0) & (direction == -_usual_direction(direction))
    faults: list[LegFault] = [SignFault(_numbers(mirrored))] if mirrored.any() else []
    faults += [fault for fault in (zero, order) if fault is not None]
    if against.any() and order is None:
        faults.append(DirectionFault(_numbers(against)))
    return faults


def _mirrored(motion: LegMotion) -> Legs:
    """Return which legs are measured with the wrong sign: they stand straight up, turn backwards.

    Within `_FARTHEST` of straight up. Backwards is against most legs of their side that stand
    straight down, or where no such leg turns, with falling angle.
    """
    up = np.abs(_wrapped(motion.centre + _DOWN)) <= _FARTHEST
    down = np.abs(_wrapped(motion.centre - _DOWN)) <= _FARTHEST
    usual = _usual_direction(np.where(_judged(motion) & down, motion.direction, 0))
    return _judged(motion) & up & (motion.direction == np.where(usual == 0, -1, -usual))


def _zero_fault(motion: LegMotion, mirrored: Legs) -> ZeroFault | None:
    """Return the legs whose middle of stance is further than `_FARTHEST` from straight down.

    Their signs are unknown: either every leg that turns backwards is reversed, or only those of
    `mirrored`. The choice is that which leaves fewer such legs; of equal ones, that whose legs have
    more nearly the same offset (to 0.01 of the length of the mean phasor); else the first. None
    without such a leg, or where a sharp turn explains them.
    """
    judged = _judged(motion)
    if not judged.any():
        return None
    choices = []
    for reverse in (mirrored | (motion.direction < 0), mirrored):
        offset = _wrapped(_DOWN - np.where(reverse, -1, 1) * motion.centre)
        far = judged & (np.abs(offset) > _FARTHEST)
        unequal = round(1 - float(np.abs(np.exp(1j * offset[judged]).mean())), 2)
        choices.append((int(far.sum()), unequal, offset, far, reverse & ~mirrored))
    _, _, offset, far, reverse = min(choices, key=lambda choice: choice[:2])
    if not far.any() or _may_be_a_turn(offset, far):
        return None
    return ZeroFault(_numbers(far), motion.centre[far], offset[far], _numbers(far & reverse))


def _may_be_a_turn(offset: Array, far: Legs) -> bool:
    """Return whether legs of one side alone are far off, not all by a multiple of 90 degrees.

    In the sharpest turns the outer legs sweep over more than half a turn on the ground, and are
    slower in flight.
    """
    quarter = np.abs((offset[far] + np.pi / 4) % (np.pi / 2) - np.pi / 4)
    return len(set(SIDE[far])) == 1 and bool((quarter > _QUARTER).any())


def _usual_direction(direction: Array) -> Array:
    """Return for each leg the direction of most legs of its side, 0 if equally many, shape (6,)."""
    sums = np.array([direction[side == SIDE].sum() for side in (0, 1)])
    return np.sign(sums)[SIDE]


def _judged(motion: LegMotion) -> Legs:
    """Return which legs turn far enough, and unevenly enough, to know their middle of stance."""
    return motion.turning & (motion.weight >= CLEAR)


def _numbers(legs: Legs) -> tuple[int, ...]:
    """Return the numbers, from 1, of the legs in a mask."""
    return tuple(int(leg) + 1 for leg in np.nonzero(legs)[0])


def _wrapped(angle: Array) -> Array:
    """Wrap angles into [-pi, pi) [rad]."""
    return (angle + np.pi) % (2 * np.pi) - np.pi
