# SPDX-License-Identifier: MIT
"""Encode the standard ROS 2 messages that recorded runs contain besides raw counts, for viewers.

Stamps are nanoseconds since the Unix epoch; numbers are SI. As in ROS, quantities that a device
does not measure are NaN, or empty where they are a list; unknown covariances are zeros, and the
first element of a covariance is -1 where its quantity is not measured.
"""

import math
from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np

from zebro_lab.mcap.cdr import CdrWriter

RULE = "=" * 80
"""Separator between the definitions of nested message types."""
HEADER = f"""\
{RULE}
MSG: std_msgs/Header
builtin_interfaces/Time stamp
string frame_id
{RULE}
MSG: builtin_interfaces/Time
int32 sec
uint32 nanosec
"""
VECTOR = f"""\
{RULE}
MSG: geometry_msgs/Vector3
float64 x
float64 y
float64 z
"""
QUATERNION = f"""\
{RULE}
MSG: geometry_msgs/Quaternion
float64 x
float64 y
float64 z
float64 w
"""


@dataclass(frozen=True)
class Schema:
    """ROS 2 message type.

    Attributes:
        name: Name of the type, such as `sensor_msgs/msg/Imu`.
        text: Definition of the type in ros2msg, with the definitions of all nested types.
    """

    name: str
    text: str


JOINT_STATE = Schema(
    "sensor_msgs/msg/JointState",
    """\
std_msgs/Header header
string[] name
float64[] position  # [rad]
float64[] velocity  # [rad/s]
float64[] effort    # [N m]
"""
    + HEADER,
)
WRENCH = Schema(
    "geometry_msgs/msg/WrenchStamped",
    f"""\
std_msgs/Header header
geometry_msgs/Wrench wrench
{RULE}
MSG: geometry_msgs/Wrench
geometry_msgs/Vector3 force   # [N]
geometry_msgs/Vector3 torque  # [N m]
"""
    + VECTOR
    + HEADER,
)
IMU = Schema(
    "sensor_msgs/msg/Imu",
    """\
std_msgs/Header header
geometry_msgs/Quaternion orientation
float64[9] orientation_covariance
geometry_msgs/Vector3 angular_velocity  # [rad/s]
float64[9] angular_velocity_covariance
geometry_msgs/Vector3 linear_acceleration  # with gravity, as the unit measures it [m/s2]
float64[9] linear_acceleration_covariance
"""
    + QUATERNION
    + VECTOR
    + HEADER,
)
LOG = Schema(
    "rcl_interfaces/msg/Log",
    f"""\
builtin_interfaces/Time stamp
uint8 level
string name
string msg
string file
string function
uint32 line
{RULE}
MSG: builtin_interfaces/Time
int32 sec
uint32 nanosec
""",
)
INFO, WARNING, ERROR = 20, 30, 40
"""Severity levels of a `LOG` message, by ROS."""

_UNKNOWN = (0.0,) * 9
_ABSENT = (-1.0, *(0.0,) * 8)


def joint_state(
    stamp: int,
    names: Sequence[str],
    *,
    position: Sequence[float] = (),
    velocity: Sequence[float] = (),
) -> bytes:
    """Encode angles and speeds of joints as a `sensor_msgs/JointState` in CDR, without efforts.

    Args:
        stamp: Time since the Unix epoch [ns].
        names: Name of each joint.
        position: Angle of each joint; empty where unknown, shape (joints,) [rad].
        velocity: Angular speed of each joint; empty where unknown, shape (joints,) [rad/s].
    """
    message = CdrWriter().time(stamp).text("").texts(names)
    for values in (position, velocity, ()):
        message.array(np.asarray(values, dtype="<f8"))
    return message.message()


def wrench(stamp: int, *, normal: float, traction: float) -> bytes:
    """Encode the force at a contact as a `geometry_msgs/WrenchStamped`, frame `contact`, in CDR.

    The lateral force and all torques are NaN.

    Args:
        stamp: Time since the Unix epoch [ns].
        normal: Normal force, along z [N].
        traction: Traction, along x [N].
    """
    message = CdrWriter().time(stamp).text("contact")
    return message.float64(traction, math.nan, normal, *(math.nan,) * 3).message()


def imu(
    stamp: int,
    *,
    orientation: Sequence[float],
    angular_rate: Sequence[float],
    specific_force: Sequence[float],
) -> bytes:
    """Encode the body's orientation, rate and specific force as a `sensor_msgs/Imu` in CDR.

    The frame is `body`. A quantity of which no value is known, all NaN, is marked as not measured.

    Args:
        stamp: Time since the Unix epoch [ns].
        orientation: Orientation of the body, quaternion x, y, z, w, shape (4,) [-].
        angular_rate: Angular rate in the body's axes, shape (3,) [rad/s].
        specific_force: Acceleration minus gravity, in the body's axes, shape (3,) [m/s^2].
    """
    message = CdrWriter().time(stamp).text("body")
    for values in (orientation, angular_rate, specific_force):
        measured = not all(map(math.isnan, values))
        message.float64(*values, *(_UNKNOWN if measured else _ABSENT))
    return message.message()


def log_entry(stamp: int, text: str, *, level: int = INFO) -> bytes:
    """Encode an event as a `rcl_interfaces/Log` of the node `zebro_lab`, in CDR.

    Args:
        stamp: Time since the Unix epoch [ns].
        text: Description of the event.
        level: Severity, `INFO`, `WARNING` or `ERROR`, 0 to 255.
    """
    message = CdrWriter().time(stamp).uint8(level).text("zebro_lab")
    return message.text(text).text("").text("").uint32(0).message()
