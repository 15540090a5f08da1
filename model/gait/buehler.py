# SPDX-License-Identifier: MIT
"""The Buehler clock: two tripods, half a cycle apart."""

import numpy as np
from numpy.typing import ArrayLike

from model.arrays import Array
from model.errors import DomainError
from model.gait.cyclic import CyclicReference
from model.gait.notation import TRIPOD


def centred_time(t: ArrayLike, cycle_time: float) -> Array:
    r"""Wrap times into the cycle around mid stance, Eq. (2-4).

    .. math::
        \bar t = (t + \tau_c/2) \bmod \tau_c - \tau_c/2

    The thesis puts the result into (-tau_c/2, tau_c/2]; its formula, and this, into
    [-tau_c/2, tau_c/2). The clock is continuous there up to whole turns.

    Args:
        t: Times [s].
        cycle_time: tau_c [s].
    """
    half = cycle_time / 2
    return (np.asarray(t, dtype=float) + half) % cycle_time - half


def buehler_clock(
    t: ArrayLike,
    stance_angle: float,
    *,
    ground_time: float,
    cycle_time: float,
    turn: float = 2 * np.pi,
) -> Array:
    r"""Compute the leg angle from mid stance of the left tripod, Eq. (2-5).

    .. math::
        \theta(t) = \begin{cases}
            \theta_s \bar t / \tau_g & |\bar t| < \tau_g/2 \\
            \pm\theta_s/2 + \frac{\Theta - \theta_s}{\tau_c - \tau_g}(\bar t \mp \tau_g/2)
                & \pm\bar t \ge \tau_g/2
        \end{cases}

    The right tripod is the left one half a cycle later, Eq. (2-6).

    The thesis has Theta = pi instead of 2 pi: its legs turn by half a turn in a cycle and jump by
    pi between cycles. The thesis also lost a sign in the condition of the third case. With the
    default `turn` the clock closes on a whole turn.

    Args:
        t: Times from mid stance of the left tripod [s].
        stance_angle: theta_s, the angle covered on the ground [rad].
        ground_time: tau_g [s].
        cycle_time: tau_c [s].
        turn: Theta, the turn of a leg in a cycle; pi as published [rad].

    Returns:
        Angles in [-turn/2, turn/2], zero at mid stance [rad].

    Raises:
        DomainError: The ground time is not between zero and the cycle time, or the stance angle not
            between zero and `turn`.
    """
    _require_clock(stance_angle, ground_time=ground_time, cycle_time=cycle_time, turn=turn)
    t_bar = centred_time(t, cycle_time)
    flight_speed = (turn - stance_angle) / (cycle_time - ground_time)
    past = np.abs(t_bar) - ground_time / 2
    flown = np.sign(t_bar) * (stance_angle / 2 + flight_speed * past)
    return np.where(past < 0, stance_angle * t_bar / ground_time, flown)


def buehler_reference(
    touchdown: float, liftoff: float, *, ground_time: float, cycle_time: float
) -> CyclicReference:
    """Compute the leg angles of a Buehler clock that turns the legs by 2 pi a cycle.

    At time zero legs 1, 4 and 5 are in mid stance, halfway between touchdown and lift-off, and
    legs 2, 3 and 6 half a cycle from it.

    Args:
        touchdown: Touchdown angle [rad].
        liftoff: Lift-off angle [rad].
        ground_time: tau_g [s].
        cycle_time: tau_c [s].

    Returns:
        Leg angles of six legs, (touchdown + liftoff)/2 in mid stance.

    Raises:
        DomainError: The ground time is not between zero and the cycle time, or lift-off does not
            exceed touchdown by less than a turn.
    """
    _require_clock(
        liftoff - touchdown, ground_time=ground_time, cycle_time=cycle_time, turn=2 * np.pi
    )
    mid_stance = ground_time / 2 / cycle_time
    return CyclicReference(
        touchdown=np.array(touchdown),
        liftoff=np.array(liftoff),
        ground_time=np.array(ground_time),
        flight_time=np.array(cycle_time - ground_time),
        phase=np.where(TRIPOD.group_of == 0, mid_stance, mid_stance + 0.5),
    )


def _require_clock(
    stance_angle: float, *, ground_time: float, cycle_time: float, turn: float
) -> None:
    """Raise `DomainError` unless 0 < ground time < cycle time and 0 < stance angle < turn."""
    if not 0 < ground_time < cycle_time:
        raise DomainError(
            f"the ground time is {ground_time:g} s of a cycle of {cycle_time:g} s; expected more "
            "than zero, and less than the cycle"
        )
    if not 0 < stance_angle < turn:
        raise DomainError(
            f"stance angle (lift-off minus touchdown) is {np.degrees(stance_angle):g} degrees; "
            f"expected above 0 and below {np.degrees(turn):g}"
        )
