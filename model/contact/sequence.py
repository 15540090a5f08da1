# SPDX-License-Identifier: MIT
"""Contact states of a walk in their order, Eq. (3-33), and the cycle in which they repeat."""

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from model.arrays import Array
from model.robot import N_LEGS

Legs = frozenset[int]
"""A contact state: indices of the legs on the ground."""


def named_legs(legs: Legs) -> str:
    """Format a contact state as the thesis does, by leg numbers; flight is {}.

    >>> named_legs(frozenset({1, 4, 5}))
    '{2,5,6}'
    """
    return "{" + ",".join(str(leg + 1) for leg in sorted(legs)) + "}"


@dataclass(frozen=True)
class ContactState:
    """Legs that stood on the ground together.

    Attributes:
        legs: Indices of the legs on the ground.
        start: Time of the first sample with these legs, or with a shorter state joined to it [s].
        end: Time of the first sample of the next state; of the last state that of the walk's last
            sample [s].
        joined: Number of shorter states that were joined to it.
    """

    legs: Legs
    start: float
    end: float
    joined: int = 0

    @property
    def duration(self) -> float:
        """Time from start to end [s]."""
        return self.end - self.start


@dataclass(frozen=True)
class ContactSequence:
    """The contact states of a walk.

    Attributes:
        states: The states, in order; neighbours differ.
        least: States that lasted less were joined to the next that lasted longer [s].
        joined: Number of states that were joined.
        joined_time: Time that these lasted together [s].
    """

    states: tuple[ContactState, ...]
    least: float
    joined: int
    joined_time: float


def contact_states(t: Array, contact: NDArray[np.bool_], *, least: float = 0.0) -> ContactSequence:
    """List the contact states of a walk, short ones joined to the state that follows.

    A leg that carries little load may leave the ground for a step or two and return, and legs that
    should touch down together do so some steps apart. States shorter than `least` are joined to the
    next that is not, at the end of the walk to the one before; neighbours that are then equal
    become one. If no state lasts that long, all are kept.

    Args:
        t: Times of the samples, increasing, shape (n,) [s].
        contact: Which legs are on the ground, shape (n, 6).
        least: Shortest time that a state has to last [s].
    """
    key = contact @ (1 << np.arange(N_LEGS))  # a bit for each leg: one number for each state
    begins = np.concatenate([[0], np.flatnonzero(np.diff(key)) + 1])
    starts, ends = t[begins], np.append(t[begins[1:]], t[-1])
    lasts = ends - starts >= least - 1e-9
    if not lasts.any():
        lasts[:] = True
    # A state that is too short belongs to the next lasting one, after the last one to that.
    kept = np.flatnonzero(lasts)
    owner = np.minimum(np.searchsorted(kept, np.arange(len(begins))), len(kept) - 1)
    states: list[ContactState] = []
    for own in range(len(kept)):
        members = np.flatnonzero(owner == own)
        legs = frozenset(np.flatnonzero(contact[begins[kept[own]]]).tolist())
        start, end = float(starts[members[0]]), float(ends[members[-1]])
        joined = len(members) - 1
        if states and states[-1].legs == legs:
            before = states.pop()
            start, joined = before.start, joined + before.joined
        states.append(ContactState(legs, start, end, joined))
    short = ~lasts
    return ContactSequence(
        tuple(states), least, int(short.sum()), float((ends - starts)[short].sum())
    )


@dataclass(frozen=True)
class ContactCycle:
    """The contact states of one cycle of a periodic walk.

    Attributes:
        period: Duration of a cycle [s].
        states: States of a cycle in order, the first beginning at `begins[0]`.
        begins: Mean time at which each state begins, after the beginning of a cycle; increasing,
            from 0 to below the period, shape (k,) [s].
        spread: Largest minus smallest of the times that `begins` is the mean of, shape (k,) [s].
        settled: Time from which the walk repeats; what is before is transient [s].
        cycles: Number of whole cycles from then on, at least two.
    """

    period: float
    states: tuple[Legs, ...]
    begins: Array
    spread: Array
    settled: float
    cycles: int

    def __str__(self) -> str:
        """Format as Eq. (3-33), from the state in which a cycle begins, with times in brackets."""
        first = named_legs(self.states[-1])
        after = (
            f"{named_legs(legs)} ({begin:.2f} s)"
            for legs, begin in zip(self.states, self.begins, strict=True)
        )
        return " → ".join([first, *after])


def contact_cycle(
    sequence: ContactSequence, period: float, *, tolerance: float, start: float = 0.0
) -> ContactCycle | None:
    """Find the cycle in which contact states repeat, and from when on they do.

    From the end of the walk backwards, each state is compared with the one a period earlier.

    Args:
        sequence: The contact states of a walk.
        period: Duration of a cycle of the gait [s].
        tolerance: Largest difference between the beginnings of a state and of its repetition, less
            the period [s].
        start: Time of the beginning of a cycle [s].

    Returns:
        The cycle; None if the last two periods do not repeat, or the state never changes.
    """
    states = sequence.states
    count = _states_of_a_cycle(states, period, tolerance)
    if count is None:
        return None
    first = len(states) - 1 - count
    while first > 1 and _repeats(states, first - 1, count, period, tolerance):
        first -= 1
    if len(states) - first < 2 * count:
        return None
    return _cycle(states[first:], count, period, tolerance, start)


def _states_of_a_cycle(
    states: tuple[ContactState, ...], period: float, tolerance: float
) -> int | None:
    """Return the number of states in a cycle; None if the last state has no repetition.

    It is counted from the last state back to the nearest one of the same legs that began a period
    earlier, within `tolerance`.
    """
    last = len(states) - 1
    for count in range(1, last):  # the first state began before the walk
        if _repeats(states, last - count, count, period, tolerance):
            return count
    return None


def _repeats(
    states: tuple[ContactState, ...], i: int, count: int, period: float, tolerance: float
) -> bool:
    """Return whether states i and i + count have the same legs and begin a period apart."""
    one, other = states[i], states[i + count]
    return one.legs == other.legs and abs(other.start - one.start - period) <= tolerance


def _cycle(
    states: tuple[ContactState, ...], count: int, period: float, tolerance: float, start: float
) -> ContactCycle:
    """Average the beginnings of states that repeat every `count` states, over their cycles.

    `start` is the time at which a cycle begins; states are sorted by their time after that.
    """
    number = np.arange(len(states)) // count
    begins = np.array([state.start for state in states]) - start - number * period
    mean = np.array([begins[k::count].mean() for k in range(count)])
    spread = np.array([np.ptp(begins[k::count]) for k in range(count)])
    within = np.round(mean % period, 9)
    within[within > period - 0.5 * tolerance] = 0.0  # a cycle begins with it, but for rounding
    order = np.argsort(within, kind="stable")
    return ContactCycle(
        period,
        tuple(states[k].legs for k in order),
        within[order],
        spread[order],
        states[0].start,
        len(states) // count,
    )
