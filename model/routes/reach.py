# SPDX-License-Identifier: MIT
"""Two ways to a place: stop, turn on the spot and walk straight, or walk a curve (thesis, 1-3)."""

from collections.abc import Sequence
from dataclasses import dataclass, replace

import numpy as np

from model.errors import DomainError
from model.routes.arcs import (
    Arc,
    arc_and_straight_to,
    arc_straight_arc_to,
    arc_to,
    two_arcs_to,
)
from model.routes.goal import Goal
from model.routes.manoeuvre import (
    SOLVED,
    Fitted,
    Part,
    Stepping,
    Surroundings,
    fitted,
    walked_end,
)

MOST_DETOUR = 2.0  # length of one or two arcs over the distance; beyond it a straight is put in
FITS = 6  # most further fits with other numbers of strides
NOTHING = 0.004  # strides; a part of fewer is left out
_MEASURED = 3  # strides walked to measure a stride's length and turn


@dataclass(frozen=True)
class Stride:
    """How far one stride of the whole stance leads.

    Attributes:
        length: Straight ahead [m].
        arm: Length over the turn of a stride on the spot: the radius of the curve in which the
            inner legs step on the spot [m].
    """

    length: float
    arm: float

    def part(self, arc: Arc) -> Part | None:
        """Return the strides that lead along an arc or straight; None for fewer than `NOTHING`.

        An arc without length is a turn on the spot. The outer legs walk the arc's length and
        `arm` for each radian of turn; a whole number of strides shares this equally.
        """
        radius = np.inf if arc.turn == 0 else arc.length / abs(arc.turn)
        bend = self.arm / (radius + self.arm)
        strides = (arc.length + self.arm * abs(arc.turn)) / self.length
        if strides < NOTHING:
            return None
        whole = max(1, int(np.ceil(strides - 0.02)))  # up to 2 % of a stride short: no further one
        return Part(float(np.copysign(bend, arc.turn)), min(1.0, strides / whole), whole)


def measured_stride(stepping: Stepping, around: Surroundings) -> Stride:
    """Measure how far strides lead, straight ahead and on the spot, by walking some of each.

    Raises:
        DomainError: The gait is impossible or leads nowhere, or there is no slip law.
        WalkError: The walk diverged.
    """
    straight = walked_end([Part(0.0, 1.0, _MEASURED)], stepping, around)
    spot = walked_end([Part(1.0, 1.0, _MEASURED)], stepping, around)
    length, turn = float(straight[0]) / _MEASURED, float(spot[2]) / _MEASURED
    if not (length > 0 and turn > 0):
        raise DomainError(
            f"a stride leads {1000 * length:.3g} mm ahead and, on the spot, turns by "
            f"{np.degrees(turn):.3g} degrees to the left; expected more than 0: check the gait"
        )
    return Stride(length, length / turn)


def stop_turn_walk(
    goal: Goal, stride: Stride, stepping: Stepping, around: Surroundings
) -> Fitted | None:
    """Plan to turn on the spot towards a goal, to walk straight there, and to turn to its heading.

    All legs are down where one part follows another. Parts of next to no length are left out.

    Args:
        goal: Where to end.
        stride: How far a stride leads.
        stepping: Gait, times and angles.
        around: What it is walked with.

    Returns:
        The manoeuvre; None if the robot is at the goal already.

    Raises:
        DomainError: A gait is impossible, or there is no slip law.
        WalkError: The walk diverged.
    """
    bearing = float(np.arctan2(goal.y, goal.x)) if goal.x or goal.y else 0.0
    arcs = [Arc(0.0, bearing), Arc(float(np.hypot(goal.x, goal.y)), 0.0)]
    if goal.heading is not None:
        left = (goal.heading - bearing + np.pi) % (2 * np.pi) - np.pi
        arcs.append(Arc(0.0, float(left)))
    return _planned(arcs, goal, stride, stepping, around, bends=False)


