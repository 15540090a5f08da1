# SPDX-License-Identifier: MIT
"""Read a walking program (`program.toml`): segments of gaits and stands, and when each ends."""

from dataclasses import dataclass
from pathlib import Path

import numpy as np

from model.errors import DomainError
from model.gait import TETRAPOD, TRIPOD, Direction, Gait, parse_gait
from model.gait.program import CycleGait, cycle_gait
from model.robot import N_LEGS
from model.routes.program import Segment, Until
from zebro_lab.files.settings_table import SettingsTable, read_settings
from zebro_lab.robot.gait_argument import LEAST_DEG

_GAITS = {"tripod": TRIPOD, "tetrapod": TETRAPOD}
_TIMES = ("ground_time", "flight_time")
_ENDS = ("strides", "time", "heading_deg", "near")
CYCLE = 2.0  # s, unless another is given
_MOST = 1000  # strides of a segment
_SHORTEST, _LONGEST = 0.01, 1000.0  # s, of any time


@dataclass(frozen=True)
class Program:
    """A walking program.

    Attributes:
        segments: Its parts, in order.
        names: What each does, for a table: gait and turn, or "stand".
        file: The file.
    """

    segments: tuple[Segment, ...]
    names: tuple[str, ...]
    file: Path

    @property
    def needs_walking(self) -> bool:
        """Whether a segment ends at a heading or a place, which only a walk shows."""
        return any(each.until is not None and each.until.needs_walking for each in self.segments)


def read_program(file: Path, *, leg_arc: float) -> Program:
    """Read a walking program.

    Args:
        file: The `program.toml`.
        leg_arc: Angle of the legs' arc [rad].

    Raises:
        NotFound: There is no such file.
        SettingsError: It is no TOML, has no `[[segment]]` or only stands, a key or value is
            invalid, or a gait is impossible; the message names file, segment and key.
    """
    table = read_settings(file, advice="expected a program.toml with [[segment]] tables")
    found = table.value("segment", [])
    if not isinstance(found, list) or not found:
        raise table.fault("expected one [[segment]] or more, with gait and until, or with stand",
                          "segment")  # fmt: skip
    tables = [table.as_table(f"segment[{i + 1}]", each) for i, each in enumerate(found)]
    parsed = [_segment(each, leg_arc) for each in tables]
    table.finish()
    if all(segment.gait is None for segment, _ in parsed):
        raise table.fault("only stands; expected at least one segment with a gait", "segment")
    segments, names = zip(*parsed, strict=True)
    return Program(segments, names, file)


def groups_of(text: str) -> Gait:
    """Return the groups of legs of a gait by its name, or by its groups in order.

    Args:
        text: "tripod", "tetrapod", or groups such as "{1,4} < {2,5} < {3,6}".

    Raises:
        DomainError: The text is neither.
    """
    try:
        return _GAITS[text] if text in _GAITS else parse_gait(text, N_LEGS)
    except DomainError as error:
        known = ", ".join(f"'{name}'" for name in _GAITS)
        raise DomainError(f"{error}; known names: {known}") from error


def even_times(cycle: float, groups: Gait) -> tuple[float, float]:
    """Return ground and flight time of a cycle that the groups share evenly [s].

    The flight time is the cycle over the number of groups, over two for a single group.

    Args:
        cycle: Duration of the cycle [s].
        groups: Groups of legs.
    """
    flight = cycle / max(len(groups.groups), 2)
    return cycle - flight, flight


def _segment(table: SettingsTable, leg_arc: float) -> tuple[Segment, str]:
    """Read a segment: a stand, or a gait and its end; also return what it does, for a table.

    Raises:
        SettingsError: A key or value is invalid, or the gait is impossible.
    """
    if "stand" in table:
        return Segment(stand=_seconds(table, "stand")), "stand"
    text = table.text("gait")
    try:
        groups = groups_of(text)
    except DomainError as error:
        raise table.fault(str(error), "gait") from error
    try:
        gait, turn = _gait(table, groups, leg_arc)
        until = _until(table.table("until"))
    except DomainError as error:
        raise table.fault(str(error)) from error
    return Segment(gait, until), f"{text}, {turn}"


