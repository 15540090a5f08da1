# SPDX-License-Identifier: MIT
"""The thesis's emulation of turning by stance times, without max-plus algebra."""

import numpy as np

from model.errors import DomainError
from model.gait.cyclic import CyclicReference
from model.gait.direction import Direction, inner_legs, is_inner
from model.gait.notation import TRIPOD


def suriana_reference(
    touchdown: float,
    liftoff: float,
    *,
    ground_time: float,
    flight_time: float,
    turn_time: float = 0.0,
    direction: Direction = "left",
) -> CyclicReference:
    r"""Compute the leg angles of a tripod that turns by its stance times, Eq. (5-1) to (5-4).

    .. math::
        \dot\theta_g^i = \frac{\theta_{LO} - \theta_{TD}}{\tau_g + \tau_p}, \quad
        \dot\theta_g^o = \frac{\theta_{LO} - \theta_{TD}}{\tau_g}, \quad
        \dot\theta_f^i = \frac{2\pi - (\theta_{LO} - \theta_{TD})}{\tau_f}, \quad
        \dot\theta_f^o = \frac{2\pi - (\theta_{LO} - \theta_{TD})}{\tau_f + \tau_p}

    Inner and outer legs share the period tau_g + tau_f + tau_p. At time zero legs 1, 4 and 5 touch
    down and legs 2, 3 and 6 lift off, whichever way the robot turns (Listing A.6). For that reason,
    and as the sides differ in timing, a right turn is not the mirror image of a left turn at any
    later time, as the steering-factor tripod's is; `CyclicReference.mirrored` returns the image.

    In the text of 5-2-1 speeds switch as contact is detected; in Listing A.33, and here, as the
    angle passes touchdown and lift-off. For tau_g = tau_f the outer legs of one tripod
    lift off tau_p before those of the other touch down: for that long, once a cycle, every outer
    leg is in flight. `turning_system` schedules the same turn without it.

    Args:
        touchdown: Touchdown angle of every leg [rad].
        liftoff: Lift-off angle of every leg [rad].
        ground_time: tau_g [s].
        flight_time: tau_f [s].
        turn_time: tau_p, how much longer inner legs stand and outer legs fly [s].
        direction: Side to which the robot turns.

    Returns:
        Leg angles; their `inner` is empty if the turn time is 0.

    Raises:
        DomainError: The turn time is negative, another time not positive, one not finite, the
            direction unknown, or lift-off does not exceed touchdown by less than a turn.
    """
    if not turn_time >= 0:
        raise DomainError(
            f"turn time is {turn_time:g} s; expected zero or more: choose the side with direction"
        )
    inner = is_inner(direction)
    ground = np.where(inner, ground_time + turn_time, ground_time)
    flight = np.where(inner, flight_time, flight_time + turn_time)
    return CyclicReference(
        touchdown=np.array(touchdown),
        liftoff=np.array(liftoff),
        ground_time=ground,
        flight_time=flight,
        phase=TRIPOD.group_of * ground / (ground + flight),
        inner=inner_legs(direction) if turn_time > 0 else (),
    )
