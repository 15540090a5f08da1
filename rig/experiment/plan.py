# SPDX-License-Identifier: MIT
"""The plan of an experiment: frozen values, read out of a table with every key checked."""

from dataclasses import dataclass
from typing import Final, Literal, TypeAlias

from rig.device import Limits
from rig.slip_rig.profile import FURTHER_LIMITS

SCHEMA: Final = 1
MOST_POINTS: Final = 100_000
"""Largest number of points between two zeros or checks."""
Order: TypeAlias = Literal["monotone", "shuffled", "up-down"]
ORDERS: Final[tuple[Order, ...]] = ("monotone", "shuffled", "up-down")
LIMIT_UNITS: Final = {
    "speed": "rad/s", "acceleration": "rad/s2", "normal_force": "N", "traction_force": "N",
    "in_a_row": "samples", "speed_error": "rad/s", "speed_error_time": "s", "silence": "s",
    "reading_age": "s", "frozen": "s", "rest_speed": "rad/s", "free_space": "bytes", "hold": "s",
    **FURTHER_LIMITS,
}  # fmt: skip
"""Unit of each limit of an experiment."""
OFF_ABOVE: Final = {
    "in_a_row": 10.0, "speed_error_time": 1.0, "silence": 1.0, "reading_age": 1.0, "frozen": 1.0,
    "rest_speed": 1.0,
}  # fmt: skip
"""Limits above which a guard counts as off; so does `speed_error` above half the top speed."""


@dataclass(frozen=True)
class PointGrid:
    """What is to be measured: every slip ratio at every load, the loads outermost.

    Attributes:
        loads: Normal forces [N].
        slips: Material slip ratios, Eq. (4-44) [-].
        omega_leg: Speed of the leg disc [rad/s].
        duration: Recorded time of a point, or of a whole sweep [s].
        order: `monotone` as given, `shuffled` within and among the loads, or `up-down`.
        seed: Of the shuffle.
        repeats: Times that the slips of a load are gone through.
        sweep: Let the slip glide through all its values in one run a load.
    """

    loads: tuple[float, ...]
    slips: tuple[float, ...]
    omega_leg: float
    duration: float
    order: Order
    seed: int
    repeats: int
    sweep: bool


@dataclass(frozen=True)
class LoadSetting:
    """How the normal force comes about.

    Attributes:
        set_by: `hand` on the threaded shaft, or a driven `axis`.
        tolerance: Distance from the target that is good enough [N].
        patience: What a person is reckoned to need, and longest time for an axis [s].
    """

    set_by: Literal["hand", "axis"]
    tolerance: float
    patience: float


@dataclass(frozen=True)
class SettleCriterion:
    """When a point is steady enough to be recorded: both halves of a window agree.

    Friction, traction over normal force, is looked at and not force: the bump of the ground disc
    changes forces in every turn and friction hardly.

    Attributes:
        window: Length of the window [s].
        speed: Distance of each disc's mean speed from its set-point, and of both halves [rad/s].
        friction: Distance of both halves' friction [-].
        timeout: When to give up waiting and record all the same [s].
    """

    window: float
    speed: float
    friction: float
    timeout: float


@dataclass(frozen=True)
class Acceptance:
    """What a recorded point must show, or it is repeated.

    Attributes:
        slip: Distance of the mean slip ratio from the commanded one [-].
        slip_drift: Distance of the mean slip ratio in both halves [-].
        friction_drift: Distance of the friction in both halves [-].
        attempts: Times that a point is tried.
    """

    slip: float
    slip_drift: float
    friction_drift: float
    attempts: int


@dataclass(frozen=True)
class Controls:
    """Zeros and check points in between.

    Attributes:
        tare_every: Points between two zeros of the load cell; 0 is once, before the first point.
        tare_duration: Time a zero is taken from [s].
        zero_drift: Change of the zero that is worth a warning [N].
        check_every: Points between two check points; 0 is none.
        check_slip: Slip ratio of the check point, at whatever load is set [-].
    """

    tare_every: int
    tare_duration: float
    zero_drift: float
    check_every: int
    check_slip: float


