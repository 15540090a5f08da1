# SPDX-License-Identifier: MIT
"""Leg angles of a walking program whose segments end at a heading or a place, found by walking."""

from collections.abc import Callable, Sequence
from dataclasses import dataclass

import numpy as np

from model.errors import DomainError
from model.gait.program import CycleGait, ProgramLegs
from model.robot import Robot
from model.routes.growing_walk import GrowingWalk, Reached
from model.walk.bend import STRAIGHT, Bend
from model.walk.dynamics import DynamicsOptions
from model.walk.ground import FLAT, Ground
from model.walk.traction import TractionTable

MOST_CYCLES = 1000  # of one segment
CLOSE = np.radians(0.05)  # tolerance on the heading at which a segment ends [rad]
TRIALS = 20  # most walks of one cycle to find when its legs stop
TRIES = 3  # most cycles of a segment whose legs are stopped to end at a heading

_Added = Callable[[ProgramLegs, float], None]
"""Called with the program and the share of a segment that is laid out, after every cycle."""


@dataclass(frozen=True)
class Until:
    """When a segment ends; exactly one is given.

    Attributes:
        strides: After this number of cycles.
        time: After the first cycle that ends at or after this time in the segment [s].
        heading: After the heading has changed by this, to either side, since the segment began: in
            the cycle in which it does, the legs are stopped when it has [rad].
        near: x, y and radius: after the first cycle at whose end the body's centre is in this
            circle [m].

    Raises:
        DomainError: None or several are given, or a value is not positive.
    """

    strides: int | None = None
    time: float | None = None
    heading: float | None = None
    near: tuple[float, float, float] | None = None

    def __post_init__(self) -> None:
        """Check that exactly one end is given, and that it is more than zero."""
        given = {name: value for name, value in vars(self).items() if value is not None}
        if len(given) != 1:
            raise DomainError(
                f"found {', '.join(given) or 'nothing'}; expected one of strides, time, heading "
                "and near, which says when the segment ends"
            )
        ((name, value),) = given.items()
        least = value[2] if isinstance(value, tuple) else value
        if not (least > 0 and np.isfinite(np.asarray(value, dtype=float)).all()):
            raise DomainError(f"{name} is {value}; expected more than zero")

    @property
    def needs_walking(self) -> bool:
        """Whether only a walk shows when the segment ends."""
        return self.heading is not None or self.near is not None


@dataclass(frozen=True)
class Segment:
    """A part of a program: cycles of one gait, or standing.

    Attributes:
        gait: Gait of the cycles; None to stand.
        until: When the segment ends; None to stand.
        stand: How long all legs are held [s]; 0 in a segment with a gait.
    """

    gait: CycleGait | None = None
    until: Until | None = None
    stand: float = 0.0


@dataclass(frozen=True)
class SegmentEnd:
    """Where and when a segment ended, as it was walked while the program was laid out.

    Attributes:
        cycles: Number of cycles; 0 of a stand.
        end: Time of its end [s].
        missed: How much further than asked for the heading changed, negative if less; 0 of a
            segment that ends otherwise [rad].
    """

    cycles: int
    end: float
    missed: float = 0.0


def lay_out(
    segments: Sequence[Segment],
    robot: Robot,
    table: TractionTable | None,
    *,
    options: DynamicsOptions,
    ground: Ground = FLAT,
    bend: Bend = STRAIGHT,
    longest: float = np.inf,
    progress: Callable[[float], None] | None = None,
) -> tuple[ProgramLegs, tuple[SegmentEnd, ...]]:
    """Compute the cycles of a program; walk it where a segment ends at a heading or a place.

    Args:
        segments: The parts of the program, in order; one of them has a gait.
        robot: The robot.
        table: The slip law, as fitted walks correct it; None if no segment needs walking.
        options: Step length and contacts of the walk.
        ground: The ground.
        bend: How fitted walks say that the path is stretched and bent.
        longest: Longest duration of the program [s].
        progress: Called after every cycle with the share of the program that is laid out; it may
            raise an exception to stop.

    Returns:
        The leg angles of the program, and the end of each segment in their order.

    Raises:
        DomainError: No segment has a gait, a segment does not end within 1000 cycles, or needs
            walking without a slip law, or the program is too long.
        WalkError: The walk diverged.
    """
    first = next((each.gait for each in segments if each.gait is not None), None)
    if first is None:
        raise DomainError("no segment of the program has a gait; expected at least one")
    walk = None if table is None else GrowingWalk(
        robot, table, options, ground=ground, bend=bend
    )  # fmt: skip
    legs, done = ProgramLegs.beginning_with(first), list[SegmentEnd]()

    def added(longer: ProgramLegs, share: float) -> None:
        """Report progress; raise `DomainError` if the program is longer than `longest`."""
        if longer.end > longest:
            raise DomainError(
                f"the program would last {longer.end:.4g} s or more; at most {longest:g} s are "
                "walked: write fewer segments, strides or shorter stands, or lengthen the time step"
            )
        if progress is not None:
            progress((len(done) + min(share, 1.0)) / len(segments))

    for number, segment in enumerate(segments, start=1):
        try:
            legs, end = _laid_out(legs, segment, walk, added)
        except DomainError as error:
            raise DomainError(f"segment {number}: {error}") from error
        done.append(end)
    return legs, tuple(done)


