# SPDX-License-Identifier: MIT
"""Manoeuvres of whole strides, and how they are fitted to end at a place by walking them."""

from collections.abc import Sequence
from dataclasses import dataclass, replace

import numpy as np

from model.arrays import Array
from model.errors import DomainError
from model.gait.direction import Direction
from model.gait.notation import TRIPOD, Gait
from model.gait.program import CycleGait, ProgramLegs, cycle_gait
from model.gait.steering import ideal_liftoff, scaled_stance
from model.robot import Robot
from model.routes.goal import Goal
from model.routes.growing_walk import GrowingWalk
from model.walk.bend import STRAIGHT, Bend
from model.walk.dynamics import DynamicsOptions
from model.walk.ground import FLAT, Ground
from model.walk.traction import TractionTable

LEAST_SHARE = 0.003  # of a stance: below, a stride does nothing
SOLVED = 2e-4  # m; as near as a manoeuvre is fitted, as `Goal.missed` counts
ROUNDS = 8  # most rounds of a fit
_STEP = 0.01  # step in shares and bends for finite differences
_SHORTER = 0.4  # factor on a step that leads further away, to try it once more


@dataclass(frozen=True)
class Stepping:
    """Gait, times and angles that all parts of a manoeuvre have in common.

    Attributes:
        gait: Groups of legs.
        ground_time: tau_g [s].
        flight_time: tau_f [s].
        double_stance: tau_Delta [s].
        touchdown: Touchdown angle of a whole stance [rad].
        liftoff: Lift-off angle of a whole stance; when None, that at which the hip is as high as at
            touchdown [rad].
        leg_arc: Angle of the legs' arc [rad].
    """

    gait: Gait = TRIPOD
    ground_time: float = 1.0
    flight_time: float = 1.0
    double_stance: float = 0.0
    touchdown: float = float(np.radians(50.0))
    liftoff: float | None = None
    leg_arc: float = np.pi

    def stance(self, share: float) -> tuple[float, float | None]:
        """Scale the stance; return its touchdown and lift-off angles [rad].

        The lift-off angle is None, for equal hip height, where `liftoff` is.

        Args:
            share: Stance angle over that of the whole stance [-].
        """
        whole = self.liftoff
        up = float(ideal_liftoff(self.touchdown, self.leg_arc)) if whole is None else whole
        down, up = scaled_stance(self.touchdown, up, share, self.leg_arc)
        return down, None if whole is None else up

    def cycle(self, part: "Part") -> CycleGait:
        """Return the gait of a part's cycles.

        Raises:
            DomainError: A time or an angle is impossible.
        """
        down, up = self.stance(part.share)
        return cycle_gait(
            self.gait, ground_time=self.ground_time, flight_time=self.flight_time,
            double_stance=self.double_stance, steering=part.steering, direction=part.direction,
            touchdown=down, liftoff=up, leg_arc=self.leg_arc,
        )  # fmt: skip


@dataclass(frozen=True)
class Part:
    """A part of a manoeuvre: whole strides of one gait.

    Attributes:
        bend: (1 - steering) / 2 with the sign of the turn, positive to the left: 0 walks straight,
            1/2 turns about inner legs that step on the spot, 1 turns the robot on the spot [-].
        share: Stance angle of the outer legs over that of the whole stance, up to 1 [-].
        strides: Number of strides.
    """

    bend: float
    share: float
    strides: int

    @property
    def steering(self) -> float:
        """Stance angle of the inner legs over that of the outer legs, from -1 to 1 [-]."""
        return 1.0 - 2.0 * abs(self.bend)

    @property
    def direction(self) -> Direction:
        """Side of the inner legs."""
        return "left" if self.bend >= 0 else "right"


@dataclass(frozen=True)
class Surroundings:
    """What a manoeuvre is walked with, by the model "dynamics".

    Attributes:
        robot: The robot.
        table: The slip law, as fitted walks correct it; None where nothing is walked.
        options: Step length and contacts.
        ground: The ground.
        bend: How the path is stretched and bent, as fitted walks say.
    """

    robot: Robot
    table: TractionTable | None
    options: DynamicsOptions
    ground: Ground = FLAT
    bend: Bend = STRAIGHT