@dataclass(frozen=True)
class RunLimits:
    """What guards stop the rig at: all limits of an experiment.

    Attributes:
        speed: Of a disc [rad/s].
        acceleration: With which set-points of a disc change [rad/s^2].
        normal_force: Normal force [N].
        traction_force: Traction force [N].
        in_a_row: Samples beyond a force limit, among the latest 2 in_a_row - 1, that make a fault.
        speed_error: Distance of a disc from its set-point [rad/s].
        speed_error_time: How long that may last [s].
        silence: How long a stream may be silent [s].
        reading_age: How old a reading may be when it is looked at [s].
        frozen: How long forces and speeds may stay the same, bit for bit, while discs turn [s].
        rest_speed: Mean speed below which a disc counts as standing [rad/s].
        free_space: What must be left where data is written [bytes].
        hold: How long a soft stop holds before it becomes a safe one [s].
        lateral_force: Force on the load cell's third axis; None where it is not guarded [N].
        torque: Torque on any of its axes; None where it is not guarded [N m].
        temperature_celsius: Of a drive or its motor; None where it is not guarded [degC].
        guards_off: Those of the limits that are so high, by a person's explicit wish, that they
            guard nothing.
    """

    speed: float
    acceleration: float
    normal_force: float
    traction_force: float
    in_a_row: int
    speed_error: float
    speed_error_time: float
    silence: float
    reading_age: float
    frozen: float
    rest_speed: float
    free_space: float
    hold: float
    lateral_force: float | None
    torque: float | None
    temperature_celsius: float | None
    guards_off: tuple[str, ...]

    @property
    def off_said(self) -> str:
        """Which guards are off, with their limits, in words; empty where none is."""
        return ", ".join(
            f"{name} ({getattr(self, name):g} {LIMIT_UNITS[name]})" for name in self.guards_off
        )


@dataclass(frozen=True)
class Plan:
    """An experiment.

    Attributes:
        name: Its name.
        material: Leg and ground material.
        operator: Who runs it.
        points: What is measured.
        load: How the normal force is set.
        settle: When a point is steady.
        accept: When a point is good.
        controls: Zeros and check points.
        limits: What stops it.
    """

    name: str
    material: str
    operator: str
    points: PointGrid
    load: LoadSetting
    settle: SettleCriterion
    accept: Acceptance
    controls: Controls
    limits: RunLimits


def ground_speed(
    slip: float, omega_leg: float, *, radius_leg: float, radius_ground: float
) -> float:
    """Compute the ground disc's speed that makes a material slip ratio, Eq. (4-44) [rad/s].

    Args:
        slip: Slip ratio [-].
        omega_leg: Speed of the leg disc [rad/s].
        radius_leg: Its radius [m].
        radius_ground: Radius of the ground disc [m].

    >>> round(ground_speed(0.5, 12.0, radius_leg=0.035, radius_ground=0.12), 3)
    1.75
    """
    return omega_leg * radius_leg * (1 - slip) / radius_ground


def rig_limits(limits: RunLimits, allowed: Limits) -> Limits:
    """Return the smaller of a plan's and a rig's limit of each quantity.

    Args:
        limits: Limits of the plan.
        allowed: Limits of the rig's profile.

    Returns:
        The limits that hold for the run.
    """
    further = {
        key: min((own for own in (getattr(limits, key), getattr(allowed, key)) if own is not None),
                 default=None)
        for key in FURTHER_LIMITS
    }  # fmt: skip
    return Limits(
        speed=min(limits.speed, allowed.speed),
        normal_force=min(limits.normal_force, allowed.normal_force),
        traction_force=min(limits.traction_force, allowed.traction_force),
        **further,
    )
