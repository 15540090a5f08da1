# SPDX-License-Identifier: MIT
"""Read poses from a ROS log as a table: odometry, stamped poses, transforms."""

from collections.abc import Collection
from dataclasses import dataclass
from pathlib import Path
from typing import Any, Final

import numpy as np
import pandas as pd

from model.arrays import Array
from zebro_lab.files.opening import parsing
from zebro_lab.mcap.log_topics import OTHER_FIELDS, Parts, TopicRows, read_topic
from zebro_lab.mcap.ros_log import LoggedMessage
from zebro_lab.tables.raw_table import RawTable

ODOMETRY: Final = "nav_msgs/msg/Odometry"
STAMPED: Final = "geometry_msgs/msg/PoseStamped"
POSE: Final = "geometry_msgs/msg/PoseWithCovarianceStamped"
TRANSFORM: Final = "geometry_msgs/msg/TransformStamped"
TRANSFORMS: Final = "tf2_msgs/msg/TFMessage"
POSE_TYPES: Final = (ODOMETRY, STAMPED, POSE, TRANSFORM, TRANSFORMS)
_STATIC: Final = "tf_static"  # topic of transforms that never change


@dataclass(frozen=True)
class LoggedPoses:
    """Poses of one topic of a ROS log.

    Attributes:
        topic: The topic.
        table: Columns t_s, x_m, y_m, z_m and, unless all are zeros, which a publisher that knows no
            orientation writes, qx, qy, qz, qw; a row for each message.
        covariance: Covariances of x, y, z and the rotations about them, shape (n, 6, 6), by rows
            [m, rad]; None where the messages have none, or zeros.
    """

    topic: str
    table: RawTable
    covariance: Array | None


def read_logged_poses(
    path: Path, *, topic: str | None = None, topics: Collection[str] = ()
) -> LoggedPoses:
    """Read poses of a ROS log, up to the first damage.

    Static transforms are left out: they hold the mounting of sensors, and no path.

    Args:
        path: The log: MCAP or a bag.
        topic: Topic to read, that of a transform with its child frame, such as `/tf:base_link`;
            None for one of `topics`, else the only one with poses.
        topics: Topics to prefer, also such of other messages.

    Raises:
        NotFound: The log does not exist, or the package that reads it.
        DataError: It cannot be read, has no poses (on `topic`), or several topics and none chosen.
    """
    found = read_topic(path, POSE_TYPES, what="poses", topic=topic, topics=topics, parts=_parts)
    with parsing(path, OTHER_FIELDS):
        values = np.array([_pose(found.type, each) for each in found.contents], dtype=float)
        covariance = _covariance(found)
    names = ("x_m", "y_m", "z_m", *(("qx", "qy", "qz", "qw") if values[:, 3:].any() else ()))
    poses = dict(zip(names, values.T, strict=False))
    columns = {name: pd.Series(each) for name, each in {"t_s": found.t, **poses}.items()}
    table = RawTable(path, columns, units={"t_s": "s"}, notes=(found.told, *found.notes))
    return LoggedPoses(found.topic, table, covariance)


def _parts(message: LoggedMessage) -> Parts:
    if message.type != TRANSFORMS:
        yield message.topic, message.content.header, message.content
    elif not message.topic.endswith(_STATIC):
        for each in message.content.transforms:
            yield f"{message.topic}:{each.child_frame_id}", each.header, each.transform


def _pose(kind: str, content: Any) -> tuple[float, ...]:
    """Return position x, y, z and quaternion x, y, z, w of a message's content."""
    if kind in (TRANSFORM, TRANSFORMS):
        moved = content.transform if kind == TRANSFORM else content
        p, q = moved.translation, moved.rotation
    else:
        pose = content.pose if kind == STAMPED else content.pose.pose
        p, q = pose.position, pose.orientation
    return p.x, p.y, p.z, q.x, q.y, q.z, q.w


def _covariance(found: TopicRows) -> Array | None:
    if found.type not in (ODOMETRY, POSE):
        return None
    covariance = np.array([each.pose.covariance for each in found.contents], dtype=float)
    known = covariance.any() and np.isfinite(covariance).all()  # ROS: zeros are unknown
    return covariance.reshape(-1, 6, 6) if known else None
