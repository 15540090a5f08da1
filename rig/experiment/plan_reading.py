# SPDX-License-Identifier: MIT
"""Parse and validate the plan of an experiment from a TOML table."""

import math

from model.toml_table import TomlTable
from rig.experiment.plan import (
    LIMIT_UNITS,
    MOST_POINTS,
    OFF_ABOVE,
    ORDERS,
    SCHEMA,
    Acceptance,
    Controls,
    LoadSetting,
    Plan,
    PointGrid,
    RunLimits,
    SettleCriterion,
)
from rig.safety import REST_SPEED
from rig.slip_rig.profile import FURTHER_LIMITS


def parse_plan(table: TomlTable) -> Plan:
    """Parse the plan of an experiment from a TOML table.

    Args:
        table: The whole plan; every key is read.

    Returns:
        The plan.

    Raises:
        ProfileError: A key is missing or unknown (the message names the nearest known one), a
            value is invalid, or `guards_off` contradicts a limit; a subclass of `TomlTable` raises
            its own error.
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


def _points(table: TomlTable) -> PointGrid:
    """Read the grid; the length of a point is a `duration` [s] or `turns` of the leg disc.

    Loads must be above 0 N and slips at most 1; a sweep needs at least two slips.
    """
    length = table.choice("length", ("duration", "turns"))
    omega = table.positive("omega_leg")
    # Turns of the leg disc, because the ground disc stands still at slip 1.
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
            f"found {max(grid.slips):g}; expected at most 1, at which the ground disc stands",
            "slips",
        )
    if grid.sweep and len(grid.slips) < 2:
        raise table.fault("found one slip ratio; a sweep needs at least two", "slips")
    return grid


def _load(table: TomlTable) -> LoadSetting:
    """Read how the load is set, of which `set_by = "hand"` is the only way accepted."""
    set_by = table.text("set_by")
    if set_by != "hand":
        raise table.fault(f'found {set_by!r}; set the load by hand: set_by = "hand"', "set_by")
    return LoadSetting(
        set_by="hand",
        tolerance=table.positive("tolerance"),
        patience=table.positive("patience", 30.0),
    )


def _settle(table: TomlTable) -> SettleCriterion:
    """Read the criterion for a steady state, whose timeout must be at least its window."""
    criterion = SettleCriterion(
        window=table.positive("window"),
        speed=table.positive("speed"),
        friction=table.positive("friction"),
        timeout=table.positive("timeout"),
    )
    if criterion.timeout < criterion.window:
        raise table.fault(
            f"found {criterion.timeout:g} s; expected at least the window, {criterion.window:g} s",
            "timeout",
        )
    return criterion


def _accept(table: TomlTable) -> Acceptance:
    """Read the largest deviations of an accepted point, and the number of attempts at one."""
    return Acceptance(
        slip=table.positive("slip"),
        slip_drift=table.positive("slip_drift"),
        friction_drift=table.positive("friction_drift"),
        attempts=table.whole("attempts", 3, least=1, most=100),
    )


def _controls(table: TomlTable) -> Controls:
    """Read how often zeros and check points are measured."""
    return Controls(
        tare_every=table.whole("tare_every", 0, most=MOST_POINTS),
        tare_duration=table.positive("tare_duration", 1.0),
        zero_drift=table.positive("zero_drift", 0.1),
        check_every=table.whole("check_every", 0, most=MOST_POINTS),
        check_slip=table.number("check_slip", 0.5),
    )


def _limits(table: TomlTable, *, top_speed: float) -> RunLimits:
    """Read the limits and check each against `guards_off`.

    A guard of the speed error counts as off above half of `top_speed`, the leg disc's [rad/s].
    """
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
    """Check that a limit is above `highest` if and only if `guards_off` names it.

    Raises:
        ProfileError: The limit and `guards_off` contradict each other.
    """
    value, unit = getattr(limits, name), LIMIT_UNITS[name]
    if value > highest and name not in limits.guards_off:
        raise table.fault(
            f"found {value:g} {unit}; above {highest:g} {unit} this guard counts as off: lower the "
            f'limit, or add "{name}" to limits.guards_off',
            name,
        )
    if value <= highest and name in limits.guards_off:
        raise table.fault(
            f"names '{name}', but limits.{name} is {value:g} {unit}, and this guard counts as off "
            f"only above {highest:g} {unit}; remove the name, or raise the limit",
            "guards_off",
        )
