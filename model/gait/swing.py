# SPDX-License-Identifier: MIT
"""Swing of legs that leave, or return to, the ground at other angles than those of their gait."""

import numpy as np
from numpy.typing import NDArray

from model.arrays import Array
from model.gait.steering import highest_hip, ideal_liftoff
from model.leg import hip_height, wrap_angle
from model.robot import LEFT, N_LEGS, RIGHT

TURN = 2 * np.pi
LEAST_SWING = np.pi / 2  # a leg that swings less far may not leave the ground
_LEANS = np.radians(1.0)  # from its highest hip: nearer to it a leg leaves the ground either way
_HALVINGS = 40  # of a bracket of less than half a turn


def swing(
    lifted: Array, touchdown: Array, sense: Array, *, leg_arc: float, clear: bool
) -> tuple[Array, Array]:
    """Compute unwrapped angles at touchdown, and where legs that swing to and fro turn round.

    A leg that turns forwards leaves the ground beyond the angle of its highest hip; one that turns
    backwards, before it. Turned the other way, it would first stand up and push the robot on.

    Args:
        lifted: Angles at lift-off, shape (6,) [rad].
        touchdown: Angles at touchdown, wrapped, shape (6,) [rad].
        sense: 1 for a leg that turns forwards, -1 backwards, shape (6,).
        leg_arc: Angle of the legs' arc [rad].
        clear: Whether a leg that would not leave the ground in its sense turns by 90 degrees
            against it, and back.

    Returns:
        Angles at touchdown, reached in the leg's sense, and those at which legs turn round, NaN for
        others, shape (6,) each [rad].
    """
    beyond = wrap_angle(lifted - highest_hip(leg_arc))
    to_and_fro = clear & (sense * beyond < -_LEANS)
    turned = np.where(to_and_fro, lifted - sense * LEAST_SWING, lifted)
    flown = (sense * (touchdown - turned)) % TURN
    flown = np.where(~to_and_fro & (flown < LEAST_SWING), flown + TURN, flown)
    return turned + sense * flown, np.where(to_and_fro, turned, np.nan)


def landing_angles(
    angles: Array, flies: NDArray[np.bool_], sense: Array, *, leg_arc: float
) -> Array:
    """Compute at which angles legs in flight touch the ground beside legs that stand still.

    The hips of a side are as high as that of the highest leg that stands there, of any leg where
    none does; the robot rolls, but hardly pitches, on legs that differ by side.

    Args:
        angles: Leg angles, shape (6,) [rad].
        flies: Which legs are in flight, not all, shape (6,).
        sense: 1 for a leg that turns forwards, -1 backwards, shape (6,).
        leg_arc: Angle of the legs' arc [rad].

    Returns:
        Angles of legs in flight, wrapped; the others' are returned as they are, shape (6,) [rad].
    """
    height, found = _height(angles, leg_arc), angles.copy()
    for side in (LEFT, RIGHT):
        mine = np.isin(np.arange(N_LEGS), side)
        stand = ~flies & mine if np.any(~flies & mine) else ~flies
        early = _rising_angle(float(height[stand].max()), leg_arc)
        touching = np.where(sense > 0, early, float(ideal_liftoff(early, leg_arc)))
        found = np.where(flies & mine, touching, found)
    return found


def _rising_angle(height: float, leg_arc: float) -> float:
    """Return the leg angle, before that of the highest hip, at which the hip has a height [rad].

    `height` is over the leg's radius. Found by bisection; the end of the range if out of reach.
    """
    low, high = -np.pi / 2 + 1e-9, highest_hip(leg_arc) - 1e-9
    for _ in range(_HALVINGS):
        middle = (low + high) / 2
        low, high = (low, middle) if _height(np.array(middle), leg_arc) > height else (middle, high)
    return low


def _height(theta: Array, leg_arc: float) -> Array:
    """Return the hip's height over leg radius at leg angles of a level body [-]."""
    phi = wrap_angle(np.pi / 2 - theta)
    return np.asarray(hip_height(phi, 1.0, leg_arc - np.pi))
