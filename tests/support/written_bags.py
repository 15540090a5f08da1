# SPDX-License-Identifier: MIT
"""ROS bags written by the package rosbags, as another robot's recorder would leave them."""

from collections.abc import Iterable, Mapping, Sequence
from dataclasses import replace
from pathlib import Path
from typing import Any

import numpy as np
import pytest

rosbags = pytest.importorskip("rosbags.rosbag2")

BEGAN = 1_700_000_000.0
"""Unix time of time 0 [s]."""
PLACES = ("front_left", "front_right", "middle_left", "middle_right", "rear_left", "rear_right")
JOINTS = tuple(f"leg_{place}_joint" for place in PLACES)
Message = tuple[str, float, str, Any]
"""Topic, time [s], type and content."""


def store() -> Any:
    from rosbags.typesys import Stores, get_typestore

    return get_typestore(Stores.ROS2_HUMBLE)


STORE = store()


def made(kind: str, **fields: Any) -> Any:
    return STORE.types[kind](**fields)


def header(t: float, frame: str = "") -> Any:
    sec, rest = divmod(round(1e9 * (BEGAN + t)), 10**9)
    stamp = made("builtin_interfaces/msg/Time", sec=sec, nanosec=rest)
    return made("std_msgs/msg/Header", stamp=stamp, frame_id=frame)


def joints(
    t: Sequence[float], theta: np.ndarray, *, names: Sequence[str] = JOINTS,
    topic: str = "/joint_states",
) -> Iterable[Message]:  # fmt: skip
    """Yield joint states; `theta` has a column for each of `names`, shape (n, joints) [rad]."""
    empty = np.zeros(0)
    kind = "sensor_msgs/msg/JointState"
    for at, row in zip(t, theta, strict=True):
        yield topic, at, kind, made(
            kind, header=header(at), name=list(names), position=np.ascontiguousarray(row),
            velocity=empty, effort=empty,
        )  # fmt: skip


def pose(x: float, y: float, yaw: float) -> Any:
    """Return a pose; a yaw that is NaN gives a quaternion of zeros."""
    point = made("geometry_msgs/msg/Point", x=x, y=y, z=0.06)
    z, w = (np.sin(yaw / 2), np.cos(yaw / 2)) if np.isfinite(yaw) else (0.0, 0.0)
    turn = made("geometry_msgs/msg/Quaternion", x=0.0, y=0.0, z=z, w=w)
    return made("geometry_msgs/msg/Pose", position=point, orientation=turn)


def vector(x: float = 0.0, y: float = 0.0, z: float = 0.0) -> Any:
    return made("geometry_msgs/msg/Vector3", x=x, y=y, z=z)


def odometry(
    t: Sequence[float], path: np.ndarray, *, covariance: np.ndarray | None = None,
    topic: str = "/odom",
) -> Iterable[Message]:  # fmt: skip
    """Yield odometry of x [m], y [m], yaw [rad], shape (n, 3)."""
    none = np.zeros(36)
    spread = none if covariance is None else covariance.ravel()
    kind = "nav_msgs/msg/Odometry"
    twist = made("geometry_msgs/msg/Twist", linear=vector(), angular=vector())
    for at, row in zip(t, path, strict=True):
        yield topic, at, kind, made(
            kind, header=header(at, "odom"), child_frame_id="base_link",
            pose=made("geometry_msgs/msg/PoseWithCovariance", pose=pose(*row), covariance=spread),
            twist=made("geometry_msgs/msg/TwistWithCovariance", twist=twist, covariance=none),
        )  # fmt: skip


def stamped(t: Sequence[float], path: np.ndarray, *, topic: str = "/pose") -> Iterable[Message]:
    kind = "geometry_msgs/msg/PoseStamped"
    for at, row in zip(t, path, strict=True):
        yield topic, at, kind, made(kind, header=header(at, "map"), pose=pose(*row))


def transforms(
    t: Sequence[float], paths: Mapping[str, np.ndarray], *, topic: str = "/tf"
) -> Iterable[Message]:
    """Yield transforms of several child frames."""
    for i, at in enumerate(t):
        frames = []
        for child, path in paths.items():
            placed = pose(*path[i])
            moved = made("geometry_msgs/msg/Transform", translation=vector(*path[i, :2]),
                         rotation=placed.orientation)  # fmt: skip
            frames.append(made("geometry_msgs/msg/TransformStamped", header=header(at, "map"),
                               child_frame_id=child, transform=moved))  # fmt: skip
        yield topic, at, "tf2_msgs/msg/TFMessage", made("tf2_msgs/msg/TFMessage", transforms=frames)


def imu(t: Sequence[float], *, absent: Sequence[str] = ()) -> Iterable[Message]:
    """Yield a level IMU that turns at 0.1 rad/s; `absent` fields are marked as not measured."""
    kind = "sensor_msgs/msg/Imu"
    marked = np.array([-1.0, *np.zeros(8)])
    spread = {f"{name}_covariance": marked if name in absent else np.zeros(9)
              for name in ("orientation", "angular_velocity", "linear_acceleration")}  # fmt: skip
    for at in t:
        yield "/imu", at, kind, made(
            kind, header=header(at, "imu"), orientation=pose(0.0, 0.0, 0.1 * at).orientation,
            angular_velocity=vector(z=0.1), linear_acceleration=vector(z=9.81), **spread,
        )  # fmt: skip


def write_bag(folder: Path, *parts: Iterable[Message], storage: str = "sqlite3") -> Path:
    """Write messages as a ROS 2 bag, a folder, in the order of their times."""
    from rosbags.rosbag2 import StoragePlugin, Writer

    with Writer(folder, version=9, storage_plugin=StoragePlugin[storage.upper()]) as writer:
        _write(writer, parts, lambda content, kind: STORE.serialize_cdr(content, kind), STORE)
    return folder


def write_ros1_bag(file: Path, *parts: Iterable[Message]) -> Path:
    """Write messages as a ROS 1 bag, a file."""
    from rosbags.rosbag1 import Writer
    from rosbags.typesys import Stores, get_typestore

    one = get_typestore(Stores.ROS1_NOETIC)
    head = one.types["std_msgs/msg/Header"]

    def encoded(content: Any, kind: str) -> Any:
        seen = content.header
        numbered = head(seq=0, stamp=seen.stamp, frame_id=seen.frame_id)
        return one.serialize_ros1(replace(content, header=numbered), kind)

    with Writer(file) as writer:
        _write(writer, parts, encoded, one)
    return file


def _write(writer: Any, parts: Sequence[Iterable[Message]], encoded: Any, types: Any) -> None:
    connections: dict[str, Any] = {}
    messages = sorted((m for part in parts for m in part), key=lambda message: message[1])
    for topic, at, kind, content in messages:
        if topic not in connections:
            connections[topic] = writer.add_connection(topic, kind, typestore=types)
        writer.write(connections[topic], round(1e9 * (BEGAN + at)), encoded(content, kind))
