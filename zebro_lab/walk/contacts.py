# SPDX-License-Identifier: MIT
"""Contact states of a walk: by detection on rigid legs, and by the model that was walked."""

from dataclasses import dataclass, replace
from types import MappingProxyType
from typing import Final

import numpy as np
from numpy.typing import NDArray

from model.arrays import Array
from model.contact.detection import DETECTIONS, detect_contacts
from model.contact.sequence import (
    ContactCycle,
    ContactSequence,
    agreement,
    contact_cycle,
    contact_states,
)
from model.contact.touchdown import Touchdown, touchdowns
from model.errors import DomainError
from model.gait import CyclicReference
from model.gait.reference import LegReference
from model.gait.stance import Intervals
from model.robot import Robot
from model.walk.footing import GroundFooting
from model.walk.ground import FLAT, Ground, is_level
from model.walk.path import WalkPath
from zebro_lab.walk.output_request import ContactRequest

DETECTED_BY: Final = DETECTIONS[0]
"""The detection that is shown beside the model's own contacts: that of Eq. (3-33)."""
RULES: Final = MappingProxyType({
    "events": "detection on rigid legs (3-5-2), balance tested at touchdowns",
    "balanced": "detection on rigid legs (3-5-2), balance tested at every step",
    "force": "force on the legs in the walked model",
    "listing": "automaton of the thesis's listing (A.32)",
    "table": "automaton of the thesis's Table 3-1",
    "rest": "legs on which the robot rests",
})  # fmt: skip
"""What decides contact, in words, by its name in `contacts.csv`."""
_REPEATS: Final = 0.01  # of a cycle: how far repetitions of a state may be from a whole cycle apart
_STEADY: Final = 0.02  # of a cycle: how much the turns of a log's legs may differ in duration


@dataclass(frozen=True)
class ContactTrace:
    """Contacts by one rule.

    Attributes:
        by: Name of the rule, a key of `RULES`.
        t: Times, shape (n,) [s].
        contact: Which legs are on the ground, shape (n, 6).
        sequence: The contact states in order.
        cycle: The cycle in which they repeat; None if they do not, or the gait has no cycle.
        ended: Why a detection ended before the walk; empty if it did not.
        on_ground: Whether legs are detected on the ground of the walk, which is not flat and level.
    """

    by: str
    t: Array
    contact: NDArray[np.bool_]
    sequence: ContactSequence
    cycle: ContactCycle | None
    ended: str = ""
    on_ground: bool = False

    @property
    def rule(self) -> str:
        """What decides contact, in words."""
        return RULES[self.by] + (", on the walk's ground" if self.on_ground else "")


@dataclass(frozen=True)
class WalkContacts:
    """Contacts of a walk.

    Attributes:
        traces: Contacts by detection and by the walked model, or by the model alone where that is
            the detection or no contact state fits.
        period: Duration of the gait's cycle; None for a program, or a log without one [s].
        tolerance: How far a repetition of a state may be from a whole cycle later [s].
        same: Share of the time in which both traces have the same legs down; None of one trace.
        same_legs: Share in which both agree on each leg, shape (6,); None of one trace.
        touchdowns: Touchdowns of each leg by the walked model.
        notes: Notes, one line each.
    """

    traces: tuple[ContactTrace, ...]
    period: float | None
    tolerance: float
    same: float | None
    same_legs: Array | None
    touchdowns: tuple[Touchdown, ...]
    notes: tuple[str, ...] = ()

    @property
    def own(self) -> ContactTrace:
        """Contacts by the walked model."""
        return self.traces[-1]


