# SPDX-License-Identifier: MIT
"""Max-plus scheduler of a turn: longer stance for the inner legs."""

import numpy as np

from model.errors import DomainError
from model.gait.events import EventSystem
from model.gait.maxplus import diagonal, identity, oplus, otimes, zeros
from model.gait.notation import Gait
from model.gait.scheduler import precedence, require_times


def turning_system(
    gait: Gait,
    *,
    inner: tuple[int, ...],
    ground_time: float,
    flight_time: float,
    turn_time: float,
    double_stance: float = 0.0,
) -> EventSystem:
    r"""Build the max-plus system of a turn from leg groups and times, Eq. (2-15).

    .. math::
        x(k) = \begin{bmatrix} \mathcal{E} & \tau_f \otimes M \\ R & \mathcal{E} \end{bmatrix}
               \otimes x(k) \oplus
               \begin{bmatrix} E & \mathcal{E} \\ \tau_g \otimes N \oplus T & E \end{bmatrix}
               \otimes x(k-1)

    with touchdowns t and lift-offs l in x, the identity E and zero matrix of `model.gait.maxplus`.
    The thesis gives the four event equations of 2-3-3 and leaves the matrices to its predecessor's
    report. They follow from two demands.

    *Stance and flight.* With superscripts i and o for inner and outer legs,

    .. math::
        t^i(k) = l^i(k) + \tau_f, \quad t^o(k) = l^o(k) + \tau_f + \tau_p, \quad
        l^i(k) \ge t^i(k-1) + \tau_g + \tau_p, \quad l^o(k) \ge t^o(k-1) + \tau_g ,

    so M and N are diagonal, tau_p being the entry of M for an outer leg and of N for an inner one,
    and e the entry of M for an inner leg and of N for an outer one.

    *Order.* A leg lifts off only when every leg of the group before its own has stood for
    tau_Delta, :math:`l_p(k) \ge t_q(k) + \tau_\Delta`, and for the first group
    :math:`l_p(k) \ge t_q(k-1) + \tau_\Delta`. This bounds event times, and the later touchdown of
    an outer leg is in its t_q already; so no side enters again: R is P and T is Q. Written for
    lift-offs it would: a leg that follows an outer one waits for
    :math:`l_q + \tau_f + \tau_p + \tau_\Delta`.

    The E blocks say that no event happens before the same event one cycle earlier. The legs' own
    circuits demand more than that, so they change no event time; they connect lift-offs across
    cycles, which makes the explicit matrix irreducible, with one cycle time whatever the start.

    A leg's own circuit takes tau_g + tau_f + tau_p on either side: one period for all. The circuit
    through the m groups takes tau_f + tau_p + tau_Delta for each that has an outer leg, and
    tau_f + tau_Delta for each other one. Hence, with an outer leg in every group,

    .. math::
        \lambda = \max\bigl(\tau_g + \tau_f + \tau_p,\ m\,(\tau_f + \tau_p + \tau_\Delta)\bigr) ,

    and where the second is larger all legs stand longer by the difference. A tripod with
    tau_g = tau_f thus needs 2 tau_f + 2 tau_p + 2 tau_Delta. With tau_p = 0 the event times are
    those of `straight_system`.

    Args:
        gait: Groups of legs.
        inner: Indices (leg number minus one) of the legs on the inner side of the turn.
        ground_time: tau_g [s].
        flight_time: tau_f [s].
        turn_time: tau_p, by which inner legs stand and outer legs fly longer [s].
        double_stance: tau_Delta, the time that a group and its successor stand together [s].

    Raises:
        DomainError: A time is negative or not finite, a leg has no time in flight or on the ground,
            or an inner leg does not exist.
    """
    require_times(ground_time=ground_time, flight_time=flight_time, double_stance=double_stance)
    require_times(turn_time=turn_time)
    n = gait.n_legs
    if not set(inner) <= set(range(n)):
        raise DomainError(f"inner legs have the indices {inner}; expected some of 0 to {n - 1}")
    is_inner = np.isin(np.arange(n), inner)
    M = diagonal(np.where(is_inner, 0.0, turn_time))
    N = diagonal(np.where(is_inner, turn_time, 0.0))
    R, T = precedence(gait, double_stance)
    A0 = np.block([[zeros(n, n), otimes(flight_time, M)], [R, zeros(n, n)]])
    A1 = np.block([[identity(n), zeros(n, n)], [oplus(otimes(ground_time, N), T), identity(n)]])
    return EventSystem(A0, A1, gait)