def curve(goal: Goal, stride: Stride, stepping: Stepping, around: Surroundings) -> Fitted | None:
    """Plan to walk to a goal in a curve: one arc, or two where a heading is asked for.

    Where arcs would be more than `MOST_DETOUR` times as long as the straight way, as to a goal
    behind, or tighter than `stride.arm`, an arc about the inner legs and a straight are walked
    instead, and a second such arc where a heading is asked for. A place within the first circle,
    which these cannot reach, is walked to in one tighter arc.

    Args:
        goal: Where to end.
        stride: How far a stride leads.
        stepping: Gait, times and angles.
        around: What it is walked with.

    Returns:
        The manoeuvre; None if the robot is at the goal already.

    Raises:
        DomainError: A gait is impossible, or there is no slip law.
        WalkError: The walk diverged.
    """
    arcs, bends = _arcs(goal, stride.arm)
    return _planned(arcs, goal, stride, stepping, around, bends=bends)


def _arcs(goal: Goal, radius: float) -> tuple[Sequence[Arc], bool]:
    """Return arcs and straights of a curve to a goal, and whether their radii may be fitted.

    One or two arcs are returned, with radii to be fitted, if none is tighter than `radius` [m] and
    they are at most `MOST_DETOUR` times as long as the straight way. Else arcs of that radius with
    a straight are returned, but a single tighter arc to a place that these cannot reach.
    """
    far = float(np.hypot(goal.x, goal.y))

    def is_good(arcs: Sequence[Arc]) -> bool:
        """Return whether arcs are not much longer than the straight way, nor too tight."""
        wide = all(arc.length >= radius * abs(arc.turn) for arc in arcs)
        return wide and sum(arc.length for arc in arcs) <= MOST_DETOUR * far

    if goal.heading is not None:
        two = two_arcs_to(goal.x, goal.y, goal.heading) if far > 0 else None
        if two is not None and is_good(two):
            return two, True
        return arc_straight_arc_to(goal.x, goal.y, goal.heading, radius), False
    one = arc_to(goal.x, goal.y)
    if one is not None and is_good([one]):
        return [one], True
    joined = arc_and_straight_to(goal.x, goal.y, radius)
    if joined is not None:
        return joined, False
    return ([] if one is None else [one]), True  # within the circle, so not straight behind


def _planned(
    arcs: Sequence[Arc], goal: Goal, stride: Stride, stepping: Stepping, around: Surroundings,
    *, bends: bool,
) -> Fitted | None:  # fmt: skip
    """Fit a manoeuvre of arcs and straights to a goal, with as few strides as lead there.

    The shares of all parts are fitted, and their bends if `bends`. Strides are added while the goal
    is missed by more than `SOLVED`, else taken away, at most `FITS` times and while the fit is no
    worse. None if there is nothing to walk.
    """
    parts = tuple(part for part in map(stride.part, arcs) if part is not None)
    if not parts:
        return None
    free = [(i, "share") for i in range(len(parts))]
    if bends:
        free += [(i, "bend") for i in range(len(parts))]
    best = fitted(parts, free, goal, stepping, around)
    for _ in range(FITS):
        changed = _more_strides(best) if best.missed > SOLVED else _fewer_strides(best)
        if changed is None:
            break
        found = fitted(changed, free, goal, stepping, around)
        if best.missed <= SOLVED < found.missed or found.missed > max(best.missed, SOLVED):
            break
        best = found
    return best


def _more_strides(found: Fitted) -> tuple[Part, ...] | None:
    """Add a stride to each part that uses the whole stance (share 1); None if no part does."""
    at_most = [part.share > 1 - 1e-9 for part in found.parts]
    if not any(at_most):
        return None
    return tuple(
        _of_strides(part, part.strides + 1) if more else part
        for part, more in zip(found.parts, at_most, strict=True)
    )


def _fewer_strides(found: Fitted) -> tuple[Part, ...] | None:
    """Take a stride off each part that 99 % of the whole stance then suffices for; None if none."""
    fewer = [part.share * part.strides <= 0.99 * (part.strides - 1) for part in found.parts]
    if not any(fewer):
        return None
    return tuple(
        _of_strides(part, part.strides - 1) if less else part
        for part, less in zip(found.parts, fewer, strict=True)
    )


def _of_strides(part: Part, strides: int) -> Part:
    """Return a part with another number of strides and the share, up to 1, to lead as far."""
    return replace(part, strides=strides, share=min(1.0, part.share * part.strides / strides))