def contacts_of(
    path: WalkPath,
    reference: LegReference,
    robot: Robot,
    *,
    by: str,
    request: ContactRequest,
    ground: Ground = FLAT,
    stances: Intervals | None = None,
) -> WalkContacts:
    """Find contact states, their cycle and the touchdowns of a walk.

    Args:
        path: The walk, from whose leg angles contacts are detected.
        reference: Leg angles that it was computed from.
        robot: The robot.
        by: What decides contact in the model, a key of `RULES`.
        request: Shortest time that a state lasts.
        ground: The ground, on which legs are detected along the path.
        stances: When each leg stands by a program's schedule, from the walk's start on [s]; None
            for others.
    """
    start, end = float(path.t[0]), float(path.t[-1])
    cyclic = isinstance(reference, CyclicReference)
    period = reference.period if cyclic else _turn_time(path.t, path.theta)
    tolerance = max(_REPEATS * (period or 0.0), 2 * float(path.t[1] - start))
    timing = _Timing(path.t, period, tolerance, request.least)
    own = timing.trace(by, path.contact)
    detected, notes = (None, ()) if by == DETECTED_BY else _detected(path, robot, timing, ground)
    asked = reference.touchdowns((start, end)) if cyclic else _scheduled(reference, stances, start)
    downs = touchdowns(path.t, path.theta, path.contact, asked=asked, least=request.least)
    if detected is None:
        return WalkContacts((own,), period, tolerance, None, None, downs, notes)
    same, legs = agreement(detected.contact, own.contact[: len(detected.t)])
    return WalkContacts((detected, own), period, tolerance, same, legs, downs, notes)


@dataclass(frozen=True)
class _Timing:
    """What contact states and their cycle are found with: times, period, tolerances [s]."""

    t: Array
    period: float | None
    tolerance: float
    least: float

    def trace(self, by: str, contact: NDArray[np.bool_], ended: str = "") -> ContactTrace:
        """Return the trace of contacts, from the first sample on."""
        t = self.t[: len(contact)]
        sequence = contact_states(t, contact, least=self.least)
        cycle = None if self.period is None else contact_cycle(
            sequence, self.period, tolerance=self.tolerance, start=float(t[0])
        )  # fmt: skip
        return ContactTrace(by, t, contact, sequence, cycle, ended)


def _scheduled(
    reference: LegReference, stances: Intervals | None, start: float
) -> list[tuple[Array, Array]] | None:
    """Return the touchdowns of a program's schedule, but those at its start; None without one."""
    if stances is None:
        return None
    down = [rows[rows[:, 0] > 0, 0] for rows in stances]
    return [(t + start, reference.angles(t)[:, leg]) for leg, t in enumerate(down)]


def _detected(
    path: WalkPath, robot: Robot, timing: _Timing, ground: Ground
) -> tuple[ContactTrace | None, tuple[str, ...]]:
    """Detect contacts on rigid legs; also return a note if they end, None if there are none."""
    footing = None if is_level(ground) else GroundFooting(
        robot, path.theta, np.column_stack([path.position, path.orientation]), ground
    )  # fmt: skip
    try:
        found = detect_contacts(robot, path.theta, detection=DETECTED_BY, footing=footing)
    except DomainError as error:
        return None, (f"no contacts are detected on rigid legs: {error}",)
    trace = timing.trace(DETECTED_BY, found.contact, found.ended) if len(found) else None
    if trace is not None and footing is not None:
        trace = replace(trace, on_ground=True)
    if not found.ended:
        return trace, ()
    at = path.t[len(found)]
    return trace, (f"contact detection on rigid legs ends at {at:.3f} s: {found.ended}",)


def _turn_time(t: Array, theta: Array) -> float | None:
    """Return how long the legs take for a turn [s]; None unless all turns take equally long."""
    times = []
    for angle in (theta * np.sign(theta[-1] - theta[0])).T:
        turned = np.maximum.accumulate(angle)
        levels = np.arange(turned[0] + 0.1, turned[-1], 2 * np.pi)
        times.append(np.diff(t[np.searchsorted(turned, levels)]))
    every = np.concatenate(times)
    if min(map(len, times)) < 1 or np.ptp(every) > _STEADY * np.median(every):
        return None
    return float(np.median(every))
