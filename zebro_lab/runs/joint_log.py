# SPDX-License-Identifier: MIT
"""Read joint angles from a ROS log to a table of leg angles."""

import re
from collections.abc import Collection, Iterable, Mapping
from dataclasses import dataclass, replace
from functools import partial
from pathlib import Path
from types import SimpleNamespace
from typing import Any, Final

import numpy as np
import pandas as pd

from model.arrays import Array
from model.robot import N_LEGS
from zebro_lab.files.errors import DataError
from zebro_lab.files.opening import parsing
from zebro_lab.files.units import factor_to_si
from zebro_lab.mcap.log_records import LoggedMessage
from zebro_lab.mcap.log_topics import OTHER_FIELDS, Parts, SeveralTopics, read_topic
from zebro_lab.robot.leg_log import ANGLES, WIDEST
from zebro_lab.tables.columns import Columns
from zebro_lab.tables.raw_table import RawTable


def joined_readings(table: RawTable, turns: Mapping[str, float]) -> RawTable:
    """Return one row of all legs for each reading of the leg that has the fewest.

    Readings outside the times of another leg's give no row. Angles are unwrapped and interpolated
    in time, between two of the same leg. A table with a row of all legs is returned as it is: what
    is missing in others is a fault of theirs. So is one in which a leg has fewer than two readings.

    Args:
        table: A row per message, `t` [s], NaN where a message does not hold a leg.
        turns: Value of a whole turn of each leg, by its header, in the unit of the column.

    Raises:
        DataError: Stamps of a leg do not increase, or a row lies in a gap of a leg's readings, of
            over 5 of its median steps; or the direction of a wrapped leg is ambiguous.
    """
    angles = {name: table.columns[name].to_numpy(dtype=float) for name in turns}
    known = {name: ~np.isnan(values) for name, values in angles.items()}
    few = min(rows.sum() for rows in known.values()) < 2
    if few or np.all(list(known.values()), axis=0).any():
        return table
    t = table.columns["t"].to_numpy(dtype=float)
    rarest = min(turns, key=lambda name: known[name].sum())
    at = t[known[rarest]]
    begin = max(t[rows].min() for rows in known.values())
    at = at[(at >= begin) & (at <= min(t[rows].max() for rows in known.values()))]
    columns: dict[str, pd.Series] = {"t": pd.Series(at)}
    for name, rows in known.items():
        _require_near(table, name, t[rows], at)
        own = _unwrapped(table, name, angles[name][rows], turns[name])
        columns[name] = pd.Series(np.interp(at, t[rows], own))
    note = (
        f"{table.path.name}: messages hold some of the legs each; they are joined at the "
        f"{len(at)} times of {rarest}, the other legs interpolated between their own readings"
    )
    return replace(table, columns=columns, notes=(*table.notes, note))


def _require_near(table: RawTable, name: str, t: Array, at: Array) -> None:
    """Check that no row falls into a gap of a leg's readings, or raise `DataError`.

    Args:
        table: The table, for the message.
        name: Header of the leg.
        t: Times of the leg's readings, which must increase, shape (m,) [s].
        at: Times of the rows, shape (n,) [s]; the two readings around each may be at most `WIDEST`
            median steps apart.
    """
    steps = np.diff(t)
    if np.any(steps <= 0):
        raise DataError(
            f"the stamps of {name} do not increase; expected its messages in the order of their "
            "stamps, each once: record them again",
            file=table.path,
        )
    later = np.clip(np.searchsorted(t, at), 1, len(t) - 1)
    wide = np.flatnonzero(steps[later - 1] > WIDEST * np.median(steps))
    if len(wide):
        begin = t[later[wide[0]] - 1]
        raise DataError(
            f"messages hold some of the legs each, and {name} has no reading for "
            f"{steps[later[wide[0]] - 1]:.3g} s, from {begin - t[0]:.3f} s after its first; "
            f"expected at most {WIDEST:g} times the usual {np.median(steps):.4g} s: cut the bag "
            "there, and use each part alone",
            file=table.path,
        )


def _unwrapped(table: RawTable, name: str, values: Array, turn: float) -> Array:
    """Unwrap a leg's angles: remove jumps by a turn, so that they can be interpolated.

    Args:
        table: The table, for the message.
        name: Header of the leg.
        values: Angles of its readings in order, shape (m,), in the unit of the column.
        turn: A whole turn in that unit.

    Raises:
        DataError: There are jumps of over half a turn to remove, and after that a step of over a
            quarter of a turn is left: it might as well be one in the other direction.
    """
    whole = np.unwrap(values, period=turn)
    wrapped = np.abs(np.diff(values)).max() > turn / 2
    if wrapped and np.abs(np.diff(whole)).max() > turn / 4:
        raise DataError(
            f"{name} turns by more than a quarter between two of its messages, or jumps by one "
            "turn; expected less where angles are wrapped, since its direction is ambiguous: check "
            "the unit of the angles, or publish them at a higher rate",
            file=table.path,
        )
    return whole


