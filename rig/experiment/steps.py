# SPDX-License-Identifier: MIT
"""Expand a plan into ordered steps, estimate their duration, and check them against limits."""

import math
from collections.abc import Collection, Sequence
from dataclasses import dataclass
from typing import Final, Literal, TypeAlias

import numpy as np

from rig.errors import ProfileError
from rig.experiment.plan import LIMIT_UNITS, Plan, ground_speed, rig_limits
from rig.safety import require_within
from rig.slip_rig.profile import FURTHER_LIMITS, RigProfile

RISE: Final = 0.15
"""Estimated settling time of a disc at a new set-point [s]."""


@dataclass(frozen=True)
class Tare:
    """Step that measures the zero of the load cell, unloaded and at standstill.

    Attributes:
        number: Number of the step in the plan, from 1.
    """

    number: int


@dataclass(frozen=True)
class Point:
    """Step that measures a slip ratio, or a sweep of slip ratios, at one load.

    Attributes:
        number: Number of the step in the plan, from 1.
        load: Commanded normal force [N].
        slips: Commanded slip ratio; for a sweep the values that it interpolates in order [-].
        kind: A `point` of the grid, a `sweep`, or a `check` point.
        repeat: Number of the pass through the load's slips, from 1.
        direction: `up` where slip grows and `down` where it falls in the order `up-down`; empty
            in other orders.
    """

    number: int
    load: float
    slips: tuple[float, ...]
    kind: Literal["point", "sweep", "check"] = "point"
    repeat: int = 1
    direction: str = ""

    @property
    def label(self) -> str:
        """Label with kind, number, load, slip ratio (of a sweep first and last) and direction.

        >>> Point(7, 8.13, (0.25,)).label
        'point-0007 Fn 8.13 N slip 0.2500'
        """
        slip = " to ".join(f"{slip:.4f}" for slip in dict.fromkeys((self.slips[0], self.slips[-1])))
        end = f" {self.direction}" if self.direction else ""
        return f"{self.kind}-{self.number:04d} Fn {self.load:g} N slip {slip}{end}"

    def slip_at(self, fraction: float) -> float:
        """Interpolate the commanded slip ratio at a fraction of the recorded time [-].

        `slips` are equally spaced from 0 to 1, and held outside.
        """
        at = np.linspace(0.0, 1.0, len(self.slips))
        return float(np.interp(fraction, at, self.slips))


Step: TypeAlias = Tare | Point


def spell_out(plan: Plan) -> tuple[Step, ...]:
    """Expand a plan into its steps: zeros of the load cell, points and check points, in order.

    A zero comes first and, if a point follows, after every `tare_every` points; a check point comes
    before the first point and then after every `check_every`, at the load of the point that
    follows. The same plan always gives the same steps, also when shuffled: a resumed run relies on
    this.
    """
    steps: list[Step] = [Tare(1)]
    since_tare = 0
    for count, point in enumerate(_points(plan)):
        if plan.controls.tare_every and since_tare >= plan.controls.tare_every:
            steps.append(Tare(len(steps) + 1))
            since_tare = 0
        if plan.controls.check_every and count % plan.controls.check_every == 0:
            check = (plan.controls.check_slip,)
            steps.append(Point(len(steps) + 1, point.load, check, kind="check"))
        kind = "sweep" if plan.points.sweep else "point"
        steps.append(
            Point(len(steps) + 1, point.load, point.slips, kind, point.repeat, point.direction)
        )
        since_tare += 1
    return tuple(steps)


def steps_left(steps: Sequence[Step], done: Collection[int]) -> list[Step]:
    """List the steps that are left, a zero first; none if every point is finished.

    Of the zeros, only those are kept that directly follow a point that is left, and the one before
    the first such point.

    Args:
        steps: Steps of a plan, in order.
        done: Numbers of the finished points.
    """
    left = [step for step in steps if step.number not in done]
    first = next((k for k, step in enumerate(left) if isinstance(step, Point)), None)
    if first is None:
        return []
    return [step for k, step in enumerate(left) if isinstance(step, Point)
            or k + 1 == first or (k > first and isinstance(left[k - 1], Point))]  # fmt: skip


