# SPDX-License-Identifier: MIT
"""The plan of an experiment: frozen values, read out of a table with every key checked."""

import math
from dataclasses import dataclass
from typing import Final, Literal, TypeAlias

from rig.device import Limits
from rig.safety import REST_SPEED
from rig.slip_rig.profile import FURTHER_LIMITS
from rig.toml_table import TomlTable

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


def parse_plan(table: TomlTable) -> Plan:
    """Read a plan.

    Args:
        table: The whole plan; every key is taken.

    Returns:
        The plan.

    Raises:
        ProfileError: A key is missing, unknown (the nearest known one is named) or impossible; or
            the table's own error.
    """
    table.whole("schema", least=SCHEMA, most=SCHEMA)
    parts = {key: table.table(key) for key in
             ("points", "load", "settle", "accept", "controls", "limits")}  # fmt: skip
    points = _points(parts["points"])
    plan = Plan(
        name=table.text("name"),
        material=table.text("material"),
        operator=table.text("operator", ""),
        points=points,
        load=_load(parts["load"]),
        settle=_settle(parts["settle"]),
        accept=_accept(parts["accept"]),
        controls=_controls(parts["controls"]),
        limits=_limits(parts["limits"], top_speed=points.omega_leg),
    )
    table.finish()
    return plan


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
    """Combine a plan's limits with a rig's: the smaller of each counts."""
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


def _points(table: TomlTable) -> PointGrid:
    length = table.choice("length", ("duration", "turns"))
    omega = table.positive("omega_leg")
    # Turns are the leg disc's: the ground disc stands still at slip 1.
    grid = PointGrid(
        loads=table.series("loads"),
        slips=table.series("slips"),
        omega_leg=omega,
        duration=table.positive(length) * (2 * math.pi / omega if length == "turns" else 1.0),
        order=table.choice("order", ORDERS),
        seed=table.whole("seed", 1, most=2**31),
        repeats=table.whole("repeats", 1, least=1, most=1000),
        sweep=table.flag("sweep", False),
    )
    if min(grid.loads) <= 0:
        raise table.fault(f"found {min(grid.loads):g} N; expected loads above 0 N", "loads")
    if max(grid.slips) > 1:
        raise table.fault(
            f"found {max(grid.slips):g}; expected at most 1, where the ground disc stands still",
            "slips",
        )
    if grid.sweep and len(grid.slips) < 2:
        raise table.fault("found one slip; a sweep needs two or more", "slips")
    return grid


def _load(table: TomlTable) -> LoadSetting:
    return LoadSetting(
        set_by=table.choice("set_by", ("hand", "axis")),
        tolerance=table.positive("tolerance"),
        patience=table.positive("patience", 30.0),
    )


def _settle(table: TomlTable) -> SettleCriterion:
    criterion = SettleCriterion(
        window=table.positive("window"),
        speed=table.positive("speed"),
        friction=table.positive("friction"),
        timeout=table.positive("timeout"),
    )
    if criterion.timeout < criterion.window:
        raise table.fault(
            f"found {criterion.timeout:g} s; expected at least the window's {criterion.window:g} s",
            "timeout",
        )
    return criterion


def _accept(table: TomlTable) -> Acceptance:
    return Acceptance(
        slip=table.positive("slip"),
        slip_drift=table.positive("slip_drift"),
        friction_drift=table.positive("friction_drift"),
        attempts=table.whole("attempts", 3, least=1, most=100),
    )


def _controls(table: TomlTable) -> Controls:
    return Controls(
        tare_every=table.whole("tare_every", 0, most=MOST_POINTS),
        tare_duration=table.positive("tare_duration", 1.0),
        zero_drift=table.positive("zero_drift", 0.1),
        check_every=table.whole("check_every", 0, most=MOST_POINTS),
        check_slip=table.number("check_slip", 0.5),
    )


def _limits(table: TomlTable, *, top_speed: float) -> RunLimits:
    off_above = OFF_ABOVE | {"speed_error": top_speed / 2}
    silence = table.positive("silence", 0.25)
    limits = RunLimits(
        speed=table.positive("speed"),
        acceleration=table.positive("acceleration"),
        normal_force=table.positive("normal_force"),
        traction_force=table.positive("traction_force"),
        in_a_row=table.whole("in_a_row", 3, least=1, most=1000),
        speed_error=table.positive("speed_error"),
        speed_error_time=table.positive("speed_error_time", 0.2),
        silence=silence,
        reading_age=table.positive("reading_age", min(silence, OFF_ABOVE["reading_age"])),
        frozen=table.positive("frozen", 0.25),
        rest_speed=table.positive("rest_speed", REST_SPEED),
        free_space=table.positive("free_space", 100e6),
        hold=table.positive("hold", 600.0),
        **{key: table.positive_or_none(key) for key in FURTHER_LIMITS},
        guards_off=table.names("guards_off", tuple(off_above)),
    )
    for name, highest in off_above.items():
        _require_guard(table, limits, name, highest)
    return limits


def _require_guard(table: TomlTable, limits: RunLimits, name: str, highest: float) -> None:
    """Refuse a limit that turns its guard off without saying so, and saying so of one that is on.

    Raises:
        ProfileError: The limit and `guards_off` contradict each other.
    """
    value, unit = getattr(limits, name), LIMIT_UNITS[name]
    if value > highest and name not in limits.guards_off:
        raise table.fault(
            f"found {value:g} {unit}, above {highest:g} {unit}, where the guard is as good as off; "
            f'lower it, or write guards_off = ["{name}"]',
            name,
        )
    if value <= highest and name in limits.guards_off:
        raise table.fault(
            f"names '{name}', whose limit of {value:g} {unit} guards; take it out, or raise the "
            f"limit above {highest:g} {unit}",
            "guards_off",
        )