JOINT_STATE: Final = "sensor_msgs/msg/JointState"
DYNAMIC: Final = "control_msgs/msg/DynamicJointState"
"""Message of ros2_control, which names the interfaces of each joint."""
_ORDER = "front left, front right, middle left, middle right, rear left, rear right"
_WORDS: Final = {
    "front": "F", "fore": "F", "middle": "M", "mid": "M", "center": "M", "centre": "M",
    "rear": "R", "back": "R", "hind": "R",
}  # fmt: skip
_SIDES: Final = {"left": 0, "right": 1}
_ROWS: Final = {"F": 0, "M": 1, "C": 1, "R": 2, "B": 2, "H": 2}
_SHORT: Final = re.compile(r"([FMCRBH])([LR])|([LR])([FMCRBH])")


@dataclass(frozen=True)
class JointLog:
    """Joint states of a ROS log.

    Attributes:
        table: A row per message: `t`, its stamp, or log time without one [s], and the position of
            each joint [rad] by its name, NaN where missing.
        legs: Leg, 1 to 6, of each joint whose name states it, as by `legs_of_joints`.
        topic: Topic that was read.
    """

    table: RawTable
    legs: Mapping[str, int]
    topic: str

    @property
    def joints(self) -> tuple[str, ...]:
        """Names of all joints."""
        return tuple(name for name in self.table.columns if name not in ("t", *ANGLES))


def read_joint_log(
    path: Path, *, topic: str | None = None, topics: Collection[str] = ()
) -> JointLog:
    """Read the joint states of a ROS log as a table, without what is damaged.

    Topics that together hold the six legs, each on one topic, are read as one if none is chosen.

    Args:
        path: The log: MCAP or a bag.
        topic: Topic to read; None for one of `topics`, else the only one with joint positions.
        topics: Topics to prefer, also such of other messages.

    Raises:
        NotFound: The file does not exist, or the package that reads bags.
        DataError: No ROS log, no joint positions (on `topic`), or several topics and none chosen.
    """
    asked = {"what": "joint positions", "topic": topic, "topics": topics}
    types = (JOINT_STATE, DYNAMIC)
    joints: dict[str, set[str]] = {}
    try:
        found = read_topic(path, types, parts=partial(_with_positions, joints=joints), **asked)
    except SeveralTopics:
        legs = _a_topic_a_leg(joints)
        if not legs:
            raise
        found = read_topic(path, types, parts=partial(_with_positions, together=legs), **asked)
    with parsing(path, OTHER_FIELDS):
        rows = [dict(zip(state.name, state.position, strict=False)) for state in found.contents]
        table = RawTable(path, _columns(found.t, rows), notes=found.notes)
    return JointLog(table, legs_of_joints(table.columns), found.topic)


def joint_table(log: JointLog, columns: Columns) -> RawTable:
    """Return the table of a log in which every leg has a column, with a note on the joints' names.

    Messages that hold some of the legs each are joined to rows of all by `joined_readings`.

    Args:
        log: The log.
        columns: Column map; a header `thetaN` stands for the joint whose name states leg N.

    Raises:
        DataError: A leg has no joint; names the joints there are. Or as in `joined_readings`.
    """
    aliases: dict[str, pd.Series] = {
        f"theta{leg}": log.table.columns[name]
        for name, leg in log.legs.items()
        if f"theta{leg}" not in log.table.columns
    }
    table = replace(log.table, columns={**log.table.columns, **aliases})
    missing = [name for name in ANGLES if not columns.has(table, name)]
    if missing:
        raise DataError(
            f"has the joints {', '.join(log.joints)} on topic {log.topic}, and which of them is "
            f"leg {', '.join(name[-1] for name in missing)} is not to be told from their names; "
            f"name those of legs 1 to 6 ({_ORDER}) with --joints A,B,C,D,E,F, or in a columns.toml",
            file=log.table.path,
        )
    legs = [columns.mapped[name] for name in ANGLES]
    turns = {each.name: 2 * np.pi / factor_to_si(each.unit, "rad") for each in legs}
    table = joined_readings(_with_legs(table, turns), turns)
    told = {
        name: leg for name, leg in log.legs.items() if f"theta{leg}" in turns.keys() & set(aliases)
    }
    return replace(table, notes=(*table.notes, *_told(told)))


def _with_legs(table: RawTable, legs: Collection[str]) -> RawTable:
    """Return the rows with an angle of one of `legs`: others drive an arm or wheels; note them."""
    angles = np.column_stack([table.columns[name].to_numpy(dtype=float) for name in legs])
    kept = ~np.isnan(angles).all(axis=1)
    if kept.all():
        return table
    columns = {name: pd.Series(cells.to_numpy()[kept]) for name, cells in table.columns.items()}
    note = f"{table.path.name}: {int((~kept).sum())} of {len(angles)} messages have no leg's joint"
    return replace(table, columns=columns, notes=(*table.notes, f"{note}: skipped"))


