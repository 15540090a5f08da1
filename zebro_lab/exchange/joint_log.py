# SPDX-License-Identifier: MIT
"""Read joint angles from a ROS 2 log in MCAP to a table."""

from pathlib import Path
from typing import Any, Final

import numpy as np

from rig.nearest_name import nearest
from zebro_lab.files.errors import DataError
from zebro_lab.mcap.ros_log import read_messages
from zebro_lab.mcap.ros_messages import JOINT_STATE
from zebro_lab.tables.raw_table import RawTable

NANOSECOND: Final = 1e-9


def read_joint_log(path: Path, *, topic: str | None = None) -> RawTable:
    """Read the joint states of an MCAP log as a table, up to the first damage.

    Args:
        path: The log.
        topic: Topic to read; None for the only topic that has joint positions.

    Returns:
        A row per message with positions: `t`, its stamp, or log time without one [s], and the
        position of each joint [rad], NaN where missing. The column of joint `leg_N` is `thetaN`.

    Raises:
        NotFound: The file does not exist.
        DataError: Not MCAP, no joint positions (on `topic`), or several topics and no `topic`.
    """
    messages, damage = read_messages(path, schema=JOINT_STATE.name)
    rows: dict[str, list[tuple[float, dict[str, float]]]] = {}
    for topic_found, log_time, state in messages:
        stamp = state.header.stamp.sec + NANOSECOND * state.header.stamp.nanosec
        joints = dict(zip(state.name, state.position, strict=False))  # may be empty
        if joints:
            rows.setdefault(topic_found, []).append((stamp or NANOSECOND * log_time, joints))
    chosen = _chosen(rows, topic, path)
    notes = () if damage is None else (f"{path.name} is incomplete ({damage})",)
    return _table(path, rows[chosen], notes)


def _chosen(rows: dict[str, Any], topic: str | None, path: Path) -> str:
    if topic is not None and topic not in rows:
        raise DataError(
            f"has no joint positions on topic {topic}; {nearest(topic, rows)}", file=path
        )
    if not rows:
        raise DataError(
            f"holds no joint positions; expected the leg angles in ROS 2 messages of type "
            f"{JOINT_STATE.name}",
            file=path,
        )
    if topic is None and len(rows) > 1:
        raise DataError(
            f"has joint states of the topics {', '.join(sorted(rows))}; choose one with "
            'topic = "..." in section [legs] of a columns.toml',
            file=path,
        )
    return topic or next(iter(rows))


def _table(
    path: Path, rows: list[tuple[float, dict[str, float]]], notes: tuple[str, ...]
) -> RawTable:
    import pandas as pd

    names = dict.fromkeys(name for _, joints in rows for name in joints)
    columns = {"t": pd.Series([stamp for stamp, _ in rows], dtype=float)}
    for name in names:
        positions = [joints.get(name, np.nan) for _, joints in rows]
        columns[_called(name)] = pd.Series(positions, dtype=float)
    return RawTable(path, columns, notes=notes)


def _called(joint: str) -> str:
    leg = joint.removeprefix("leg_")
    return f"theta{leg}" if joint.startswith("leg_") and leg.isdigit() else joint
