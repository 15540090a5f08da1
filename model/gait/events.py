# SPDX-License-Identifier: MIT
"""Touchdown and lift-off events of a gait, their max-plus linear system, and its leg angles."""

from dataclasses import dataclass
from functools import cached_property

import numpy as np
from numpy.typing import ArrayLike

from model.arrays import Array
from model.errors import DomainError
from model.gait.cyclic import CyclicReference
from model.gait.maxplus import coupling_time, eigenvalue, eigenvector, otimes, solve_implicit
from model.gait.notation import Gait
from model.gait.stance import Intervals, event_intervals

_SAME_TIME = 1e-9  # s: events nearer than this are one knot of a leg reference


@dataclass(frozen=True)
class EventTimes:
    """Touchdown and lift-off times of each leg, cycle by cycle.

    Attributes:
        touchdown: Touchdown of each leg (column) in each cycle (row), shape (k, n) [s].
        liftoff: Lift-off that precedes that touchdown, shape (k, n) [s].
    """

    touchdown: Array
    liftoff: Array

    def stance_intervals(self, span: tuple[float, float]) -> Intervals:
        """Pair each touchdown of a leg with the lift-off of the next cycle; the last has none.

        Args:
            span: Start and end; intervals are cut there, and left out outside [s].

        Returns:
            One array of stance intervals, rows (start, end), shape (k, 2), for each leg [s].
        """
        return event_intervals(self.touchdown[:-1], self.liftoff[1:], span)


@dataclass(frozen=True, eq=False)
class EventSystem:
    r"""A gait as a max-plus linear system of touchdown and lift-off times.

    .. math::
        x(k) = A_0 \otimes x(k) \oplus A_1 \otimes x(k-1), \qquad
        x(k) = \begin{bmatrix} t(k) \\ l(k) \end{bmatrix}

    with the touchdown times t and lift-off times l of n legs in cycle k, Eq. (2-13) and (2-14).

    Attributes:
        A0: Least delay of each event (row) after events of the same cycle (columns), -inf for
            none, shape (2n, 2n) [s].
        A1: Least delay of each event (row) after events of the cycle before (columns), likewise.
        gait: The groups of legs.
    """

    A0: Array
    A1: Array
    gait: Gait

    @property
    def n_legs(self) -> int:
        """Number of legs."""
        return self.gait.n_legs

    @cached_property
    def matrix(self) -> Array:
        r"""Matrix of the explicit form, :math:`A_0^* \otimes A_1`, shape (2n, 2n) [s].

        With it :math:`x(k) = A_0^* \otimes A_1 \otimes x(k-1)`. Raises `DomainError` if events of
        one cycle wait for each other in a circle.
        """
        return solve_implicit(self.A0, self.A1)

    @cached_property
    def cycle_time(self) -> float:
        """Cycle time of the steady state, the eigenvalue of `matrix`; -inf without repeats [s]."""
        return eigenvalue(self.matrix)

    @cached_property
    def coupling_time(self) -> int:
        """Number of cycles after which events are periodic, whatever the start.

        Raises `DomainError` if events do not repeat.
        """
        return coupling_time(self.matrix)

    @cached_property
    def steady_state(self) -> EventTimes:
        """Event times of one cycle of the steady state, (1, n) each; repeat every `cycle_time`.

        Raises `DomainError` if events do not repeat.
        """
        return _events(eigenvector(self.matrix)[None])

    def events(self, cycles: int, *, start: ArrayLike | None = None) -> EventTimes:
        """Compute the touchdowns and lift-offs of a number of cycles from a start.

        Args:
            cycles: Number of cycles after the start.
            start: Touchdown and lift-off times of cycle 0, shape (2n,); all zero when None [s].

        Returns:
            Events of cycles 0 to `cycles`.

        Raises:
            DomainError: The start does not have two events a leg, or events of one cycle wait for
                each other in a circle.
        """
        x = np.zeros(2 * self.n_legs) if start is None else np.asarray(start, dtype=float)
        if x.shape != (2 * self.n_legs,):
            raise DomainError(
                f"start has shape {x.shape}; expected ({2 * self.n_legs},), a touchdown for each "
                "leg and then a lift-off for each"
            )
        found = [x]
        for _ in range(cycles):
            found.append(otimes(self.matrix, found[-1]))
        return _events(np.array(found))


def _events(x: Array) -> EventTimes:
    """Split rows of n touchdown and n lift-off times, shape (k, 2n), into event times."""
    n = x.shape[1] // 2
    return EventTimes(x[:, :n], x[:, n:])


def scheduled_reference(
    system: EventSystem, touchdown: ArrayLike, *, liftoff: ArrayLike, inner: tuple[int, ...] = ()
) -> CyclicReference:
    """Compute periodic leg angles, linear between the events of a schedule's steady state.

    Time zero is the first touchdown of the first group; every leg has a phase from 0 to 1.

    Args:
        system: The scheduler.
        touchdown: Touchdown angles, a number or shape (n,) [rad].
        liftoff: Lift-off angles, a number or shape (n,) [rad].
        inner: Indices of the inner legs of a turn; only stored in the result.

    Returns:
        Leg angles; their period is the system's cycle time.

    Raises:
        DomainError: A lift-off angle does not exceed touchdown by less than a turn, there is not
            one angle a leg, or the system has no steady state.
    """
    period = system.cycle_time
    down, up = system.steady_state.touchdown[0], system.steady_state.liftoff[0]
    flight = down - up
    since = down[system.gait.group_of == 0].min() - down
    phase = since / period
    phase = phase - np.floor(phase + _SAME_TIME)
    return CyclicReference(
        touchdown=np.asarray(touchdown, dtype=float),
        liftoff=np.asarray(liftoff, dtype=float),
        ground_time=period - flight,
        flight_time=flight,
        phase=np.maximum(phase, 0.0),
        inner=inner,
    )
