# SPDX-License-Identifier: MIT
"""One way to a goal, as it was walked, and which of two ways is faster and cheaper."""

from dataclasses import dataclass

import numpy as np

from model.counted import counted
from model.routes.goal import Goal
from model.routes.manoeuvre import Part
from model.walk.leg_work import LegWork, leg_work
from model.walk.path import WalkPath
from zebro_lab.walk.walking import Walked

STOP_TURN_WALK, CURVE = "stop-turn-walk", "curve"
PLACE, HEADING = 0.005, float(np.radians(1.0))  # m and rad; a goal missed by more is told of
_EQUAL_TIME, _EQUAL_WORK = 0.05, 0.01  # s; share of the work


@dataclass(frozen=True)
class Way:
    """A way to a goal.

    Attributes:
        number: Number of the goal, from 1.
        goal: The goal.
        manoeuvre: `STOP_TURN_WALK` or `CURVE`.
        parts: Its parts.
        walked: The walk of its program.
        program: Name of the program's file in the result folder.
    """

    number: int
    goal: Goal
    manoeuvre: str
    parts: tuple[Part, ...]
    walked: Walked
    program: str

    @property
    def path(self) -> WalkPath:
        """The walked path."""
        return self.walked.path

    @property
    def time(self) -> float:
        """Duration [s]."""
        return float(self.path.t[-1])

    @property
    def work(self) -> LegWork:
        """Work of the legs' motors, and what slip and contacts take."""
        return leg_work(self.path)

    @property
    def strides(self) -> int:
        """Number of strides."""
        return sum(part.strides for part in self.parts)

    @property
    def end(self) -> tuple[float, float, float]:
        """x, y and yaw at the end [m, m, rad]."""
        x, y = self.path.position[-1, :2].tolist()
        return x, y, float(self.path.yaw[-1])

    @property
    def place_error(self) -> float:
        """Distance of the end from the goal [m]."""
        x, y, _ = self.end
        return float(np.hypot(x - self.goal.x, y - self.goal.y))

    @property
    def heading_error(self) -> float:
        """Heading at the end minus the goal's, from -pi to pi; NaN if the goal has none [rad]."""
        if self.goal.heading is None:
            return float("nan")
        return float((self.end[2] - self.goal.heading + np.pi) % (2 * np.pi) - np.pi)

    @property
    def described(self) -> str:
        """What the robot does, part by part."""
        return ", ".join(_described(part) for part in self.parts)

    def document(self) -> dict[str, object]:
        """Return time, length, work and errors, for `--json` and the table; keys have the unit."""
        work, (x, y, yaw) = self.work, self.end
        return {
            "manoeuvre": self.manoeuvre,
            "parts": self.described,
            "strides": self.strides,
            "time_s": self.time,
            "length_m": self.path.length,
            "work_done_j": work.done,
            "work_taken_back_j": work.taken_back,
            "slip_energy_j": work.slip,
            "contact_energy_j": work.contacts,
            "end_x_m": x,
            "end_y_m": y,
            "end_yaw_rad": yaw,
            "place_error_m": self.place_error,
            "heading_error_rad": self.heading_error,
            "program": self.program,
        }


def _described(part: Part) -> str:
    """Say what a part does: straight, on the spot (`bend` of 1 or -1), or along a curve."""
    strides = counted(part.strides, "stride")
    if part.bend == 0:
        return f"{strides} straight"
    if abs(part.bend) == 1:
        return f"{strides} on the spot to the {part.direction}"
    return f"{strides} of steering {part.steering:.3f} to the {part.direction}"


def named(goal: Goal) -> str:
    """Return a goal for tables and titles.

    >>> named(Goal(1.0, -0.5)), named(Goal(0.0, 2.0, np.pi / 2))
    ('1, -0.5 m', '0, 2 m, 90 deg')
    """
    place = f"{goal.x:g}, {goal.y:g} m"
    return place if goal.heading is None else f"{place}, {np.degrees(goal.heading):.4g} deg"


def compared(turning: Way, curving: Way) -> str:
    """Say in one sentence which of two ways to a goal is faster, and which takes less work.

    Times that differ by up to `_EQUAL_TIME` are equal, as is work that differs by up to the share
    `_EQUAL_WORK` of the larger.
    """
    where = f"goal {turning.number} ({named(turning.goal)})"
    times, work = (turning.time, curving.time), (turning.work.done, curving.work.done)
    faster = _less(*times, "s", equal=_EQUAL_TIME)
    cheaper = _less(*work, "J", equal=_EQUAL_WORK * max(work))
    first = "both ways take as long"
    if faster is not None:
        first = f"{faster[0]} is faster by {faster[1]}"
    if cheaper is None:
        second = "both need the same work"
    elif faster is not None and faster[0] == cheaper[0]:
        second = f"needs less work by {cheaper[1]}"
    else:
        second = f"{cheaper[0]} needs less work by {cheaper[1]}"
    return f"{where}: {first}, and {second}"


def _less(turning: float, curving: float, unit: str, *, equal: float) -> tuple[str, str] | None:
    """Return the way with the smaller number, and by how much; None if by `equal` or less."""
    less = abs(turning - curving)
    if less <= equal:
        return None
    name = CURVE if curving < turning else STOP_TURN_WALK
    return name, f"{less:.3g} {unit} ({less / max(turning, curving):.0%})"


def missed(way: Way) -> str | None:
    """Return a warning if a way ends more than 5 mm or 1 degree from its goal; else None."""
    off = abs(way.heading_error)
    if way.place_error <= PLACE and not off > HEADING:
        return None
    turned = f" and {np.degrees(off):.1f} deg" if off > HEADING else ""
    return (
        f"WARNING: goal {way.number}: the {way.manoeuvre} ends {1000 * way.place_error:.0f} mm"
        f"{turned} from the goal, the nearest that was found with strides of this gait"
    )