def walked_end(parts: Sequence[Part], stepping: Stepping, around: Surroundings) -> Array:
    """Walk a manoeuvre; return x, y [m] and unwrapped yaw [rad] at its end, shape (3,).

    Args:
        parts: The parts, at least one.
        stepping: What they have in common.
        around: What it is walked with.

    Raises:
        DomainError: A gait is impossible, or there is no slip law.
        WalkError: The walk diverged.
    """
    if around.table is None:
        raise DomainError("there is no slip law; expected one, with which the robot walks")
    gaits = [stepping.cycle(part) for part in parts]
    legs = ProgramLegs.beginning_with(gaits[0])
    for part, gait in zip(parts, gaits, strict=True):
        for _ in range(part.strides):
            legs = legs.with_cycle(gait)
    walk = GrowingWalk(
        around.robot, around.table, around.options, ground=around.ground, bend=around.bend
    )
    return np.array(walk.pose(legs))


@dataclass(frozen=True)
class Fitted:
    """A manoeuvre with its end.

    Attributes:
        parts: The parts.
        end: x, y [m] and unwrapped yaw [rad] where it ends, shape (3,).
        missed: Distance from the goal, as `Goal.missed` counts an error of heading [m].
    """

    parts: tuple[Part, ...]
    end: Array
    missed: float


def fitted(
    parts: Sequence[Part], free: Sequence[tuple[int, str]], goal: Goal,
    stepping: Stepping, around: Surroundings,
) -> Fitted:  # fmt: skip
    """Fit shares and bends of a manoeuvre so that it ends at a goal, by Gauss-Newton.

    Derivatives are forward differences of walks. It ends within `SOLVED` of the goal, after
    `ROUNDS` rounds, or where no step leads nearer, as where no solution exists. Of several
    solutions it tends to the one nearest to the start.

    Args:
        parts: The parts to begin with.
        free: What is fitted: index of a part, and "share" or "bend".
        goal: Where it should end.
        stepping: What the parts have in common.
        around: What it is walked with.

    Raises:
        DomainError: A gait is impossible, or there is no slip law.
        WalkError: The walk diverged.
    """

    def walked(values: Array) -> Fitted:
        """Walk the manoeuvre with these values of the free fields."""
        changed = _with(parts, free, values)
        end = walked_end(changed, stepping, around)
        return Fitted(changed, end, float(np.linalg.norm(goal.missed(end.tolist()))))

    least = np.array([LEAST_SHARE if name == "share" else -1.0 for _, name in free])
    values = np.clip([getattr(parts[i], name) for i, name in free], least, 1.0)
    best = walked(values)
    for _ in range(ROUNDS):
        if best.missed <= SOLVED:
            break
        off, slopes = np.array(goal.missed(best.end.tolist())), []
        for k in range(len(free)):
            step = np.where(np.arange(len(free)) == k, -_STEP if values[k] > 0.5 else _STEP, 0.0)
            ahead = walked(values + step)
            slopes.append((np.array(goal.missed(ahead.end.tolist())) - off) / step[k])
        way = _within(np.column_stack(slopes), off, values, least)
        found = walked(np.clip(values + way, least, 1.0))
        if found.missed >= best.missed:
            found = walked(np.clip(values + _SHORTER * way, least, 1.0))
        if found.missed >= best.missed:
            break
        best, values = found, np.array([getattr(found.parts[i], name) for i, name in free])
    return best


def _within(slopes: Array, off: Array, values: Array, least: Array) -> Array:
    """Return the least-squares step (Gauss-Newton) towards the goal within the values' bounds.

    Of equally good steps it is the shortest. A value that would leave its bounds is set to the
    bound, and the others make up for it.

    Args:
        slopes: Derivatives of `off` by the values, shape (2 or 3, d).
        off: By how much the goal is missed now, as `Goal.missed`, shape (2 or 3,) [m].
        values: Values now, shape (d,).
        least: Lower bounds, shape (d,); the upper ones are 1.
    """
    way, open_ = np.zeros(len(values)), np.ones(len(values), dtype=bool)
    for _ in range(len(values)):
        rest = off + slopes[:, ~open_] @ way[~open_]
        way[open_] = -np.linalg.lstsq(slopes[:, open_], rest, rcond=1e-4)[0]
        bound = np.clip(values + way, least, 1.0) - values
        beyond = open_ & (np.abs(bound - way) > 1e-12)
        if not beyond.any():
            break
        way[beyond] = bound[beyond]
        open_ &= ~beyond
    return way


def _with(
    parts: Sequence[Part], free: Sequence[tuple[int, str]], values: Array
) -> tuple[Part, ...]:
    """Return the parts with the values of the fields that `free` lists, as in `fitted`."""
    changed = list(parts)
    for (i, name), value in zip(free, values.tolist(), strict=True):
        changed[i] = replace(changed[i], **{name: value})
    return tuple(changed)
