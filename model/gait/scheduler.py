# SPDX-License-Identifier: MIT
"""Max-plus scheduler of a straight walk."""

import numpy as np

from model.arrays import Array
from model.errors import DomainError
from model.gait.events import EventSystem
from model.gait.maxplus import EPSILON, identity, oplus, otimes, zeros
from model.gait.notation import Gait


def precedence(gait: Gait, double_stance: float) -> tuple[Array, Array]:
    r"""Build P and Q, the matrices of least delays between groups, below Eq. (2-14).

    .. math::
        [P]_{pq} = \tau_\Delta \text{ for } p \in \ell_{j+1},\ q \in \ell_j, \qquad
        [Q]_{pq} = \tau_\Delta \text{ for } p \in \ell_1,\ q \in \ell_m

    and epsilon, minus infinity, elsewhere: lift-off of leg p (row) after touchdown of leg q.

    Args:
        gait: Groups l_1 to l_m.
        double_stance: tau_Delta, the time that a group and its successor stand together [s].

    Returns:
        P, for touchdowns of the same cycle, and Q, for those of the cycle before; (n, n) each [s].
    """
    group = gait.group_of
    last = len(gait.groups) - 1
    waits = group[:, None] == group[None, :] + 1
    wraps = (group[:, None] == 0) & (group[None, :] == last)
    return np.where(waits, double_stance, EPSILON), np.where(wraps, double_stance, EPSILON)


def straight_system(
    gait: Gait, *, ground_time: float, flight_time: float, double_stance: float = 0.0
) -> EventSystem:
    r"""Build the max-plus system of a straight walk from leg groups and times, Eq. (2-13).

    .. math::
        x(k) = \begin{bmatrix} \mathcal{E} & \tau_f \otimes E \\ P & \mathcal{E} \end{bmatrix}
               \otimes x(k) \oplus
               \begin{bmatrix} \mathcal{E} & \mathcal{E} \\ \tau_g \otimes E \oplus Q & \mathcal{E}
               \end{bmatrix} \otimes x(k-1)

    with the identity E and zero matrix of `model.gait.maxplus`, P and Q of `precedence`. A leg
    touches down tau_f after lift-off. It lifts off once it has stood for tau_g and the group before
    its own has stood for tau_Delta, whichever is later: tau_g is the least time on the ground. With
    m groups the cycle time is

    .. math::
        \lambda = \max\bigl(\tau_g + \tau_f,\ m\,(\tau_f + \tau_\Delta)\bigr) .

    Args:
        gait: Groups of legs.
        ground_time: tau_g [s].
        flight_time: tau_f [s].
        double_stance: tau_Delta [s].

    Raises:
        DomainError: A time is negative or not finite, or a leg has no time in flight or on the
            ground.
    """
    require_times(ground_time=ground_time, flight_time=flight_time, double_stance=double_stance)
    n = gait.n_legs
    P, Q = precedence(gait, double_stance)
    A0 = np.block([[zeros(n, n), otimes(flight_time, identity(n))], [P, zeros(n, n)]])
    A1 = np.block(
        [[zeros(n, n), zeros(n, n)], [oplus(otimes(ground_time, identity(n)), Q), zeros(n, n)]]
    )
    return EventSystem(A0, A1, gait)


def require_times(**times: float) -> None:
    """Raise `DomainError` unless times are finite, `ground_time` and `flight_time` positive.

    Times of other names may be zero, but not negative.
    """
    for name, value in times.items():
        least = "time above 0" if name in ("ground_time", "flight_time") else "time of 0 or more"
        if not (np.isfinite(value) and (value > 0 or (value == 0 and least != "time above 0"))):
            raise DomainError(f"{name.replace('_', ' ')} is {value:g} s; expected a finite {least}")