def _laid_out(
    legs: ProgramLegs, segment: Segment, walk: GrowingWalk | None, added: _Added
) -> tuple[ProgramLegs, SegmentEnd]:
    """Return the program with one more segment, by the way in which it ends, and its end.

    Raises `DomainError` if `MOST_CYCLES` do not reach that, or it needs walking and `walk` is None.
    """
    gait, until = segment.gait, segment.until
    if gait is None or until is None:
        legs, cycles, missed = legs.with_stand(segment.stand), 0, 0.0
        added(legs, 1.0)
    elif until.strides is not None:
        legs, cycles, missed = _repeated(legs, gait, until.strides, added), until.strides, 0.0
    elif until.time is not None:
        (legs, cycles), missed = _lasting(legs, gait, until.time, added), 0.0
    elif walk is None:
        raise DomainError("ends at a heading or a place, which only a model with slip walks to")
    elif until.heading is not None:
        legs, cycles, missed = _turned(legs, gait, until.heading, walk, added)
    else:
        (legs, cycles), missed = _walked_near(legs, segment, walk, added), 0.0
    return legs, SegmentEnd(cycles, legs.end, missed)


def _repeated(legs: ProgramLegs, gait: CycleGait, cycles: int, added: _Added) -> ProgramLegs:
    """Return the program with a number of cycles of a gait."""
    for cycle in range(1, cycles + 1):
        legs = legs.with_cycle(gait)
        added(legs, cycle / cycles)
    return legs


def _lasting(
    legs: ProgramLegs, gait: CycleGait, time: float, added: _Added
) -> tuple[ProgramLegs, int]:
    """Return the program with cycles that last a time or longer [s], and their number.

    Raises `DomainError` if `MOST_CYCLES` do not last as long.
    """
    began = legs.end
    for cycle in range(1, MOST_CYCLES + 1):
        legs = legs.with_cycle(gait)
        past = legs.end - began
        added(legs, past / time)
        if past >= time - 1e-9:
            return legs, cycle
    raise DomainError(
        f"after {MOST_CYCLES} cycles {legs.end - began:.4g} s of {time:.4g} s are over; write it "
        "as several segments"
    )


def _walked_near(
    legs: ProgramLegs, segment: Segment, walk: GrowingWalk, added: _Added
) -> tuple[ProgramLegs, int]:
    """Return the program with cycles until the robot is in a circle, and their number.

    Raises `DomainError` after `MOST_CYCLES`, or for a segment that does not end near a place.
    """
    if segment.gait is None or segment.until is None or segment.until.near is None:
        raise DomainError("expected a segment that ends near a place")
    goal_x, goal_y, radius = segment.until.near
    x, y, _ = walk.pose(legs)
    far = np.hypot(x - goal_x, y - goal_y)
    for cycle in range(1, MOST_CYCLES + 1):
        legs = legs.with_cycle(segment.gait)
        x, y, _ = walk.pose(legs)
        left = np.hypot(x - goal_x, y - goal_y)
        added(legs, max(0.0, 1 - float(left / far)) if far > 0 else 1.0)
        if left <= radius:
            return legs, cycle
    raise DomainError(
        f"after {MOST_CYCLES} cycles the robot has not come to {segment.until.near}; it is at "
        f"x {x:.3g}, y {y:.3g} m"
    )


def _turned(
    legs: ProgramLegs, gait: CycleGait, heading: float, walk: GrowingWalk, added: _Added
) -> tuple[ProgramLegs, int, float]:
    """Add cycles until the robot has turned by a heading to either side, and stop its legs there.

    In the last cycle the legs are stopped at the time at which the heading is reached. Where the
    heading jumps over the one asked for as a leg lifts off, they are stopped before that, and a
    further cycle does the rest; after `TRIES` such cycles the nearest is taken.

    Returns:
        The program, the number of cycles added, and how much further than asked for the robot
        turned, negative if less [rad].

    Raises:
        DomainError: After `MOST_CYCLES` the robot has not turned as far.
    """
    start, turned, tries = walk.pose(legs)[2], 0.0, 0
    for cycles in range(1, MOST_CYCLES + 1):
        before, short, reached = legs, turned, walk.reached
        legs = legs.with_cycle(gait)
        turned = abs(walk.pose(legs)[2] - start)
        added(legs, turned / heading)
        if turned < heading:
            continue
        whole = legs

        def missed(
            time: float, whole: ProgramLegs = whole, reached: Reached | None = reached
        ) -> float:
            """Return by how much the robot turns too far if its legs are stopped at a time."""
            walk.reached = reached
            return abs(walk.pose(whole.stopped_at(time))[2] - start) - heading

        time, value, early = _root(
            missed, (before.end, short - heading), (whole.end, turned - heading)
        )
        tries += 1
        if abs(value) <= CLOSE or tries == TRIES:
            missed(time)  # leaves `walk` at the end of the program that is returned
            return whole.stopped_at(time), cycles, value
        turned = missed(early) + heading
        legs = whole.stopped_at(early)
    raise DomainError(
        f"after {MOST_CYCLES} cycles the robot has not turned by {np.degrees(heading):g} "
        f"degrees; it has by {np.degrees(turned):.3g}"
    )


def _root(
    function: Callable[[float], float], low: tuple[float, float], high: tuple[float, float]
) -> tuple[float, float, float]:
    """Find the root of a function to `CLOSE` by the Illinois method.

    Args:
        function: The function.
        low: Argument and value of the function, negative.
        high: A larger argument and its value, not negative.

    Returns:
        Argument and value nearest to the root, which is not near if the function jumps over zero,
        and an argument with a negative value just below.
    """
    (a, below), (b, above) = low, high
    best, last = min(low, high, key=lambda end: abs(end[1])), 0
    for _ in range(TRIALS):
        if abs(best[1]) <= CLOSE:
            break
        root = b - above * (b - a) / (above - below)
        value = function(root)
        best = min(best, (root, value), key=lambda end: abs(end[1]))
        side = 1 if value > 0 else -1
        if side > 0:
            b, above, below = root, value, below * (0.5 if side == last else 1.0)
        else:
            a, below, above = root, value, above * (0.5 if side == last else 1.0)
        last = side
    return best[0], best[1], a
