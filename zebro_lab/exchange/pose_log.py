# SPDX-License-Identifier: MIT
"""Read the robot's path from poses in a ROS log: odometry, stamped poses, transforms."""

from collections.abc import Collection, Sequence
from pathlib import Path
from typing import Any, Final

import numpy as np

from model.slip.law import Array
from zebro_lab.exchange.topic_table import TopicTable
from zebro_lab.files.errors import DataError
from zebro_lab.files.opening import parsing
from zebro_lab.mcap.log_topics import OTHER_FIELDS, Parts, TopicRows, read_topic
from zebro_lab.mcap.logged_message import LoggedMessage
from zebro_lab.mcap.ros_poses import POSE, TRANSFORMS

ODOMETRY: Final = "nav_msgs/msg/Odometry"
STAMPED: Final = "geometry_msgs/msg/PoseStamped"
TRANSFORM: Final = "geometry_msgs/msg/TransformStamped"
_NORM_TOLERANCE: Final = 0.05
POSE_TYPES: Final = (ODOMETRY, STAMPED, POSE.name, TRANSFORM, TRANSFORMS.name)
_PLANAR: Final = {
    "cov_xx": 0, "cov_xy": 1, "cov_xyaw": 5, "cov_yy": 7, "cov_yyaw": 11, "cov_yawyaw": 35,
}  # fmt: skip
"""Index of each planar element among the 36 of a pose's covariance, by rows."""


def read_pose_log(
    path: Path, *, topic: str | None = None, topics: Collection[str] = ()
) -> TopicTable:
    """Read poses of a ROS log as the columns of a track, up to the first damage.

    Args:
        path: The log: MCAP or a bag.
        topic: Topic to read, that of a transform with its child frame, such as `/tf:base_link`;
            None for one of `topics`, else the only one with poses.
        topics: Topics to prefer, also such of other messages.

    Returns:
        `t_s` [s], `x_m`, `y_m`, `z_m` [m]; `yaw_rad` [rad], unwrapped, unless all quaternions are
        zeros, and the planar covariance where the messages have one that is not zero; the topic.

    Raises:
        NotFound: The log does not exist, or the package that reads it.
        DataError: It cannot be read, has no poses (on `topic`), or several topics and none chosen,
            or a quaternion's length is not 1 within 0.05.
    """
    found = read_topic(path, POSE_TYPES, what="poses", topic=topic, topics=topics, parts=_poses)
    with parsing(path, OTHER_FIELDS):
        place, turn = zip(*(_pose(found.type, each) for each in found.contents), strict=True)
        position = np.array([(p.x, p.y, p.z) for p in place], dtype=float)
        quaternion = np.array([(q.x, q.y, q.z, q.w) for q in turn], dtype=float)
        covariances = _covariances(found)
    columns = {"t_s": np.array(found.t), "x_m": position[:, 0], "y_m": position[:, 1],
               "z_m": position[:, 2]}  # fmt: skip
    if quaternion.any():  # zeros throughout: the publisher knows no orientation
        columns["yaw_rad"] = _yaw(path, found.topic, quaternion)
        columns |= covariances
    return TopicTable.of(path, columns, found)


def _poses(message: LoggedMessage) -> Parts:
    if message.type == TRANSFORMS.name:
        for each in message.content.transforms:
            yield f"{message.topic}:{each.child_frame_id}", each.header, each.transform
    else:
        yield message.topic, message.content.header, message.content


def _pose(kind: str, content: Any) -> tuple[Any, Any]:
    """Return position and quaternion of a message's content."""
    if kind in (TRANSFORM, TRANSFORMS.name):
        moved = content.transform if kind == TRANSFORM else content
        return moved.translation, moved.rotation
    pose = content.pose if kind == STAMPED else content.pose.pose
    return pose.position, pose.orientation


def _yaw(path: Path, topic: str, quaternion: Array) -> Array:
    """Return the unwrapped yaw of quaternions x, y, z, w, shape (n, 4), in (n,) [rad]."""
    norm = np.linalg.norm(np.clip(quaternion, -2, 2), axis=1)  # clipped, as damage may be huge
    good = np.abs(norm - 1) <= _NORM_TOLERANCE
    if not good.all():
        row = int(np.argmin(good))
        raise DataError(
            f"the quaternion of message {row + 1} on topic {topic} has length {norm[row]:.3g}; "
            f"expected 1 within {_NORM_TOLERANCE}: choose another topic, or leave the message out",
            file=path,
        )
    qx, qy, qz, qw = quaternion.T
    return np.unwrap(np.arctan2(2 * (qw * qz + qx * qy), 1 - 2 * (qy**2 + qz**2)))


def _covariances(found: TopicRows) -> dict[str, Array]:
    if found.type not in (ODOMETRY, POSE.name):
        return {}
    every: Sequence[Any] = [each.pose.covariance for each in found.contents]
    covariance = np.array(every, dtype=float).reshape(len(every), 36)
    if not covariance.any() or not np.isfinite(covariance).all():  # ROS: zeros are unknown
        return {}
    return {name: covariance[:, index] for name, index in _PLANAR.items()}
