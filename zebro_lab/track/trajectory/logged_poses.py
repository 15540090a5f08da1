# SPDX-License-Identifier: MIT
"""Read poses from a ROS log: odometry, stamped poses, transforms."""

from collections.abc import Collection
from dataclasses import dataclass
from pathlib import Path
from typing import Any, Final

import numpy as np

from model.arrays import Array
from zebro_lab.files.errors import DataError
from zebro_lab.files.opening import parsing
from zebro_lab.mcap.log_topics import OTHER_FIELDS, Parts, TopicRows, read_topic
from zebro_lab.mcap.logged_message import LoggedMessage
from zebro_lab.mcap.ros_poses import POSE, TRANSFORMS

ODOMETRY: Final = "nav_msgs/msg/Odometry"
STAMPED: Final = "geometry_msgs/msg/PoseStamped"
TRANSFORM: Final = "geometry_msgs/msg/TransformStamped"
POSE_TYPES: Final = (ODOMETRY, STAMPED, POSE.name, TRANSFORM, TRANSFORMS.name)
_STATIC: Final = "tf_static"  # topic of transforms that never change
_NORM_TOLERANCE: Final = 0.05


@dataclass(frozen=True)
class LoggedPoses:
    """Poses of one topic of a ROS log.

    Attributes:
        rows: The messages.
        position: Positions, shape (n, 3) [m].
        quaternion: Quaternions x, y, z, w, shape (n, 4); None if all are zeros, which a publisher
            that knows no orientation writes.
        covariance: Covariances of x, y, z and the rotations about them, shape (n, 36), by rows;
            None where the messages have none, or zeros.
    """

    rows: TopicRows
    position: Array
    quaternion: Array | None
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
        DataError: It cannot be read, has no poses (on `topic`), or several topics and none chosen,
            or a quaternion's length is not 1 within 0.05.
    """
    found = read_topic(path, POSE_TYPES, what="poses", topic=topic, topics=topics, parts=_parts)
    with parsing(path, OTHER_FIELDS):
        place, turn = zip(*(_pose(found.type, each) for each in found.contents), strict=True)
        position = np.array([(p.x, p.y, p.z) for p in place], dtype=float)
        quaternion = np.array([(q.x, q.y, q.z, q.w) for q in turn], dtype=float)
        covariance = _covariance(found)
    if not quaternion.any():
        return LoggedPoses(found, position, None, covariance)
    _require_unit(path, found.topic, quaternion)
    return LoggedPoses(found, position, quaternion, covariance)


def _parts(message: LoggedMessage) -> Parts:
    if message.type != TRANSFORMS.name:
        yield message.topic, message.content.header, message.content
    elif not message.topic.endswith(_STATIC):
        for each in message.content.transforms:
            yield f"{message.topic}:{each.child_frame_id}", each.header, each.transform


def _pose(kind: str, content: Any) -> tuple[Any, Any]:
    """Return position and quaternion of a message's content."""
    if kind in (TRANSFORM, TRANSFORMS.name):
        moved = content.transform if kind == TRANSFORM else content
        return moved.translation, moved.rotation
    pose = content.pose if kind == STAMPED else content.pose.pose
    return pose.position, pose.orientation


def _require_unit(path: Path, topic: str, quaternion: Array) -> None:
    """Raise `DataError` unless each quaternion, shape (n, 4), has a length near 1."""
    norm = np.linalg.norm(np.clip(quaternion, -2, 2), axis=1)  # clipped, as damage may be huge
    good = np.abs(norm - 1) <= _NORM_TOLERANCE
    if not good.all():
        row = int(np.argmin(good))
        raise DataError(
            f"the quaternion of message {row + 1} on topic {topic} has length {norm[row]:.3g}; "
            f"expected 1 within {_NORM_TOLERANCE}: choose another topic, or leave the message out",
            file=path,
        )


def _covariance(found: TopicRows) -> Array | None:
    if found.type not in (ODOMETRY, POSE.name):
        return None
    covariance = np.array([each.pose.covariance for each in found.contents], dtype=float)
    covariance = covariance.reshape(len(found.contents), 36)
    known = covariance.any() and np.isfinite(covariance).all()  # ROS: zeros are unknown
    return covariance if known else None
