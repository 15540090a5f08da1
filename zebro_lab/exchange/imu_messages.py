# SPDX-License-Identifier: MIT
"""Read the body's orientation from IMU messages in a ROS log."""

from collections.abc import Collection
from dataclasses import dataclass
from pathlib import Path
from typing import Any, Final

import numpy as np
import pandas as pd

from model.arrays import Array
from zebro_lab.files.errors import DataError
from zebro_lab.files.opening import parsing
from zebro_lab.mcap.log_topics import OTHER_FIELDS, TopicRows, read_topic
from zebro_lab.tables.raw_table import RawTable

IMU: Final = "sensor_msgs/msg/Imu"
_VECTORS: Final = {"angular_velocity": "rate", "linear_acceleration": "force"}


@dataclass(frozen=True)
class TopicTable:
    """Messages of one topic of a ROS log as a table.

    Attributes:
        table: A row per message, in SI.
        topic: The topic that was read.
    """

    table: RawTable
    topic: str


def read_imu_messages(
    path: Path, *, topic: str | None = None, topics: Collection[str] = ()
) -> TopicTable:
    """Read IMU messages of a ROS log as the columns of an IMU table, up to the first damage.

    Args:
        path: The log: MCAP or a bag.
        topic: Topic to read; None for one of `topics`, else the only one with IMU messages.
        topics: Topics to prefer, also such of other messages.

    Returns:
        `t` [s], the quaternion `qw` to `qz` [-], and where they are measured `rate_x` … [rad/s] and
        `force_x` … [m/s2]; and the topic.

    Raises:
        NotFound: The log does not exist, or the package that reads it.
        DataError: It cannot be read, has no such messages, or several topics and none is chosen, or
            the messages mark the orientation as not measured.
    """
    found = read_topic(path, (IMU,), what="IMU messages", topic=topic, topics=topics)
    with parsing(path, OTHER_FIELDS):
        columns = _columns(found)
    if columns is None:
        raise DataError(
            f"has no orientation on topic {found.topic}: the first element of its covariance is "
            "-1; expected the orientation of the body: choose the topic of a filter that estimates "
            "it, such as imu_filter_madgwick",
            file=path,
        )
    series = {name: pd.Series(values) for name, values in columns.items()}
    told = f"{path.name}: {found.told}"
    return TopicTable(RawTable(path, series, notes=(told, *found.notes)), found.topic)


def _columns(found: TopicRows) -> dict[str, Array] | None:
    """Return the columns of an IMU table; None without orientation."""
    if any(_absent(each, "orientation") for each in found.contents):
        return None
    columns: dict[str, Array] = {"t": np.array(found.t)}
    for axis in "wxyz":
        columns[f"q{axis}"] = np.array([getattr(m.orientation, axis) for m in found.contents])
    for field, name in _VECTORS.items():
        if not any(_absent(each, field) for each in found.contents):
            for axis in "xyz":
                values = [getattr(getattr(m, field), axis) for m in found.contents]
                columns[f"{name}_{axis}"] = np.array(values)
    return columns


def _absent(message: Any, field: str) -> bool:
    return getattr(message, f"{field}_covariance")[0] == -1
