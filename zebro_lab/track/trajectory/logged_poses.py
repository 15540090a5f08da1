# SPDX-License-Identifier: MIT
"""Read poses from a ROS log as a table: odometry, stamped poses, transforms."""

from collections.abc import Collection
from pathlib import Path
from typing import Any, Final

import numpy as np
import pandas as pd

from model.arrays import Array
from model.rigid_path import plane_axes
from zebro_lab.files.opening import parsing
from zebro_lab.mcap.log_records import LoggedMessage
from zebro_lab.mcap.log_topics import OTHER_FIELDS, Parts, TopicRows, read_topic
from zebro_lab.tables.raw_table import RawTable
from zebro_lab.track.trajectory.table import COVARIANCE, QUATERNION

TRANSFORMS: Final = "tf2_msgs/msg/TFMessage"
_POSES: Final = {
    "nav_msgs/msg/Odometry": "pose.pose",
    "geometry_msgs/msg/PoseStamped": "pose",
    "geometry_msgs/msg/PoseWithCovarianceStamped": "pose.pose",
    "geometry_msgs/msg/TransformStamped": "transform",
    TRANSFORMS: "transform",  # of each of its parts
}
"""Field of each type of message that holds the pose."""
_STATIC: Final = "tf_static"  # topic of transforms that never change


def read_logged_poses(
    path: Path, *, plane: str, topic: str | None = None, topics: Collection[str] = ()
) -> tuple[str, RawTable]:
    """Read poses of a ROS log, without what is damaged.

    Static transforms are left out: they hold the mounting of sensors, and no path.

    Args:
        path: The log: MCAP or a bag.
        plane: Axes of the floor, in which a covariance is read.
        topic: Topic to read, that of a transform with its child frame, such as `/tf:base_link`;
            None for one of `topics`, else the only one with poses.
        topics: Topics to prefer; those without poses are ignored.

    Returns:
        The topic; and columns t_s, x_m, y_m, z_m and, unless all are zeros, which a publisher that
        knows no orientation writes, qx, qy, qz, qw and, if it is known, the covariance, `cov_xx` …,
        a row for each message.

    Raises:
        NotFound: The log does not exist, or the package that reads it.
        DataError: It cannot be read, has no poses (on `topic`), or several topics and none chosen.
    """
    found = read_topic(path, [*_POSES], what="poses", topic=topic, topics=topics, parts=_parts)
    with parsing(path, OTHER_FIELDS):
        values = np.array([_pose(found.type, each) for each in found.contents], dtype=float)
        covariance = _planar_covariance(found, plane)
    columns = {"t_s": np.array(found.t), **dict(zip(("x_m", "y_m", "z_m"), values.T, strict=False))}
    if values[:, 3:].any():
        columns |= {**dict(zip(QUATERNION, values.T[3:], strict=True)), **covariance}
    series = {name: pd.Series(each) for name, each in columns.items()}
    return found.topic, RawTable(path, series, units={"t_s": "s"}, notes=(found.told, *found.notes))


def _parts(message: LoggedMessage) -> Parts:
    """Yield topic, header and content of each pose of a message; skip static transforms.

    A transform's topic is completed by its child frame, as in `/tf:base_link`.
    """
    if message.type != TRANSFORMS:
        yield message.topic, message.content.header, message.content
    elif not message.topic.endswith(_STATIC):
        for each in message.content.transforms:
            yield f"{message.topic}:{each.child_frame_id}", each.header, each


def _pose(kind: str, content: Any) -> tuple[float, ...]:
    """Return position x, y, z and quaternion x, y, z, w of a message's content."""
    for field in _POSES[kind].split("."):
        content = getattr(content, field)
    moved = _POSES[kind] == "transform"
    p, q = (content.translation, content.rotation) if moved else (
        content.position, content.orientation)  # fmt: skip
    return p.x, p.y, p.z, q.x, q.y, q.z, q.w


def _planar_covariance(found: TopicRows, plane: str) -> dict[str, Array]:
    """Return the covariance of position in a plane and heading about its normal, by column name.

    The columns are `cov_xx` to `cov_yawyaw`, shape (n,) each [m², m rad, rad²]. Empty if messages
    have no covariance, only zeros, or any number that is not finite.
    """
    if _POSES[found.type] != "pose.pose":
        return {}
    covariance = np.array([each.pose.covariance for each in found.contents], dtype=float)
    if not (covariance.any() and np.isfinite(covariance).all()):  # ROS: zeros are unknown
        return {}
    chosen = np.zeros((3, 6))
    chosen[[0, 1], plane_axes(plane)] = 1.0
    first, second = np.eye(3)[list(plane_axes(plane))]
    chosen[2, 3:] = np.cross(first, second)  # the heading turns about the plane's normal
    planar = chosen @ covariance.reshape(-1, 6, 6) @ chosen.T
    upper = zip(*np.triu_indices(3), strict=True)
    return {name: planar[:, i, j] for name, (i, j) in zip(COVARIANCE, upper, strict=True)}
