# SPDX-License-Identifier: MIT
"""Leg angles of a walking program whose segments end at a heading or a place, found by walking."""

from collections.abc import Callable, Sequence
from dataclasses import dataclass

import numpy as np

from model.errors import DomainError
from model.gait.program import CycleGait, ProgramLegs
from model.gait.reference import SampledReference
from model.robot import Robot
from model.walk.areas import AreaTractions
from model.walk.arrays import State
from model.walk.dynamics import DynamicsOptions, integrate, start_state
from model.walk.ground import FLAT, Ground
from model.walk.quaternion import roll_pitch_yaw
from model.walk.traction import TractionTable

MOST_CYCLES = 1000  # of one segment
SHORTEST_STEP = 0.02  # of a gait's stance angles, of the last cycle that ends at a heading
HALVINGS = 10  # of the share of a step: to a thousandth of what a cycle turns

_Kept = tuple[int, State, float] | None


@dataclass(frozen=True)
class Until:
    """When a segment ends; exactly one is given.

    Attributes:
        strides: After this number of cycles.
        time: After the first cycle that ends at or after this time in the segment [s].
        heading: After the heading has changed by this, to either side, since the segment began; the
            steps of the last cycle are shortened to come as near to it as they can [rad].
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
    table: TractionTable | AreaTractions | None,
    *,
    options: DynamicsOptions,
    ground: Ground = FLAT,
    progress: Callable[[float], None] | None = None,
) -> tuple[ProgramLegs, tuple[SegmentEnd, ...]]:
    """Compute the cycles of a program; walk it where a segment ends at a heading or a place.

    Args:
        segments: The parts of the program, in order; one of them has a gait.
        robot: The robot.
        table: The slip law; None if no segment needs walking.
        options: Step length and contacts of the walk.
        ground: The ground.
        progress: Called with the share of segments that are laid out.

    Raises:
        DomainError: No segment has a gait, a segment does not end within 1000 cycles, or needs
            walking without a slip law.
        WalkError: The walk diverged.
    """
    first = next((each.gait for each in segments if each.gait is not None), None)
    if first is None:
        raise DomainError("no segment of the program has a gait; expected at least one")
    legs = ProgramLegs.beginning_with(first)
    walker = None if table is None else _Walker(robot, table, options, ground)
    done: list[SegmentEnd] = []
    for number, segment in enumerate(segments, start=1):
        if segment.gait is None or segment.until is None:
            legs, cycles, missed = legs.with_stand(segment.stand), 0, 0.0
        else:
            try:
                legs, cycles, missed = _walked(legs, segment.gait, segment.until, walker)
            except DomainError as error:
                raise DomainError(f"segment {number}: {error}") from error
        done.append(SegmentEnd(cycles, legs.end, missed))
        if progress is not None:
            progress(number / len(segments))
    return legs, tuple(done)


def _walked(
    legs: ProgramLegs, gait: CycleGait, until: Until, walker: "_Walker | None"
) -> tuple[ProgramLegs, int, float]:
    """Return the program with a segment's cycles, their number, and by how much it misses."""
    if until.strides is not None:
        for _ in range(until.strides):
            legs = legs.with_cycle(gait)
        return legs, until.strides, 0.0
    if until.time is not None:
        began, cycles = legs.end, 0
        while cycles == 0 or legs.end < began + until.time - 1e-9:
            if cycles == MOST_CYCLES:
                raise DomainError(
                    f"after {MOST_CYCLES} cycles {legs.end - began:.4g} s of {until.time:.4g} s "
                    "are over; write it as several segments"
                )
            legs, cycles = legs.with_cycle(gait), cycles + 1
        return legs, cycles, 0.0
    if walker is None:
        raise DomainError("ends at a heading or a place, which only a model with slip walks to")
    return _walked_to(legs, gait, until, walker)