def _gait(table: SettingsTable, groups: Gait, leg_arc: float) -> tuple[CycleGait, str]:
    """Read times, steering and angles; also return what the segment does, for a table."""
    steering = table.number("steering", 1.0)
    right = table.choice("direction", ("left", "right"), "left") == "right"
    direction: Direction = "right" if right else "left"
    reverse = table.flag("reverse", default=False)
    turn_time = _seconds(table, "turn_time", least=0.0) if "turn_time" in table else 0.0
    double = _seconds(table, "double_stance", least=0.0) if "double_stance" in table else 0.0
    down = _degrees(table, "touchdown_deg") if "touchdown_deg" in table else 50.0
    up = _degrees(table, "liftoff_deg") if "liftoff_deg" in table else None
    ground, flight = _times(table, groups)
    gait = cycle_gait(
        groups, ground_time=ground, flight_time=flight, turn_time=turn_time, double_stance=double,
        steering=steering, direction=direction, reverse=reverse, touchdown=float(np.radians(down)),
        liftoff=None if up is None else float(np.radians(up)), leg_arc=leg_arc,
    )  # fmt: skip
    turns = (
        *((f"steering {steering:g}",) if steering != 1 else ()),
        *((f"turn time {turn_time:g} s",) if turn_time > 0 else ()),
    )
    turn = f"{', '.join(turns)} {direction}" if turns else "straight"
    return gait, f"{turn}, backwards" if reverse else turn


def _times(table: SettingsTable, groups: Gait) -> tuple[float, float]:
    """Return ground and flight time [s]: both as given, else a cycle that groups share evenly.

    That is the `cycle` of the table, else `CYCLE`; `SettingsError` if it is beside one of the
    times.
    """
    if any(name in table for name in _TIMES):
        if "cycle" in table:
            raise table.fault("found beside ground_time or flight_time; give either", "cycle")
        return (
            _seconds(table, "ground_time"),
            _seconds(table, "flight_time"),
        )
    return even_times(_seconds(table, "cycle") if "cycle" in table else CYCLE, groups)


def _until(table: SettingsTable) -> Until:
    """Read when a segment ends.

    Raises:
        SettingsError: Not exactly one of `_ENDS` is given, or a value is invalid; a heading is
            above 0.
    """
    given = [name for name in _ENDS if name in table]
    if len(given) != 1:
        raise table.fault(
            f"found {' and '.join(given) or 'none'} of {', '.join(_ENDS)}; expected one, such as "
            "until = { strides = 5 }"
        )
    if "strides" in table:
        return Until(strides=table.whole("strides", least=1, most=_MOST))
    if "time" in table:
        return Until(time=_seconds(table, "time"))
    if "heading_deg" in table:
        heading = table.number("heading_deg")
        if heading <= 0:
            raise table.fault(f"is {heading:g}; expected more than 0: the side to turn to is "
                              "direction", "heading_deg")  # fmt: skip
        return Until(heading=float(np.radians(heading)))
    x, y, radius = table.quantities("near", 3, "m")
    return Until(near=(x, y, radius))


def _seconds(table: SettingsTable, key: str, *, least: float = _SHORTEST) -> float:
    """Read a time from `least` [s], by default 10 ms, to 1000 s; raise `SettingsError` beyond."""
    value = table.quantity(key, "s", least=least)
    if value > _LONGEST:
        raise table.fault(f"is {value:g} s; expected at most {_LONGEST:g} s", key)
    return value


def _degrees(table: SettingsTable, key: str) -> float:
    """Read an angle in degrees.

    Raises:
        SettingsError: Its size is below `LEAST_DEG` and not 0: it is probably in radians.
    """
    angle = table.number(key)
    if 0 < abs(angle) < LEAST_DEG:
        raise table.fault(
            f"is {angle:g}, which is improbable in degrees; if it is in radians, write "
            f"{np.degrees(angle):.4g}", key,
        )  # fmt: skip
    return angle
