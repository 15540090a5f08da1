# SPDX-License-Identifier: MIT
"""Contact states of a walk and the touchdowns of its legs, and the tables of both."""

from collections.abc import Sequence
from dataclasses import dataclass
from pathlib import Path
from types import MappingProxyType
from typing import Any, Final

import numpy as np
import pandas as pd

from model.arrays import Array
from model.contact.sequence import (
    ContactCycle,
    ContactSequence,
    contact_cycle,
    contact_states,
    named_legs,
)
from model.contact.touchdown import Touchdown, touchdowns
from model.gait import CyclicReference
from model.gait.reference import LegReference
from model.gait.stance import Intervals
from model.walk.path import WalkPath

RULES: Final = MappingProxyType({
    "events": "the thesis's contact detection on rigid legs (3-5-2)",
    "force": "force on the legs",
    "listing": "the thesis's listing (A.32)",
    "text": "the thesis's Table 3-1",
    "rest": "legs on which the robot rests",
})  # fmt: skip
"""What decides contact in a walking model, in words, by its name in `contacts.csv`."""
LEAST_CONTACT: Final = 0.01
"""Contact states that last less are joined to the next: five steps of the model dynamics [s]."""
_REPEATS: Final = 0.01  # of a cycle: how far repetitions of a state may be from a whole cycle apart
_STEADY: Final = 0.02  # of a cycle: how much the turns of a log's legs may differ in duration


@dataclass(frozen=True)
class WalkContacts:
    """Contacts of a walk.

    Attributes:
        by: What decides contact in the model, a key of `RULES`.
        sequence: The contact states in order.
        cycle: The cycle in which they repeat; None if they do not, or the gait has no cycle.
        period: Duration of the gait's cycle; None for a program, or a log without one [s].
        tolerance: How far a repetition of a state may be from a whole cycle later [s].
        touchdowns: Touchdowns of each leg.
    """

    by: str
    sequence: ContactSequence
    cycle: ContactCycle | None
    period: float | None
    tolerance: float
    touchdowns: tuple[Touchdown, ...]

    @property
    def rule(self) -> str:
        """What decides contact, in words."""
        return RULES[self.by]


def contacts_of(
    path: WalkPath, reference: LegReference, *, by: str, stances: Intervals | None = None
) -> WalkContacts:
    """Find contact states, their cycle and the touchdowns of a walk.

    States may differ from a repetition by `_REPEATS` of a cycle, or two time steps if that is more.

    Args:
        path: The walk.
        reference: Leg angles that it was computed from.
        by: What decides contact in the model, a key of `RULES`.
        stances: When each leg stands by a program's schedule, from the walk's start on [s]; None
            for others.
    """
    start, end = float(path.t[0]), float(path.t[-1])
    cyclic = isinstance(reference, CyclicReference)
    period = reference.period if cyclic else _turn_time(path.t, path.theta)
    tolerance = max(_REPEATS * (period or 0.0), 2 * float(path.t[1] - start))
    sequence = contact_states(path.t, path.contact, least=LEAST_CONTACT)
    cycle = None if period is None else contact_cycle(
        sequence, period, tolerance=tolerance, start=start
    )  # fmt: skip
    asked = reference.touchdowns((start, end)) if cyclic else _scheduled(reference, stances, start)
    downs = touchdowns(path.t, path.theta, path.contact, asked=asked, least=LEAST_CONTACT)
    return WalkContacts(by, sequence, cycle, period, tolerance, downs)


def _scheduled(
    reference: LegReference, stances: Intervals | None, start: float
) -> list[tuple[Array, Array]] | None:
    """Return times [s] and angles [rad] of each leg's touchdowns in a program; None without one.

    A stance at the program's start begins with no touchdown. See `contacts_of` for the arguments.
    """
    if stances is None:
        return None
    down = [rows[rows[:, 0] > 0, 0] for rows in stances]
    return [(t + start, reference.angles(t)[:, leg]) for leg, t in enumerate(down)]


def _turn_time(t: Array, theta: Array) -> float | None:
    """Return the duration of a turn of the legs [s], the median; None unless all are about equal.

    All turns of all legs must differ by at most `_STEADY` of it, and each leg must turn at least
    once from 0.1 rad beyond its first angle on.

    Args:
        t: Times, shape (n,) [s].
        theta: Leg angles, unwrapped, shape (n, 6) [rad].
    """
    times = []
    for angle in (theta * np.sign(theta[-1] - theta[0])).T:
        turned = np.maximum.accumulate(angle)
        # From a little beyond the first angle, at which a leg may rest before it turns.
        levels = np.arange(turned[0] + 0.1, turned[-1], 2 * np.pi)
        times.append(np.diff(t[np.searchsorted(turned, levels)]))
    every = np.concatenate(times)
    if min(map(len, times)) < 1 or np.ptp(every) > _STEADY * np.median(every):
        return None
    return float(np.median(every))


def write_contacts(file: Path, contacts: WalkContacts) -> None:
    """Write the contact states of a walk as CSV, one row a state, SI.

    The column `cycle` counts cycles of the gait from 1, the first that repeats; it is empty before
    that, and in a walk without a cycle.

    Args:
        file: File to write; an existing one is overwritten.
        contacts: Contacts of the walk.
    """
    cycle = contacts.cycle
    rows = [
        {
            "by": contacts.by,
            "contact": named_legs(state.legs),
            "start": state.start,
            "end": state.end,
            "duration": state.duration,
            "cycle": None
            if cycle is None or state.start < cycle.settled
            else str(1 + int((state.start - cycle.settled) / cycle.period + 1e-6)),
            "joined": state.joined,
        }
        for state in contacts.sequence.states
    ]
    _write(file, rows)


def write_touchdowns(file: Path, downs: Sequence[Touchdown]) -> None:
    """Write the touchdowns of a walk as CSV, one row a leg and turn, SI; NaN is an empty cell.

    Args:
        file: File to write; an existing one is overwritten.
        downs: The touchdowns, at least one.
    """
    names = ("leg", "turn", "t", "angle", "asked_t", "asked_angle", "late", "liftoff_t",
             "liftoff_angle", "contacts")  # fmt: skip
    rows = [{name: getattr(each, name) for name in names} | {"leg": each.leg + 1} for each in downs]
    _write(file, rows, list(names))


def _write(file: Path, rows: list[dict[str, Any]], names: list[str] | None = None) -> None:
    """Write rows as CSV, with the columns `names`, else the keys of the rows."""
    table = pd.DataFrame(rows, columns=names)
    table.to_csv(file, index=False, float_format="%.10g", lineterminator="\n")
