# SPDX-License-Identifier: MIT
"""Encode ROS 2 messages of poses: transforms, paths, and poses with their covariance.

Stamps are nanoseconds since the Unix epoch, lengths metres, quaternions x, y, z, w.
"""

from collections.abc import Iterable, Sequence
from dataclasses import dataclass

import numpy as np

from model.arrays import Array
from zebro_lab.mcap.cdr import CdrWriter
from zebro_lab.mcap.ros_messages import HEADER, QUATERNION, RULE, VECTOR, Schema

_POSE = f"""\
{RULE}
MSG: geometry_msgs/Pose
geometry_msgs/Point position  # [m]
geometry_msgs/Quaternion orientation
{RULE}
MSG: geometry_msgs/Point
float64 x
float64 y
float64 z
"""
TRANSFORMS = Schema(
    "tf2_msgs/msg/TFMessage",
    f"""\
geometry_msgs/TransformStamped[] transforms
{RULE}
MSG: geometry_msgs/TransformStamped
std_msgs/Header header
string child_frame_id
geometry_msgs/Transform transform
{RULE}
MSG: geometry_msgs/Transform
geometry_msgs/Vector3 translation  # [m]
geometry_msgs/Quaternion rotation
"""
    + VECTOR
    + QUATERNION
    + HEADER,
)
PATH = Schema(
    "nav_msgs/msg/Path",
    f"""\
std_msgs/Header header
geometry_msgs/PoseStamped[] poses
{RULE}
MSG: geometry_msgs/PoseStamped
std_msgs/Header header
geometry_msgs/Pose pose
"""
    + _POSE
    + QUATERNION
    + HEADER,
)
POSE = Schema(
    "geometry_msgs/msg/PoseWithCovarianceStamped",
    f"""\
std_msgs/Header header
geometry_msgs/PoseWithCovariance pose
{RULE}
MSG: geometry_msgs/PoseWithCovariance
geometry_msgs/Pose pose
float64[36] covariance  # x, y, z [m], about x, y, z [rad], by rows
"""
    + _POSE
    + QUATERNION
    + HEADER,
)


@dataclass(frozen=True)
class Transform:
    """Pose of a frame in its parent frame.

    Attributes:
        parent: Name of the parent frame.
        child: Name of the frame.
        position: Origin of the frame in the parent frame, x, y, z, shape (3,) [m].
        quaternion: Orientation of the frame in the parent frame, x, y, z, w, shape (4,).
    """

    parent: str
    child: str
    position: Sequence[float]
    quaternion: Sequence[float]


def transforms(stamp: int, frames: Iterable[Transform]) -> bytes:
    """Encode the transforms of frames at one instant as a `tf2_msgs/TFMessage` in CDR.

    Args:
        stamp: Time since the Unix epoch [ns].
        frames: Transform of each frame to its parent.
    """
    listed = list(frames)
    message = CdrWriter().uint32(len(listed))
    for each in listed:
        message.time(stamp).text(each.parent).text(each.child)
        message.float64(*each.position, *each.quaternion)
    return message.message()


def path(stamps: Sequence[int], frame: str, positions: Array, quaternions: Array) -> bytes:
    """Encode a path as a `nav_msgs/Path` in CDR, stamped with the time of its first pose.

    Args:
        stamps: Time of each pose since the Unix epoch, at least one, shape (n,) [ns].
        frame: Name of the frame of the poses.
        positions: Positions x, y, z, shape (n, 3) [m].
        quaternions: Orientations, x, y, z, w, shape (n, 4).
    """
    message = CdrWriter().time(stamps[0]).text(frame).uint32(len(stamps))
    for stamp, position, quaternion in zip(stamps, positions, quaternions, strict=True):
        message.time(stamp).text(frame).float64(*position, *quaternion)
    return message.message()


def pose_with_covariance(
    stamp: int, frame: str, *, position: Array, quaternion: Array, covariance: Array
) -> bytes:
    """Encode a planar pose as a `geometry_msgs/PoseWithCovarianceStamped` in CDR.

    Args:
        stamp: Time since the Unix epoch [ns].
        frame: Name of the frame of the pose.
        position: Position x, y, z, shape (3,) [m].
        quaternion: Orientation, x, y, z, w, shape (4,).
        covariance: Covariance of x, y [m] and yaw [rad], shape (3, 3); z, roll and pitch get zeros.
    """
    whole = np.zeros((6, 6))
    whole[np.ix_((0, 1, 5), (0, 1, 5))] = covariance
    message = CdrWriter().time(stamp).text(frame)
    return message.float64(*position, *quaternion, *whole.ravel()).message()