def _a_topic_a_leg(joints: Mapping[str, Collection[str]]) -> frozenset[str]:
    """Return the topics that hold all legs together, each leg on one of them; empty if none do.

    Args:
        joints: Names of the joints on each topic.
    """
    legs = {topic: list(legs_of_joints(names).values()) for topic, names in joints.items()}
    listed = sorted(leg for each in legs.values() for leg in each)
    together = frozenset(topic for topic, each in legs.items() if each)
    return together if listed == [*range(1, N_LEGS + 1)] and len(together) > 1 else frozenset()


def _with_positions(
    message: LoggedMessage,
    *,
    joints: dict[str, set[str]] | None = None,
    together: frozenset[str] = frozenset(),
) -> Parts:
    """Yield topic, header and content (`name`, `position`) of a message that has positions.

    Args:
        message: The message.
        joints: Filled with the names of the joints on each topic.
        together: Topics whose messages count as those of one topic; others are left out.
    """
    content = message.content
    if message.type == DYNAMIC:
        content = _positions_of(content)
    if not len(content.position) or (together and message.topic not in together):
        return
    if joints is not None:
        joints.setdefault(message.topic, set()).update(content.name)
    name = ", ".join(sorted(together)) if together else message.topic
    yield name, message.content.header, content


def _positions_of(state: Any) -> SimpleNamespace:
    """Return names and positions of a `DynamicJointState`; joints without a position are left out.

    Each joint has a list of the interfaces that it offers, and a value of each.
    """
    found = {
        name: float(value)
        for name, values in zip(state.joint_names, state.interface_values, strict=False)
        for interface, value in zip(values.interface_names, values.values, strict=False)
        if interface == "position"
    }
    return SimpleNamespace(name=[*found], position=[*found.values()])


def _columns(
    t: Collection[float], rows: Collection[Mapping[str, float]]
) -> Mapping[str, pd.Series]:
    """Return a column of times and one for each joint, NaN where a message lacks the joint.

    A joint that is named `t` becomes "joint t".
    """
    columns = {"t": pd.Series(t, dtype=float)}
    for name in dict.fromkeys(name for row in rows for name in row):
        header = "joint t" if name == "t" else name
        columns[header] = pd.Series([row.get(name, np.nan) for row in rows], dtype=float)
    return columns


def _told(legs: Mapping[str, int]) -> tuple[str, ...]:
    """Return a note on which joint was taken for which leg; none if all are named `leg_N`."""
    if all(name == f"leg_{leg}" for name, leg in legs.items()):
        return ()
    listed = ", ".join(f"{leg} {name}" for name, leg in sorted(legs.items(), key=lambda x: x[1]))
    return (f"leg log: legs and their joints by name: {listed}",)


def legs_of_joints(names: Iterable[str]) -> dict[str, int]:
    """Return the leg of each joint whose name states it; none where two joints claim one leg.

    A name states a number from 1 to 6 after `leg` or `theta` (docs/conventions.md numbers the
    legs), or row and side in words or as in LF, FL: `leg_3`, `leg_front_left_joint`, `RM_hip`.

    Args:
        names: Names of the joints.

    >>> legs_of_joints(["leg_front_left_joint", "MR_hip", "gripper"])
    {'leg_front_left_joint': 1, 'MR_hip': 4}
    """
    told = {name: leg for name in names if (leg := _leg(name)) is not None}
    if len(set(told.values())) < len(told):
        return {}
    return told


def _leg(name: str) -> int | None:
    """Return the leg, 1 to 6, that a joint's name states by place, else by number; else None."""
    words = re.findall(r"[A-Z]+(?![a-z])|[A-Z]?[a-z]+|\d+", name)
    place = _place([word.lower() for word in words]) or _short_place(words)
    if place is not None:
        row, side = place
        return 2 * row + side + 1
    number = re.fullmatch(r"(?:.*_)?(?:leg|theta)_?([1-9]\d*)(?:_.*)?", name.lower())
    if number is None or not 1 <= int(number[1]) <= N_LEGS:
        return None
    return int(number[1])


def _place(words: list[str]) -> tuple[int, int] | None:
    """Return row (0 front to 2 rear) and side (0 left, 1 right) by words such as "front", "left".

    None unless the words, in lower case, tell one row and one side.
    """
    rows = {_ROWS[_WORDS[word]] for word in words if word in _WORDS}
    sides = {_SIDES[word] for word in words if word in _SIDES}
    return (rows.pop(), sides.pop()) if len(rows) == len(sides) == 1 else None


def _short_place(words: list[str]) -> tuple[int, int] | None:
    """Return row and side, as `_place`, by one word of two letters such as LF or RM; else None."""
    found = [match for word in words if (match := _SHORT.fullmatch(word.upper()))]
    if len(found) != 1:
        return None
    row, side, other_side, other_row = found[0].groups()
    return _ROWS[row or other_row], "LR".index(side or other_side)
