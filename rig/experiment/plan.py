# SPDX-License-Identifier: MIT
"""The plan of an experiment as frozen dataclasses: points, load, settling, acceptance, limits."""

from dataclasses import dataclass
from typing import Any, Final, Literal, TypeAlias

from rig.device import Limits
from rig.slip_rig.profile import FURTHER_LIMITS

SCHEMA: Final = 1
"""Version of the layout of plans; a file with another one is an error."""
MOST_POINTS: Final = 100_000
"""Largest allowed number of points between two zeros or two check points."""
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
"""Limits above which a guard counts as off, in the unit of `LIMIT_UNITS`; for `speed_error` it is
half of `PointGrid.omega_leg`."""

WATCHDOG_PROOF: Final = "watchdog_proof"
"""Name in `RunLimits.guards_off` of the trial of the watchdogs, which no limit belongs to."""


@dataclass(frozen=True)
class PointGrid:
    """Grid of points to measure: every slip ratio at every load, the loads outermost.

    Attributes:
        loads: Normal forces [N].
        slips: Material slip ratios, Eq. (4-44) [-].
        omega_leg: Speed of the leg disc at every point [rad/s].
        duration: Recorded time of a point, or of a whole sweep [s].
        order: `monotone` as given; `shuffled` both within and among the loads, of sweeps only the
            loads; or `up-down`: loads as given, slips ascending, then descending, the largest once.
        seed: Seed of the shuffle.
        repeats: Number of passes through the slips at each load.
        sweep: Whether the slip changes continuously through all its values in one run for each
            pass; in the order `up-down` one up and one down.
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
    """How the normal force is set.

    Attributes:
        set_by: `hand`, on the threaded shaft.
        tolerance: Largest difference of the normal force from its target [N].
        patience: Estimated time to set a load [s].
    """

    set_by: Literal["hand"]
    tolerance: float
    patience: float


@dataclass(frozen=True)
class SettleCriterion:
    """Criterion for a steady state before recording: both halves of a window agree.

    The criterion uses friction, traction over normal force, and not the forces: the bump of the
    ground disc changes the forces in every turn but hardly the friction.

    Attributes:
        window: Length of the window, whose halves are compared [s].
        speed: Largest difference of each disc's mean speed from its set-point, and between the
            mean speeds of both halves [rad/s].
        friction: Largest difference of the friction between both halves [-].
        timeout: Time after which the point is recorded even if it is not steady [s].
    """

    window: float
    speed: float
    friction: float
    timeout: float


@dataclass(frozen=True)
class Acceptance:
    """Acceptance limits of a recorded point, which is repeated if it exceeds one.

    Attributes:
        slip: Largest difference of the mean slip ratio from the commanded mean [-].
        slip_drift: Largest difference of the mean slip ratio between both halves of the recorded
            time; not for sweeps [-].
        friction_drift: Largest difference of the friction, traction over normal force, between
            both halves; not for sweeps [-].
        attempts: Largest number of attempts at a point.
    """

    slip: float
    slip_drift: float
    friction_drift: float
    attempts: int


@dataclass(frozen=True)
class Controls:
    """Zeros of the load cell and check points between the points.

    Attributes:
        tare_every: Number of points, check points not counted, between two zeros of the load
            cell; 0 means a single zero, before the first point.
        tare_duration: Time over which a zero is averaged [s].
        zero_drift: Largest change of a zero without a question; twice its standard error is added
            [N].
        check_every: Number of points between two check points, the first of which precedes all
            points; 0 means no check points.
        check_slip: Slip ratio of the check point, at the load of the next point [-].
    """

    tare_every: int
    tare_duration: float
    zero_drift: float
    check_every: int
    check_slip: float


@dataclass(frozen=True)
class RunLimits:
    """Limits of an experiment, at which the guards stop the rig.

    Attributes:
        speed: Largest speed of a disc's set-point [rad/s].
        acceleration: Rate at which the set-points of the discs ramp [rad/s^2].
        normal_force: Largest magnitude of the normal force [N].
        traction_force: Largest magnitude of the traction force [N].
        in_a_row: Number of samples beyond a limit of force, torque or temperature, among the latest
            2 in_a_row - 1, that are a fault.
        speed_error: Largest difference of a disc's speed from its set-point [rad/s].
        speed_error_time: Longest duration of a speed error beyond that [s].
        silence: Longest time for which a device may send no samples [s].
        reading_age: Largest age of a reading when it is checked [s].
        frozen: Longest time for which forces and speeds stay the same, bit for bit, while discs
            turn [s].
        rest_speed: Largest mean speed of a disc that counts as standing [rad/s].
        free_space: Least free space on the disk of the data [bytes].
        hold: Longest duration of a hold, after which a soft stop becomes a safe one [s].
        lateral_force: Largest magnitude of the force on the load cell's third axis; None where the
            plan does not limit it [N].
        torque: Largest magnitude of the torque about any axis of the load cell; None where the plan
            does not limit it [N m].
        temperature_celsius: Highest temperature of a drive or its motor; None where the plan does
            not limit it [degC].
        guards_off: Names of limits that a person has explicitly set so high that they have no
            effect; and `WATCHDOG_PROOF`, where watchdogs are not to be tried.
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
    def guards_off_text(self) -> str:
        """Text with the names of `guards_off` and their limits; empty where no guard is off."""
        return ", ".join(
            f"{name} ({getattr(self, name):g} {LIMIT_UNITS[name]})" if name in LIMIT_UNITS else name
            for name in self.guards_off
        )


@dataclass(frozen=True)
class Plan:
    """Plan of an experiment.

    Attributes:
        name: Name of the experiment.
        material: Leg and ground material.
        operator: Name of the operator.
        points: Grid of points to measure.
        load: How the normal force is set.
        settle: Criterion for a steady state.
        accept: Acceptance limits of a point.
        controls: How often zeros and check points are measured.
        limits: Limits of the guards.
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
    """Compute the speed of the ground disc for a material slip ratio, Eq. (4-44) [rad/s].

    Args:
        slip: Material slip ratio; 1 makes the ground disc stand [-].
        omega_leg: Speed of the leg disc [rad/s].
        radius_leg: Radius of the leg disc [m].
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
        The limits that hold for the run; None where neither plan nor rig limits a quantity.
    """
    smaller: dict[str, Any] = {
        name: min((v for v in (getattr(limits, name), own) if v is not None), default=None)
        for name, own in vars(allowed).items()
    }
    return Limits(**smaller)