def _points(plan: Plan) -> list[Point]:
    """List the points of the grid in order, with the number 0, which `spell_out` replaces."""
    grid = plan.points
    rng = np.random.default_rng(grid.seed)
    loads = np.array(grid.loads)
    if grid.order == "shuffled":
        loads = rng.permutation(loads)
    return [
        Point(0, load, slips, repeat=repeat, direction=direction)
        for load in loads.tolist()
        for repeat in range(1, grid.repeats + 1)
        for slips, direction in _passes(plan, rng)
    ]


def _passes(plan: Plan, rng: np.random.Generator) -> list[tuple[tuple[float, ...], str]]:
    """List the points of one pass at one load in order, each as (slips, direction).

    Slips are as given, permuted by `rng` if shuffled, or ascending and then descending if up-down.
    A sweep is one point with all slips, or two if up-down, and is not shuffled.
    """
    grid = plan.points
    if grid.order == "up-down":
        up = tuple(sorted(grid.slips))
        if grid.sweep:
            return [(up, "up"), (up[::-1], "down")]
        return [((s,), "up") for s in up] + [((s,), "down") for s in up[-2::-1]]
    if grid.sweep:
        return [(grid.slips, "")]
    slips = np.array(grid.slips)
    if grid.order == "shuffled":
        slips = rng.permutation(slips)
    return [((s,), "") for s in slips.tolist()]


def require_allowed(plan: Plan, profile: RigProfile) -> None:
    """Check before motion that a plan's set-points and limits are within the rig's limits.

    Args:
        plan: The plan.
        profile: Profile of the rig, whose limits apply as well as the plan's.

    Raises:
        LimitExceeded: A speed or a load exceeds the smaller of both limits, or a limit of the plan
            that of the rig; the message has value, limit and unit.
        ProfileError: The plan limits a quantity that the rig does not measure: lateral force,
            torque or temperature.
    """
    allowed = rig_limits(plan.limits, profile.limits)
    for key, rigs in vars(profile.limits).items():
        own, unit = getattr(plan.limits, key), LIMIT_UNITS[key]
        if own is not None and key in FURTHER_LIMITS and key not in profile.measured:
            raise ProfileError(
                f"the plan's limits.{key} is {own:g} {unit}, but no device of the rig "
                f"'{profile.name}' measures it (torque: needs load_cell.counts_per_torque in the "
                f"profile); remove limits.{key}, or use another rig"
            )
        if own is not None and rigs is not None:
            quantity = f"the plan's limits.{key}, which the rig's profile limits,"
            require_within(own, rigs, quantity=quantity, unit=unit)
    omega = plan.points.omega_leg
    require_within(omega, allowed.speed, quantity="points.omega_leg (limits.speed)", unit="rad/s")
    for step in spell_out(plan):
        if isinstance(step, Tare):
            continue
        require_within(
            step.load, allowed.normal_force, quantity=f"normal force of {step.label}", unit="N"
        )
        for slip in step.slips:
            ground = ground_speed(
                slip, omega, radius_leg=profile.radius_leg, radius_ground=profile.radius_ground
            )
            quantity = f"ground disc's speed of {step.label} (limits.speed)"
            require_within(ground, allowed.speed, quantity=quantity, unit="rad/s")


@dataclass(frozen=True)
class DurationEstimate:
    """Estimated duration of steps.

    Attributes:
        seconds: Total duration with a single attempt at each point [s].
        points: Number of points and check points among the steps.
        loads: Number of times that the normal force is set, unloading for a zero included.
    """

    seconds: float
    points: int
    loads: int


def estimate(plan: Plan, steps: tuple[Step, ...]) -> DurationEstimate:
    """Estimate the duration of steps: setting loads, ramps, settling and recording.

    The first step sets its load. A load takes `patience` and two ramps; a point takes `RISE`, the
    window of the settling criterion, and its duration.

    Args:
        plan: Plan of the steps.
        steps: Remaining steps, in order.
    """
    ramp = plan.points.omega_leg / plan.limits.acceleration
    seconds, points, loads, load = 0.0, 0, 0, math.nan
    for step in steps:
        wanted = 0.0 if isinstance(step, Tare) else step.load
        if wanted != load:
            seconds += plan.load.patience + 2 * ramp
            loads, load = loads + 1, wanted
        if isinstance(step, Tare):
            seconds += plan.controls.tare_duration
        else:
            seconds += RISE + plan.settle.window + plan.points.duration
            points += 1
    return DurationEstimate(seconds, points, loads)