def _walked_to(
    legs: ProgramLegs, gait: CycleGait, until: Until, walker: "_Walker"
) -> tuple[ProgramLegs, int, float]:
    """Add cycles until the robot is at a place, or has turned by a heading."""
    x, y, start = walker.pose(legs)
    turned = 0.0
    for cycles in range(1, MOST_CYCLES + 1):
        before, legs, kept = legs, legs.with_cycle(gait), walker.kept
        x, y, yaw = walker.pose(legs)
        turned = abs(yaw - start)
        if until.near is not None:
            if np.hypot(x - until.near[0], y - until.near[1]) <= until.near[2]:
                return legs, cycles, 0.0
        elif until.heading is not None and turned >= until.heading:
            legs, missed = _last_step(before, gait, until.heading, walker, kept, start)
            return legs, cycles, missed
    wanted = (
        f"turned by {np.degrees(until.heading):g} degrees; it has by {np.degrees(turned):.3g}"
        if until.heading is not None
        else f"come to {until.near}; it is at x {x:.3g}, y {y:.3g} m"
    )
    raise DomainError(f"after {MOST_CYCLES} cycles the robot has not {wanted}")


def _last_step(
    legs: ProgramLegs, gait: CycleGait, heading: float, walker: "_Walker", kept: "_Kept",
    start: float,
) -> tuple[ProgramLegs, float]:  # fmt: skip
    """Add a cycle of shorter steps, so that the robot ends nearest to a heading since `start`.

    Return the miss, too: legs that stand already at their full touchdown angle turn the robot
    however short the next steps are.
    """

    def walked(share: float) -> tuple[float, ProgramLegs]:
        """Return by how much steps of a share of the stance miss the heading, and the program."""
        walker.kept = kept
        longer = legs.with_cycle(gait.shortened(share))
        return abs(walker.pose(longer)[2] - start) - heading, longer

    low, high = SHORTEST_STEP, 1.0
    for _ in range(HALVINGS):
        middle = 0.5 * (low + high)
        low, high = (middle, high) if walked(middle)[0] < 0 else (low, middle)
    best = min((low, high), key=lambda share: abs(walked(share)[0]))
    missed, legs = walked(best)
    return legs, missed


class _Walker:
    """Walks a growing program and keeps the state at its end.

    Attributes:
        kept: Step, state and unwrapped yaw [rad] at the end; None before the first walk. To take
            back a program's last cycle, restore what was kept before that cycle was walked.
    """

    def __init__(
        self,
        robot: Robot,
        table: TractionTable | AreaTractions,
        options: DynamicsOptions,
        ground: Ground,
    ) -> None:
        self._robot, self._table, self._options, self._ground = robot, table, options, ground
        self.kept: _Kept = None  # step, state and unwrapped yaw there

    def pose(self, legs: ProgramLegs) -> tuple[float, float, float]:
        """Return x, y [m] and unwrapped yaw [rad] at a program's end, to the nearest step.

        What was walked up to then is walked only once.
        """
        begun = legs if legs.end > 0 else legs.with_cycle(legs.cycles[0].gait)
        reference, dt = begun.reference(), self._options.dt
        if self.kept is None:
            theta = reference.angles(0.0)[0] + self._robot.leg_offset
            state = start_state(self._robot, theta, self._options, ground=self._ground)
            self.kept = (0, state, float(roll_pitch_yaw(state.q[None])[0, 2]))
        at, kept, yaw = self.kept
        state = State(*(each.copy() for each in kept))
        end = round(legs.end / dt)
        yaw = self._advance(reference, state, at, end, yaw)
        self.kept = (max(at, end), state, yaw)
        return float(state.p[0]), float(state.p[1]), yaw

    def _advance(
        self, reference: SampledReference, state: State, at: int, end: int, yaw: float
    ) -> float:
        """Integrate the state from step `at` to `end`; return the unwrapped yaw there."""
        if end <= at:
            return yaw
        dt = self._options.dt
        theta = reference.angles(dt * np.arange(at, end + 1)) + self._robot.leg_offset
        pose, _ = integrate(
            self._robot, self._table, state, theta, self._options, ground=self._ground,
            began=at * dt,
        )  # fmt: skip
        headings = np.unwrap(np.concatenate([[yaw], roll_pitch_yaw(pose[1:, 3:])[:, 2]]))
        return float(headings[-1])
